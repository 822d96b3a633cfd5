"""A table of a file, checked by what a dataclass declares."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .._support.errors import ParameterError
from .._support.nearest import nearest
from .declared import own_quantities


def checked_table(owner: type, table: Mapping[str, Any], place: str) -> dict[str, Any]:
    """The values of a table in their kinds and units, what is left out not among them.

    Parameters
    ----------
    owner
        The dataclass that declares what may stand there; `made` makes one of the values.
    table
        As parsed.
    place
        Where it stands, for messages.

    Raises
    ------
    ParameterError
        A key is unknown (the nearest is named) or missing, or a value is of another kind or outside its range.
    """
    keys = {each.name: each for each in own_quantities(owner)}
    for name in table:
        if name not in keys:
            raise ParameterError(f"{place}: there is no {name!r}. {nearest(name, keys)}")
    for name, key in keys.items():
        if key.needed and name not in table:
            raise ParameterError(f"{place}: {name} is missing: {key.meaning}")
    try:
        return {name: keys[name].in_range(value) for name, value in table.items()}
    except ParameterError as error:
        raise ParameterError(f"{place}: {error}") from error
