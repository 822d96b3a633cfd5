"""skisnow in other people's programs: files written for them and read from them."""

from .fmu import write_contact_fmu, write_sledge_fmu

__all__ = ["write_contact_fmu", "write_sledge_fmu"]
