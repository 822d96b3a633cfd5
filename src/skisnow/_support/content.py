"""What an object is made of, for fingerprints."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass


def pieces_of(thing: object) -> Iterator[bytes]:
    """What an object is made of, down to numbers and texts: the same for the same content.

    >>> b" ".join(pieces_of((1, "a")))
    b"1 'a'"
    """
    if is_dataclass(thing) and not isinstance(thing, type):
        yield type(thing).__qualname__.encode()
        for each in fields(thing):
            if each.init:
                yield from pieces_of(getattr(thing, each.name))
    elif isinstance(thing, tuple | list):
        for part in thing:
            yield from pieces_of(part)
    else:
        array = getattr(thing, "tobytes", None)
        yield repr(thing).encode() if array is None else array()
