"""Letters of panels: (a), (b), … where a figure has more than one."""

from __future__ import annotations

from string import ascii_lowercase
from typing import TYPE_CHECKING

from matplotlib.text import Text

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COLOUR_BAR = "<colorbar>"


def panels_of(figure: Figure) -> list[Axes]:
    """The visible axes that stand in a grid for themselves: no scale of colours, no second axis over another."""
    found: dict[tuple[object, ...], Axes] = {}
    for axes in figure.axes:
        place = axes.get_subplotspec()
        if place is None or axes.get_label() == _COLOUR_BAR or not axes.get_visible():
            continue
        found.setdefault((id(place.get_gridspec()), place.num1, place.num2), axes)
    return list(found.values())


def letter_panels(figure: Figure) -> None:
    """Put a letter before the title at the left of each panel, or in its place."""
    panels = panels_of(figure)
    if len(panels) < 2:
        return
    for letter, axes in zip(ascii_lowercase, panels, strict=False):
        title = left_title(axes)
        if title is None:
            axes.set_title(f"({letter})", loc="left")
        else:
            title.set_text(f"({letter}) {title.get_text()}")


def left_title(axes: Axes) -> Text | None:
    """The title at the left as it stands there; None where there is none."""
    text = axes.get_title(loc="left")
    if not text:
        return None
    own = (each for each in axes.get_children() if isinstance(each, Text) and each.get_text() == text)
    return next(own, None)
