"""skisnow in other people's programs: what is written for them, and what is read of theirs."""

from __future__ import annotations

from .fmu import write_contact_fmu, write_sledge_fmu

__all__ = ["write_contact_fmu", "write_sledge_fmu"]
