"""Parts of scenarios that no scenario may have, where an equation is known for them."""

import copy
from typing import TypeVar

T = TypeVar("T")


def beyond(thing: T, **values: object) -> T:
    """The same with values that its constructor refuses."""
    changed = copy.copy(thing)
    for name, value in values.items():
        object.__setattr__(changed, name, value)
    return changed
