"""A ski as a picture is drawn from it: outline, base, stiffness in the units of a ski's file, its numbers in words."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .._support.units import MM
from .number_formatting import significant

if TYPE_CHECKING:
    import numpy.typing as npt

    from ..ski import Ski

    FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class SkiDrawing:
    """Tables along a ski from tip to tail.

    Attributes
    ----------
    name, source
        As in `skisnow.ski.Ski`.
    station_m
        From the boot, positive forward.
    half_width_mm, base_height_mm, EI_N_m2, GJ_N_m2
        Half of the width from edge to edge, height of the unloaded base, bending and torsional stiffness.
    facts
        Key data of a ski, in words and with units.
    """

    name: str
    source: str
    station_m: tuple[float, ...]
    half_width_mm: tuple[float, ...]
    base_height_mm: tuple[float, ...]
    EI_N_m2: tuple[float, ...]
    GJ_N_m2: tuple[float, ...]
    facts: dict[str, str]


def ski_drawing(ski: Ski) -> SkiDrawing:
    """The picture of a ski; every second table point, 5 mm apart, is enough for any screen."""

    def drawn(table: FloatArray) -> tuple[float, ...]:
        return tuple(np.append(table[:-1:2], table[-1]).tolist())

    return SkiDrawing(
        name=ski.name,
        source=" ".join(ski.source.split()),
        station_m=drawn(ski.station),
        half_width_mm=drawn(ski.width / (2.0 * MM)),
        base_height_mm=drawn(ski.base_height / MM),
        EI_N_m2=drawn(ski.bending_stiffness),
        GJ_N_m2=drawn(ski.torsional_stiffness),
        facts=_facts(ski),
    )


def _facts(ski: Ski) -> dict[str, str]:
    tip, waist, tail = (significant(width / MM) for width in ski.sidecut_widths)
    middle = int(np.argmin(np.abs(ski.station)))
    return {
        "Length": f"{significant(ski.length, 4)} m",
        "Running length": f"{significant(ski.running_length, 4)} m",
        "Sidecut, tip – waist – tail": f"{tip} – {waist} – {tail} mm",
        "Sidecut radius": f"{significant(ski.sidecut_radius_of_edge_line)} m",
        "EI at the boot": f"{significant(float(ski.bending_stiffness[middle]))} N m²",
        "GJ at the boot": f"{significant(float(ski.torsional_stiffness[middle]))} N m²",
        "Mass": f"{significant(ski.mass)} kg",
    }
