"""Import of workbooks and CSV files in any layout: proposed tables, columns, units, tools and sites."""

from .answers import Answers, read_template
from .folder import undo_import, write_import
from .proposal import Proposal, propose
from .questions import Question
from .rows import ImportedTable
from .sections import Section

__all__ = [
    "Answers",
    "ImportedTable",
    "Proposal",
    "Question",
    "Section",
    "propose",
    "read_template",
    "undo_import",
    "write_import",
]
