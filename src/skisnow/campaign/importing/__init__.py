"""Import of workbooks and CSV files in any layout: proposed tables, columns, units, tools and sites."""

from .answers import TEMPLATES, Answers, Question, parse_template, read_template, save_template, saved_templates
from .columns import ColumnChoice
from .folder import RECORD, undo_import, write_import
from .proposal import Proposal, propose
from .rows import ImportedTable
from .sections import Section

__all__ = [
    "RECORD",
    "TEMPLATES",
    "Answers",
    "ColumnChoice",
    "ImportedTable",
    "Proposal",
    "Question",
    "Section",
    "parse_template",
    "propose",
    "read_template",
    "save_template",
    "saved_templates",
    "undo_import",
    "write_import",
]
