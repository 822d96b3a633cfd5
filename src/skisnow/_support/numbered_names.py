"""Names as numbers, for grouping."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from collections.abc import Sequence


def numbered(names: Sequence[str]) -> tuple[list[str], npt.NDArray[np.int64]]:
    """The distinct names in alphabetical order, and the number of each given name among them.

    An array of texts would be as wide as the longest of them for every entry.

    >>> numbered(["b", "a", "b"])
    (['a', 'b'], array([1, 0, 1]))
    """
    distinct = sorted(set(names))
    number = {name: index for index, name in enumerate(distinct)}
    return distinct, np.fromiter((number[name] for name in names), dtype=np.int64, count=len(names))
