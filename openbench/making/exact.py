"""Exact answers from their formulas. Uncertainty: rounding of the last digits that are printed."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final, TypeAlias

from . import cases

Case: TypeAlias = dict[str, Any]
Values: TypeAlias = dict[str, list[float]]


def plate(case: Case) -> Values:
    """F = A max(0, H d_max - k (d_max - d)); under a load d = F/(H A), or d_max - (F_max - F)/(k A) below F_max."""
    area = case["body"]["length_m"] * case["body"]["width_m"]
    hard, stiff = _stiffness(case)
    deepest, forces = 0.0, []
    for depth in case["motion"]["depth_m"]:
        deepest = max(deepest, depth)
        forces.append(area * max(0.0, hard * deepest - stiff * (deepest - depth)))
    largest, depths = 0.0, []
    for load in case["loads"]["load_N"]:
        largest = max(largest, load)
        depths.append(largest / (hard * area) - (largest - load) / (stiff * area))
    return {"force_N": forces, "depth_m": depths}


def edge(case: Case) -> Values:
    """F = H L e²/(2 tan ϑ); lifted by d from e_m: F = F_m (1 - κ d/e_m)², whatever the heading."""
    hard, length, ratio = (
        case["snow"]["snow_hardness_N_per_m3"],
        case["body"]["length_m"],
        case["snow"]["unloading_ratio_1"],
    )
    depths, forces = [], []
    for angle in map(math.radians, case["body"]["edge_angle_deg"]):
        wedge, largest = hard * length / (2.0 * math.tan(angle)), 0.0
        for load in case["loads"]["load_N"]:
            largest = max(largest, load)
            most = math.sqrt(largest / wedge)
            depths.append(most * (1.0 - (1.0 - math.sqrt(load / largest)) / ratio))
        forces += [wedge * case["motion"]["depth_by_heading_m"] ** 2] * len(case["motion"]["heading_deg"])
    return {"depth_m": depths, "force_by_heading_N": forces}


def cycles(case: Case) -> Values:
    """H L (1 - 1/κ) (e³ - e_before³)/(6 tan ϑ) of each new depth; 4 S_f e L (a - u_y) of each cycle aside."""
    body, snow, motion = case["body"], case["snow"], case["motion"]
    slope = 6.0 * math.tan(math.radians(body["edge_angle_deg"]))
    whole = snow["snow_hardness_N_per_m3"] * body["length_m"] * (1.0 - 1.0 / snow["unloading_ratio_1"]) / slope
    deepest, lost = 0.0, []
    for peak in motion["peak_depth_m"]:
        lost.append(whole * (max(peak, deepest) ** 3 - deepest**3))
        deepest = max(peak, deepest)
    grip = snow["failure_shear_stress_N_per_m2"] * motion["shear_depth_m"] * body["length_m"]
    reach = snow["shear_displacement_m"]
    sheared = [4.0 * grip * max(0.0, a - reach) for a in motion["shear_amplitude_m"]]
    return {"energy_lost_per_cycle_J": lost, "energy_lost_per_shear_cycle_J": sheared}


def glide(case: Case) -> Values:
    """N = m g cos α = H W (l e + e²/(2 j)); R = ½ H W e²; v² = v∞² + (v₀² - v∞²) exp(-2 c s/m)."""
    body, snow, motion = case["body"], case["snow"], case["motion"]
    weight = body["mass_kg"] * motion["gravity_m_per_s2"]
    slope = math.radians(motion["slope_deg"])
    per_depth = snow["snow_hardness_N_per_m3"] * body["width_m"]
    level, rise = body["bend_m"] - body["tail_m"], body["tip_height_m"] / (body["tip_m"] - body["bend_m"])
    # e²/(2 j) + l e - N/(H W) = 0
    depth = rise * (math.sqrt(level**2 + 2.0 * weight * math.cos(slope) / per_depth / rise) - level)
    compaction = 0.5 * per_depth * depth**2
    drive = weight * (math.sin(slope) - snow["friction_1"] * math.cos(slope)) - compaction
    end, start, drag = drive / body["drag_kg_per_m"], motion["start_speed_m_per_s"] ** 2, body["drag_kg_per_m"]
    squares = [end + (start - end) * math.exp(-2.0 * drag * s / body["mass_kg"]) for s in motion["way_m"]]
    kept = 1.0 - 1.0 / snow["unloading_ratio_1"]
    return {
        "speed_squared_m2_per_s2": squares,
        "groove_depth_m": [depth],
        "groove_residual_depth_m": [depth * kept],
        "groove_energy_J_per_m": [compaction * kept],
    }


def crossing(case: Case) -> Values:
    """½ H (1 - 1/κ) (e₂² A - e₁² A_o), A_o = w b/sin ψ; at rest F = H e (A - A_o) + A_o max(0, H e₁ - k (e₁ - e))."""
    body, motion = case["body"], case["motion"]
    hard, stiff = _stiffness(case)
    wide, first = body["second_width_m"], motion["first_depth_m"]
    energies, depths = [], []
    for angle in map(math.radians, motion["crossing_angle_deg"]):
        shared = wide * body["first_width_m"] / math.sin(angle)
        swept = wide * (body["second_length_m"] + motion["way_m"])
        half = 0.5 * hard * (1.0 - hard / stiff)
        energies.append(half * (motion["second_depth_m"] ** 2 * swept - first**2 * shared))
        fresh, load = wide * body["second_length_m"] - shared, case["loads"]["load_N"]
        depth = load / (hard * fresh)
        if depth > first * (1.0 - hard / stiff):
            depth = (load + shared * first * (stiff - hard)) / (hard * fresh + stiff * shared)
        assert depth < first
        depths.append(depth)
    return {"energy_lost_J": energies, "depth_m": depths}


def _stiffness(case: Case) -> tuple[float, float]:
    hard = case["snow"]["snow_hardness_N_per_m3"]
    return hard, hard * case["snow"]["unloading_ratio_1"]


EXACT: Final[dict[str, tuple[Callable[[], Case], Callable[[Case], Values]]]] = {
    "01-plate": (cases.plate, plate),
    "02-edge": (cases.edge, edge),
    "03-cycles": (cases.cycles, cycles),
    "04-glide": (cases.glide, glide),
    "08-crossing": (cases.crossing, crossing),
}


def formula(name: str) -> str:
    """The line of the function that says it."""
    return (EXACT[name][1].__doc__ or "").strip()
