"""Random combinations of layers of a scenario, and the origin of each quantity that a resolver chose.

The module needs no skisnow, so that any version of the resolver can be asked (`record.py`).
"""

import json
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

NUMBER: Final = 500

FILES: Final = {
    "results.json": json.dumps(
        {
            "penetration": {
                "experiments": [
                    {"used": True, "site": site, "H_V_N_per_mm3": value} for site, value in (("A", 0.151), ("B", 0.152))
                ],
                "unloading": [{"site": "A", "unloading_ratio": 7.0, "unloading_ratio_interval": [6.0, 8.0]}],
            },
            "shear": {
                "experiments": [
                    {"used": True, "site": site, "S_f_N_per_mm2": value} for site, value in (("A", 0.351), ("B", 0.352))
                ],
                "displacement": [
                    {"site": "A", "shear_displacement_mm": 0.25, "shear_displacement_interval_mm": [0.2, 0.3]}
                ],
            },
        }
    ),
    "hardness.csv": "x_m,H_V_N_per_mm3\n-500,0.161\n500,0.161\n",
    "both.csv": "x_m,H_V_N_per_mm3,S_f_N_per_mm2\n-500,0.171,0.371\n500,0.171,0.371\n",
    "profile.csv": "x,y\n" + "".join(f"{x},{-0.2 * x}\n" for x in range(-30, 90, 3)),
    "ski.toml": 'name = "own"\nlength_mm = 1600\nrunning_length_mm = 1400\nsidecut_length_mm = 1400\n'
    "tip_width_mm = 100\nwaist_width_mm = 70\ntail_width_mm = 95\nmass_kg = 2\nrigid = true\n",
}
"""Site A has measured k_u/H_V and u_y, site B has not."""

FIXED: Final[dict[str, Any]] = {
    "slope.angle_deg": 11.0,
    "friction.mu_0": 0.04,
    "drag.drag_area_m2": 0.4,
    "sledge.mass_kg": 80.0,
    "sledge.inertia_kg_m2": [8.0, 9.0, 2.0],
    "sledge.edge_angle_deg": 30.0,
    "sledge.stance_width_m": 0.4,
    "sledge.centre_of_mass_height_m": 0.1,
    "start.speed_m_per_s": 7.0,
    "run.duration_s": 2.0,
    "ski.name": "slalom",
    "snow.H_V_N_per_mm3": 0.21,
    "snow.S_f_N_per_mm2": 0.41,
    "snow.unloading_ratio": 11.0,
}
"""Values of a file before random ones replace them."""

SNOW: Final[tuple[dict[str, Any], ...]] = (
    {"snow.H_V_N_per_mm3": 0.2},
    {"snow.S_f_N_per_mm2": 0.4},
    {"snow.unloading_ratio": 10.0},
    {"snow.penetration": "elastic"},
    {"snow.penetration": "hypoplastic"},
    {"snow.shear_displacement_mm": 0.3},
    {"snow.published": "race-piste"},
    {"snow.published": "spring-snow"},
    {"snow.results": "results.json", "snow.site": "A"},
    {"snow.results": "results.json", "snow.site": "B"},
    {"snow.results": "results.json"},
    {"snow.map_file": "hardness.csv"},
    {"snow.map_file": "both.csv"},
)
OTHERS: Final[tuple[dict[str, Any], ...]] = (
    {"ski.name": "carver"},
    {"ski.file": "ski.toml"},
    {"slope.angle_deg": 10.0},
    {"slope.kind": "profile", "slope.profile": "profile.csv"},
    {"slope.kind": "plane", "slope.angle_deg": 10.0},
    {"slope.profile": "profile.csv"},
    {"shear.law": "by-angle"},
    {"shear.law": "by-angle", "shear.relative_decrease_per_rad": 0.2},
    {"shear.law": "constant"},
    {"shear.relative_decrease_per_rad": 0.3},
    {"shear.law": "by-density", "shear.snow_density_kg_per_m3": 300.0},
    {"friction.mu_0": 0.05},
    {"drag.drag_area_m2": 0.5},
)


