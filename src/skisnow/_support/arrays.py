"""Types of arrays and checks of their shapes, the bytes of an object for fingerprints, and numbers for names."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator, Sequence
from dataclasses import fields, is_dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from .errors import ParameterError

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]
BoolArray: TypeAlias = npt.NDArray[np.bool_]


def shaped(name: str, given: npt.ArrayLike, shape: tuple[int, ...]) -> FloatArray:
    """Array of an argument `name` for compiled code; a ParameterError unless it has the shape and finite numbers."""
    array = np.asarray(given, float, order="C")
    if array.shape != shape:
        raise ParameterError("{name} has shape {shape}; it must be {needed}").tag(
            "wrong_shape", name=name, shape=str(array.shape), needed=str(shape)
        )
    if not all(map(math.isfinite, array.ravel().tolist())):  # for a few numbers faster than NumPy
        raise ParameterError("{name} contains a number that is not finite").tag("not_a_number", name=name)
    return array


def content_bytes(thing: object) -> Iterator[bytes]:
    """Yield the bytes of all numbers and texts in an object, also in nested dataclasses, lists and arrays.

    >>> b" ".join(content_bytes((1, "a")))
    b"1 'a'"
    """
    if is_dataclass(thing) and not isinstance(thing, type):
        yield type(thing).__qualname__.encode()
        for field in fields(thing):
            if field.init:
                yield from content_bytes(getattr(thing, field.name))
    elif isinstance(thing, tuple | list):
        for part in thing:
            yield from content_bytes(part)
    else:
        array = getattr(thing, "tobytes", None)
        yield repr(thing).encode() if array is None else array()


def content_hash(begin: str, *things: object) -> str:
    """SHA-256 of a text and of the contents of objects, in hexadecimal digits."""
    digest = hashlib.sha256(begin.encode())
    for piece in content_bytes(things):
        digest.update(piece)
    return digest.hexdigest()


def index_names(names: Sequence[str]) -> tuple[list[str], npt.NDArray[np.int64]]:
    """Distinct names in alphabetical order, and for each given name its index among them.

    An array of texts instead would need the width of the longest text for every entry.

    >>> index_names(["b", "a", "b"])
    (['a', 'b'], array([1, 0, 1]))
    """
    distinct = sorted(set(names))
    number = {name: index for index, name in enumerate(distinct)}
    return distinct, np.fromiter((number[name] for name in names), dtype=np.int64, count=len(names))
