"""A comparison of two tracks as JSON: what ``skisnow compare --json`` prints."""

from __future__ import annotations

from typing import Any, Final

from .._support.units import DEGREE
from .alignment import Motion
from .comparison import MEANS, Comparison, Distances, Fitted

Json = dict[str, Any]
SCHEMA_VERSION: Final = 1
KINDS: Final = ("nearest", "arc_length", "time")
"""The three distances."""


def comparison_dict(comparison: Comparison) -> Json:
    """Every number with its definition; null with a reason where there is none. Not rounded."""
    fitted = comparison.fitted
    return {
        "schema_version": SCHEMA_VERSION,
        **_three(comparison),
        "simulated": {"name": comparison.names[0], "length_m": comparison.simulated.length},
        "measured": {"name": comparison.names[1], "length_m": comparison.measured.length},
        "dimensions": comparison.dimensions,
        "seen": comparison.seen,
        "means": MEANS,
        "largest_from_simulated_m": comparison.largest_from_simulated,
        "fitted": None if fitted is None else _fitted(fitted),
        "in_one_frame": comparison.in_one_frame,
        "known_to_m": comparison.known_to,
        "warnings": list(comparison.warnings),
    }


def _three(comparison: Comparison) -> Json:
    return {kind: _distances(getattr(comparison, kind), comparison.measured.length) for kind in KINDS}


def _distances(found: Distances, length: float) -> Json:
    numbers = found.numbers
    metres = {
        "max_m": None if numbers is None else numbers.max,
        "mean_m": None if numbers is None else numbers.mean,
        "rms_m": None if numbers is None else numbers.rms,
    }
    shares = {
        f"{key.removesuffix('_m')}_share": None if value is None else value / length for key, value in metres.items()
    }
    return {
        **metres,
        **shares,
        "max_at_m": numbers and numbers.max_at,
        "compared_m": numbers.compared if numbers else 0.0,
        "compared_share": numbers.compared / length if numbers else 0.0,
        "definition": found.definition,
        "reason": found.reason,
    }


def _rival(rival: Motion) -> Json:
    return {
        "moved_x_m": float(rival.moved[0]),
        "moved_y_m": float(rival.moved[1]),
        "turned_deg": rival.turned / DEGREE,
        "rms_m": rival.rms,
        "compared_share": rival.share,
    }


def _fitted(fitted: Fitted) -> Json:
    height = fitted.moved[2] if len(fitted.moved) > 2 else None
    return {
        "what": list(fitted.what),
        "moved_x_m": fitted.moved[0],
        "moved_y_m": fitted.moved[1],
        "moved_z_m": height,
        "turned_deg": fitted.turned / DEGREE,
        "later_s": fitted.later,
        "turned_error_deg": None if fitted.turned_error is None else fitted.turned_error / DEGREE,
        "rival": None if fitted.rival is None else _rival(fitted.rival),
        "slope_angle_deg": None if fitted.slope_angle is None else fitted.slope_angle / DEGREE,
        "fall_line_azimuth_deg": None if fitted.azimuth is None else fitted.azimuth / DEGREE,
        "undetermined": fitted.undetermined,
        "before": _three(fitted.before),
    }
