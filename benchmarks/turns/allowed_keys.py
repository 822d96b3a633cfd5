"""Random values of a scenario's keys, far beyond what snow and skis are, within what the keys allow."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from skisnow.scenario.keys import SCENARIO_KEYS
from skisnow.scenario.reading import load_input
from skisnow.scenario.resolution import CONDITIONS

SHARE: Final = 0.25
"""Probability of each key to be given."""
LOGARITHMIC: Final = {
    "snow.H_V_N_per_mm3": (2e-3, 200.0),
    "snow.S_f_N_per_mm2": (5e-4, 500.0),
    "snow.unloading_ratio": (1.0, 1000.0),
    "snow.shear_displacement_mm": (0.01, 10.0),
    "snow.damping_N_s_per_mm3": (1e-5, 10.0),
    "snow.delayed_share": (0.01, 10.0),
    "snow.retardation_time_ms": (1.0, 1e5),
    "slope.gravity_m_per_s2": (0.1, 100.0),
    "friction.mu_0": (1e-3, 1.0),
    "drag.drag_area_m2": (0.01, 10.0),
    "drag.air_density_kg_per_m3": (1e-3, 2.0),
    "sledge.mass_kg": (0.1, 1000.0),
    "sledge.stance_width_m": (0.1, 3.0),
    "ski.stiffness_factor": (0.01, 100.0),
    "ski.clamp_length_m": (0.1, 1.0),
    "ski.footprint_stiffness_N_per_mm2": (1.0, 1e4),
    "ski.damping_ratio": (1e-3, 1.0),
    "start.speed_m_per_s": (0.1, 60.0),
    "run.output_ms": (0.1, 1000.0),
    "shear.slip_weakening_mm": (1e-3, 1000.0),
    "solver.step_ms": (0.05, 5.0),
    "solver.tolerance_mm": (1e-4, 1.0),
    "solver.line_spacing_mm": (5.0, 200.0),
    "solver.groove_tolerance": (1e-7, 0.1),
    "solver.delayed_spacing_mm": (0.3, 20.0),
}
UNIFORM: Final = {
    "slope.angle_deg": (0.0, 75.0),
    "friction.mu_1_s_per_m": (-0.01, 0.03),
    "drag.centre_of_pressure_height_m": (0.0, 3.0),
    "sledge.centre_of_mass_height_m": (0.0, 3.0),
    "sledge.centre_of_mass_forward_m": (-1.0, 1.0),
    "sledge.edge_angle_deg": (-85.0, 85.0),
    "start.heading_deg": (-180.0, 180.0),
    "shear.residual_ratio": (0.0, 1.0),
}
CHOICES: Final[dict[str, tuple[Any, ...]]] = {
    "snow.penetration": ("hypoplastic", "elastic"),
    "snow.compaction_resistance": (True, False),
    "friction.acts_on": ("snow-normal", "base-normal"),
    "friction.direction": ("vector", "along-ski"),
}
LAWS: Final = {
    "constant": {},
    "by-angle": {"shear.relative_decrease_per_rad": (0.0, 0.6366)},
    "by-density": {"shear.snow_density_kg_per_m3": (160.0, 917.0)},
    "machining": {"shear.transverse_friction": (0.0, 0.4), "shear.least_shear_plane_deg": (1.0, 10.0)},
}
INERTIA: Final = (0.5, 100.0)
ELEMENTS: Final = (4.0, 80.0)
DURATION: Final = (0.5, 2.0)


def changes(seed: int, law: str | None = None) -> dict[str, Any]:
    """Keys and values over those of ``carved-46m``; with a shear law, or any of them."""
    rng = np.random.default_rng(seed)
    drawn: dict[str, Any] = {key: _logarithmic(rng, *ends) for key, ends in LOGARITHMIC.items()}
    drawn |= {key: float(rng.uniform(*ends)) for key, ends in UNIFORM.items()}
    drawn |= {key: values[int(rng.integers(len(values)))] for key, values in CHOICES.items()}
    drawn |= {"sledge.inertia_kg_m2": [_logarithmic(rng, *INERTIA)] * 3}
    drawn |= {"solver.elements": round(_logarithmic(rng, *ELEMENTS))}
    given = rng.uniform(size=len(drawn)) < SHARE
    out = {key: value for (key, value), taken in zip(drawn.items(), given, strict=True) if taken}
    out["run.duration_s"], out["solver.method"] = float(rng.uniform(*DURATION)), "fast"
    out["shear.law"] = law or list(LAWS)[int(rng.integers(len(LAWS)))]
    out |= {key: float(rng.uniform(*ends)) for key, ends in LAWS[out["shear.law"]].items()}
    if out["shear.law"] == "by-density":
        out.pop("snow.S_f_N_per_mm2", None)
    if out.get("snow.penetration") == "elastic":
        out.pop("snow.unloading_ratio", None)
    return _with_effect(out)


def _logarithmic(rng: np.random.Generator, least: float, most: float) -> float:
    return float(np.exp(rng.uniform(np.log(least), np.log(most))))


def _with_effect(values: dict[str, Any]) -> dict[str, Any]:
    """The keys that act: another key's value can make one meaningless, which scenarios reject."""
    base = load_input("carved-46m").layers[-1].values
    remaining = values
    while True:
        context = {**base, **remaining}
        without_effect = {
            name
            for name in remaining
            if (condition := CONDITIONS.get(name)) is not None
            and not condition.holds(context.get(condition.key, SCENARIO_KEYS[condition.key].default))
        }
        if not without_effect:
            return remaining
        remaining = {name: value for name, value in remaining.items() if name not in without_effect}
