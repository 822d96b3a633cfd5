"""The section ``snow_micro_pen`` of results.json."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

from .._support.units import MM
from ..parameters import values_of

if TYPE_CHECKING:
    from .snow_micro_pen import EvaluatedRecording, SnowMicroPenAnalysis, WindowMeans

Json: TypeAlias = dict[str, Any]


def snow_micro_pen_results(found: SnowMicroPenAnalysis) -> Json:
    """The settings, and a row for each recording; NaN stands where there is no number."""
    recordings = found.recordings
    names = zip(recordings.recording, recordings.site, recordings.spot, recordings.file, strict=True)
    return {
        **values_of(recordings.settings),
        "recordings": [
            dict(zip(("recording", "site", "spot", "file"), own, strict=True))
            | _row(each, each.windows[recordings.settings.relation])
            for own, each in zip(names, found.evaluated, strict=True)
        ],
    }


def _row(each: EvaluatedRecording, chosen: WindowMeans) -> Json:
    return {
        "used": each.is_used,
        "flags": list(each.flags),
        "surface_mm": each.surface / MM,
        "reach_mm": each.reach / MM,
        "air_force_N": each.air_force,
        "mean_force_N": each.mean_force,
        "median_force_N": each.median_force,
        "rupture_force_N": chosen.rupture_force,
        "deflection_mm": chosen.deflection / MM,
        "element_size_mm": chosen.element_size / MM,
        **_of_relation(chosen),
        "by_relation": {name: _of_relation(windows) for name, windows in each.windows.items()},
    }


def _of_relation(windows: WindowMeans) -> Json:
    return {
        "snow_density_kg_per_m3": windows.snow_density,
        "specific_surface_area_m2_per_kg": windows.specific_surface_area,
        "n_windows": windows.n,
    }
