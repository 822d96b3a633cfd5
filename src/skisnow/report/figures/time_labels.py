"""Words beside marks along a line: those that would lie over an earlier one are left out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from matplotlib.text import Annotation

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MARK: Final = "time mark"
"""Group of the words, as the artist's gid."""
_POINT_MM: Final = 25.4 / 72.0
_LETTER: Final = 0.62
"""Width of a letter over the size of its type (about)."""


def thin_out(axes: Axes, mm_per_unit: float) -> None:
    """Show of the words in this group, from the first on, those that lie over none shown; both axes have one scale."""
    taken: list[tuple[float, float, float, float]] = []
    for each in axes.texts:
        if isinstance(each, Annotation) and each.get_gid() == MARK:
            box = _box(each, mm_per_unit)
            is_free = not any(_overlap(box, other) for other in taken)
            each.set_visible(is_free)
            taken += [box] if is_free else []


def _box(word: Annotation, mm_per_unit: float) -> tuple[float, float, float, float]:
    """Centre and half sizes (mm)."""
    (x, y), (aside, above), size = word.xy, word.get_position(), float(word.get_fontsize()) * _POINT_MM
    half_width = 0.5 * _LETTER * size * (len(word.get_text()) + 1)  # and a space
    more = half_width if word.get_horizontalalignment() == "left" else 0.0
    centre = x * mm_per_unit + aside * _POINT_MM + more, y * mm_per_unit + above * _POINT_MM
    return (*centre, half_width, 0.6 * size)


def _overlap(one: tuple[float, float, float, float], other: tuple[float, float, float, float]) -> bool:
    return all(abs(one[k] - other[k]) < one[2 + k] + other[2 + k] for k in (0, 1))
