"""A quantity, declared once on its dataclass: for files, checks, command line, schemas, docs, forms."""

from .._support.errors import suggest, suggest_and_list
from .declared import (
    APART,
    Declared,
    Section,
    Word,
    build_declared,
    checked_table,
    own_quantities,
    quantities,
    replace_declared,
    require_declared,
    require_effect,
    values_of,
)
from .quantity import SMALLEST, Allowed, Condition, InputValue, Kind, Label, Quantity, Search

__all__ = [
    "APART", "SMALLEST", "Allowed", "Condition", "Declared", "InputValue", "Kind", "Label", "Quantity", "Search",
    "Section", "Word", "build_declared", "checked_table", "own_quantities", "quantities", "replace_declared",
    "require_declared", "require_effect", "suggest", "suggest_and_list", "values_of",
]  # fmt: skip
