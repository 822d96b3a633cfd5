"""Colours without transparency, for EPS, which knows none: each as it looks on white paper."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.collections import Collection
from matplotlib.colors import to_rgba_array
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def make_opaque(figure: Figure) -> None:
    """Change the figure itself."""
    for artist in figure.findobj():
        _make_opaque(artist)


def _make_opaque(artist: Artist) -> None:
    alpha = artist.get_alpha()
    if isinstance(artist, Collection):
        faces, edges = _blended(artist.get_facecolor(), None), _blended(artist.get_edgecolor(), None)
        if artist.get_array() is None:  # else its colours come from a map
            artist.set_alpha(None)
            artist.set_facecolor(faces)
            artist.set_edgecolor(edges)
    elif alpha is None or np.ndim(alpha) or alpha >= 1.0:
        return
    elif isinstance(artist, Line2D):
        artist.set_color(_one(artist.get_color(), alpha))
        artist.set_alpha(None)
    elif isinstance(artist, Patch):
        face, edge = _one(artist.get_facecolor(), None), _one(artist.get_edgecolor(), None)
        artist.set_alpha(None)
        artist.set_facecolor(face)
        artist.set_edgecolor(edge)
    elif isinstance(artist, Text):
        artist.set_color(_one(artist.get_color(), alpha))
        artist.set_alpha(None)


def _one(colour: Any, alpha: float | None) -> tuple[float, float, float, float]:
    red, green, blue, share = _blended([colour], alpha)[0].tolist()
    return red, green, blue, share


def _blended(colours: Any, alpha: float | None) -> Any:
    """Over white; what is wholly transparent stays so."""
    found = to_rgba_array(colours, alpha)
    share = found[:, 3:]
    found[:, :3] = share * found[:, :3] + 1.0 - share
    found[:, 3] = np.where(share[:, 0] > 0.0, 1.0, 0.0)
    return found
