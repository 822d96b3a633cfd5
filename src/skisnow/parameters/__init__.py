"""A quantity, declared once on its dataclass: for files, checks, command line, schemas, docs, forms."""

from .._support.errors import meant, nearest
from .declared import (
    APART,
    Section,
    Word,
    changed,
    checked_table,
    declared_text,
    made,
    own_quantities,
    quantities,
    require_declared,
    require_effect,
    values_of,
)
from .quantity import SMALLEST, Allowed, Condition, InputValue, Kind, Label, Quantity, Search

__all__ = [
    "APART",
    "SMALLEST",
    "Allowed",
    "Condition",
    "InputValue",
    "Kind",
    "Label",
    "Quantity",
    "Search",
    "Section",
    "Word",
    "changed",
    "checked_table",
    "declared_text",
    "made",
    "meant",
    "nearest",
    "own_quantities",
    "quantities",
    "require_declared",
    "require_effect",
    "values_of",
]
