"""How exactly the places of a track are known: what a comparison can have digits for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    from .track import Track

OF_SOLUTION: Final = {"fixed": 0.02, "float": 0.3, "code": 3.0}
"""Metres, by how a receiver came to a place (modelling assumption: the orders that `skisnow.track.solution` names)."""


def known_to(track: Track) -> float:
    """Standard deviation of a place (m): what the receiver states, else of its kind; 0 where nobody measured it.

    The median over the points that are used. A place in latitude and longitude of which the file says nothing comes
    from a receiver that works by the code alone, as in GPX files of watches.
    """
    usable = track.usable
    if track.place_sd is not None:
        stated = track.place_sd[usable, :2]
        if np.isfinite(stated).any():
            return float(np.nanmedian(stated))
    if track.solution is not None:
        kinds = [OF_SOLUTION[kind] for kind in track.solution[usable].tolist() if kind]
        if kinds:
            return float(np.median(kinds))
    return OF_SOLUTION["code"] if track.origin is not None else 0.0
