"""A scenario as values in the units that its keys name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ...ski import ski_names
from .keys import SCENARIO_KEYS, in_unit
from .scenario import Scenario
from .slope import Plane


def scenario_values(scenario: Scenario) -> dict[str, Any]:
    """Every key of `SCENARIO_KEYS` with the value in force; None where the scenario does not have it.

    Also of a scenario that was built in Python: its snow stands as numbers, a ski that is not in the catalogue and a
    profile under the name and the source they have.
    """
    numbers = {name: in_unit(name, value) for name, value in _numbers(scenario).items()}
    found = {**numbers, **_words(scenario)}
    return {name: found.get(name) for name in SCENARIO_KEYS}


def _numbers(scenario: Scenario) -> dict[str, float | None]:
    contact, air, sledge, solver = scenario.contact, scenario.air, scenario.sledge, scenario.solver
    return {
        "slope.angle_deg": scenario.slope.angle if isinstance(scenario.slope, Plane) else None,
        "slope.gravity_m_per_s2": scenario.gravity,
        "snow.H_V_N_per_mm3": contact.snow.snow_hardness,
        "snow.S_f_N_per_mm2": contact.snow.failure_shear_stress,
        "snow.unloading_ratio": contact.unloading_ratio,
        "friction.mu_0": contact.friction,
        "friction.mu_1_s_per_m": contact.friction_by_speed,
        "drag.drag_area_m2": air.drag_area,
        "drag.air_density_kg_per_m3": air.density,
        "drag.centre_of_pressure_height_m": air.centre_of_pressure_height,
        "sledge.mass_kg": sledge.mass,
        "sledge.centre_of_mass_height_m": sledge.centre_of_mass[1],
        "sledge.centre_of_mass_forward_m": sledge.centre_of_mass[0],
        "sledge.stance_width_m": sledge.stance_width,
        "sledge.edge_angle_deg": sledge.edge_angle,
        "ski.clamp_length_m": scenario.clamp_length,
        "ski.damping_ratio": scenario.damping_ratio,
        "start.x_m": scenario.start.x,
        "start.y_m": scenario.start.y,
        "start.speed_m_per_s": scenario.start.speed,
        "start.heading_deg": scenario.start.heading,
        "run.duration_s": scenario.stop.duration,
        "run.length_m": scenario.stop.length,
        "run.output_ms": solver.output_interval,
        "solver.step_ms": solver.step,
        "solver.tolerance_mm": solver.tolerance,
        "solver.line_spacing_mm": solver.line_spacing,
        "solver.cell_mm": solver.cell,
    }


def _words(scenario: Scenario) -> dict[str, Any]:
    slope, solver = scenario.slope, scenario.solver
    plane = isinstance(slope, Plane)
    return {
        "slope.kind": "plane" if plane else "profile",
        "slope.profile": None if isinstance(slope, Plane) else slope.source,
        "slope.profile_gap": None if isinstance(slope, Plane) else slope.gap,
        "snow.penetration": "elastic" if scenario.contact.unloading_ratio == 1.0 else "hypoplastic",
        "snow.compaction_resistance": scenario.contact.compaction_resistance,
        "sledge.inertia_kg_m2": list(scenario.sledge.inertia),
        "ski.name" if scenario.ski.name in ski_names() else "ski.file": scenario.ski.name,
        "solver.method": solver.method,
        "solver.fixed": solver.fixed,
        "solver.elements": solver.elements,
    }


def in_sections(values: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Values under full names as sections, like a scenario's file.

    >>> in_sections({"snow.site": "A", "run.duration_s": 5.0})
    {'snow': {'site': 'A'}, 'run': {'duration_s': 5.0}}
    """
    sections: dict[str, dict[str, Any]] = {}
    for name, value in values.items():
        section, key = name.split(".")
        sections.setdefault(section, {})[key] = value
    return sections
