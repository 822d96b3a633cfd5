"""A deformable terrain of Chrono::Vehicle with the snow of a scenario, as its JSON files.

Written after Chrono's manual and the terrain files that it brings along; no Chrono was at hand to read it (untested).
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Final

from .._support.errors import ParameterError
from .._support.staging import require_writable, write_file
from ..scenario import Plane, Scenario

SOIL: Final = "snow.json"
TERRAIN: Final = "terrain.json"
SIZE: Final = (20.0, 10.0)
"""Size of the patch along and across (m)."""
SPACING: Final = 0.02
"""Of its grid (m) (that of skisnow's lines)."""


def chrono_soil(scenario: Scenario) -> dict[str, Any]:
    """Parameters of Chrono's soil contact model for the snow of a scenario.

    Raises
    ------
    ParameterError
        The snow varies over the place, is elastic, or is not given only by H_V and S_f.

    Notes
    -----
    The model's pressure (k_c/b + k_φ) z^n is H_V ε with k_c = 0, n = 1 and k_φ = H_V; it unloads with K = k_u. Its
    shear stress (c + p tan φ)(1 - e^(-j/J)) gets c = S_f, φ = 0 and J = u_y. It acts all over a contact, where
    skisnow's acts across an edge: it serves wheels, tracks and plates, and brakes a ski that glides.
    """
    contact = scenario.contact
    hardness, stress = contact.snow.snow_hardness, contact.snow.failure_shear_stress
    if contact.snow_map is not None or stress is None:
        raise ParameterError(
            "Chrono's file has one H_V and one S_f; the scenario's snow varies, or has no S_f", code="no_data"
        )
    if contact.unloading_ratio <= 1.0:
        raise ParameterError(
            "Chrono requires unloading stiffer than loading; unloading_ratio is {unloading_ratio:g}",
            code="out_of_range",
            unloading_ratio=contact.unloading_ratio,
        )
    return {
        "Name": "snow",
        "Type": "Terrain Properties",
        "Template": "SCM Soil Parameters",
        "Soil Parameters": {
            "Bekker Kphi": hardness,
            "Bekker Kc": 0.0,
            "Bekker n": 1.0,
            "Mohr Cohesion": stress,
            "Mohr Friction": 0.0,
            "Janosi Shear": contact.shear_displacement,
            "Elastic K": contact.unloading_ratio * hardness,
            "Dampening R": contact.damping,
        },
    }


def write_chrono_terrain(
    scenario: Scenario,
    folder: str | Path,
    *,
    size: tuple[float, float] = SIZE,
    spacing: float = SPACING,
) -> Path:
    """Write snow.json and terrain.json into a folder: a level patch of Chrono::Vehicle's deformable terrain. Untested.

    Parameters
    ----------
    scenario
        Its snow; its slope has to be a plane, which gravity is tilted against in Chrono.
    folder
        Created if missing; Chrono searches for snow.json under its own data folder for vehicles.
    size
        Along and across (m), > 0.
    spacing
        Spacing of the grid (m), > 0.

    Returns
    -------
    Path
        Of terrain.json.

    Raises
    ------
    ParameterError
        As `chrono_soil`; the slope is not a plane; a length is not above 0.
    OutputError
        The folder cannot be written.

    References
    ----------
    * The page docs/how-to/other-programs.md.
    """
    if not isinstance(scenario.slope, Plane):
        raise ParameterError(
            "Chrono's patch is level; use a scenario on a plane, and tilt gravity there", code="not_level"
        )
    if not all(length > 0.0 for length in (*size, spacing)):
        raise ParameterError(
            "size {size} m and spacing {spacing:g} m must be above 0", code="out_of_range", size=size, spacing=spacing
        )
    soil = chrono_soil(scenario)
    terrain = {
        "Name": "snow",
        "Type": "Terrain",
        "Template": "SCMDeformableTerrain",
        "Bulldozing Parameters": {"Do Bulldozing": False},
        "Refinement Parameters": {"Do Refinement": False},
        "Soil Parameters": {"Input File": SOIL},
        "Geometry": {"Height": 0.0, "Size": list(size), "Divisions": [round(length / spacing) for length in size]},
    }
    place = Path(folder)
    require_writable(place)
    for name, content in ((SOIL, soil), (TERRAIN, terrain)):
        write_file(place / name, json.dumps(content, indent=1) + "\n")
    return place / TERRAIN