@dataclass(frozen=True)
class Combination:
    """Values of a base (a built-in scenario by its name, or those of a file) and of a layer of changes."""

    built_in: str | None
    file: dict[str, Any]
    changes: dict[str, Any]


def combinations() -> Iterator[Combination]:
    """The same combinations each time."""
    draws = random.Random(20261128)
    for _ in range(NUMBER):
        built_in = draws.choice((None, None, "carved-46m"))
        base = {} if built_in else _file_values(draws)
        changes = {name: _nudged(value) for name, value in _drawn(draws).items()}
        yield Combination(built_in, base, changes)


def _drawn(draws: random.Random) -> dict[str, Any]:
    """Values of up to 3 choices about the snow and of up to 2 others."""
    parts = draws.sample(SNOW, draws.choice((0, 1, 1, 1, 2, 3))) + draws.sample(OTHERS, draws.randint(0, 2))
    return {name: value for part in parts for name, value in part.items()}


def _nudged(value: Any) -> Any:
    """A number of a change differs from each number of a file."""
    return value * 1.015625 if isinstance(value, float) else value


def _file_values(draws: random.Random) -> dict[str, Any]:
    values, drawn = dict(FIXED), _drawn(draws)
    if draws.random() < 0.7:  # else two keys give one quantity
        named = {"snow.published", "snow.results", "snow.map_file"} & drawn.keys()
        gone = {"snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2"} - drawn.keys() if named else set()
        if drawn.get("snow.map_file") == "hardness.csv" and len(named) == 1:
            gone -= {"snow.S_f_N_per_mm2"}
        gone |= {"ski.name"} if "ski.file" in drawn else set()
        gone |= {"slope.angle_deg"} if drawn.get("slope.kind") == "profile" else set()
        gone |= {"snow.unloading_ratio"} if drawn.get("snow.penetration") == "elastic" else set()
        values = {name: value for name, value in values.items() if name not in gone}
    return values | drawn


def write_files(folder: Path) -> None:
    for name, text in FILES.items():
        (folder / name).write_text(text, encoding="utf-8")


def toml(values: dict[str, Any]) -> str:
    """A scenario file."""
    sections: dict[str, list[str]] = {}
    for name, value in values.items():
        section, _, key = name.partition(".")
        sections.setdefault(section, []).append(f"{key} = {json.dumps(value)}")
    return "\n".join(f"[{section}]\n" + "\n".join(lines) for section, lines in sections.items()) + "\n"


def answer(
    combination: Combination, folder: Path, load: Callable[..., Any], error: type[Exception]
) -> list[Any] | None:
    """Numbers in force, rounded, or None if the resolver rejects the combination.

    H_V, S_f, k_u/H_V, u_y (mm), width of the waist (mm), slope (°; None: profile), k, μ_0, drag area.
    """
    base: str | Path = combination.built_in or folder / "base.toml"
    if not combination.built_in:
        (folder / "base.toml").write_text(toml(combination.file), encoding="utf-8")
    changes = {name: str(folder / value) if value in FILES else value for name, value in combination.changes.items()}
    try:
        scenario = load(base, changes=changes)
    except error:
        return None
    contact, shear = scenario.contact, scenario.shear
    angle = getattr(scenario.slope, "angle", None)
    law_number = {"by-angle": shear.relative_decrease, "by-density": shear.snow_density}.get(shear.law, 0.0)
    numbers = (
        contact.hardness_at(0.0, 0.0) / 1e9,
        contact.snow.failure_shear_stress / 1e6,
        contact.unloading_ratio,
        contact.shear_displacement * 1e3,
        float(scenario.ski.width.min()) * 1e3,
        None if angle is None else angle * 57.29577951308232,
        law_number,
        contact.friction,
        scenario.air.drag_area,
    )
    return [None if number is None else float(f"{number:.5g}") for number in numbers]
