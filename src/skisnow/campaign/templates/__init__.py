"""A new campaign to be filled in: a folder of files, or one workbook, with a row as an example in each table."""

from .writing import write_new_campaign

__all__ = ["write_new_campaign"]
