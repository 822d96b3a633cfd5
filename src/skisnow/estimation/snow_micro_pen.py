"""Evaluation of SnowMicroPen recordings: mean force, shot noise, density, specific surface area."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, Final, NamedTuple, TypeAlias

import numpy as np

from .._support.arrays import BoolArray, FloatArray
from .._support.units import MM, Facts, Shown
from ..campaign.snow_micro_pen import (
    SnowMicroPenProfile,
    SnowMicroPenRecordings,
    SnowMicroPenSettings,
    SnowSurface,
    snow_surface,
)
from ..parameters import values_of
from ..snow.measured_range import PENETROMETER_RELATIONS
from ..statistics.shot_noise import ShotNoise, shot_noise, windows_of

OVERLAP: Final = 0.5
"""Share of a window that the next one begins in (modelling assumption, as in the instrument's own program)."""
CANCELLED: Final = "cancelled"
NO_SURFACE: Final = "no_surface"
TOO_SHORT: Final = "too_short"
FLAGS: Final = {
    CANCELLED: "the status of its row is not blank",
    NO_SURFACE: "the force rises nowhere out of the air's; surface_mm in the table tells where the snow begins",
    TOO_SHORT: "it ends above the depth to which the force is averaged",
}
"""Why a recording is not used, by code."""
Json: TypeAlias = dict[str, Any]


@dataclass(frozen=True, slots=True)
class WindowMeans:
    """Medians of the shot noise of the windows between the two depths, means of density and surface area.

    rupture_force, deflection, element_size: f₀ (N), δ (m), L (m): medians.
    snow_density, specific_surface_area: means (kg/m³, m²/kg); NaN if the relation gives no value.
    n: windows.
    """

    rupture_force: float = math.nan
    deflection: float = math.nan
    element_size: float = math.nan
    snow_density: float = math.nan
    specific_surface_area: float = math.nan
    n: int = 0


@dataclass(frozen=True, slots=True)
class EvaluatedRecording:
    """One recording; NaN where it has no such number.

    flags: codes of `FLAGS`; a recording without flags is used.
    surface: depth of the snow surface from where the recording began (m).
    reach: how deep below the surface it ends (m).
    air_force: in the air before the surface (N).
    mean_force, median_force: between the two depths (N).
    resistance: penetration resistance: the mean force over the cross-section of the tip (Pa). It is the hardness of the
        international classification of seasonal snow (Fierz and others 2009), not H_V.
    windows: by the name of each published relation.
    """

    flags: tuple[str, ...]
    surface: float = math.nan
    reach: float = math.nan
    air_force: float = math.nan
    mean_force: float = math.nan
    median_force: float = math.nan
    resistance: float = math.nan
    windows: dict[str, WindowMeans] = field(
        default_factory=lambda: dict.fromkeys(PENETROMETER_RELATIONS, WindowMeans())
    )

    @property
    def is_used(self) -> bool:
        """True if the recording is included in means and regressions."""
        return not self.flags


@dataclass(frozen=True, slots=True, repr=False)
class SnowMicroPenAnalysis(Shown):
    """The recordings of a campaign, evaluated one by one, in the order of its table."""

    recordings: SnowMicroPenRecordings
    evaluated: tuple[EvaluatedRecording, ...]

    def _repr_facts(self) -> Facts:
        used = sum(recording.is_used for recording in self.evaluated)
        return Facts(f"{used} of {len(self.evaluated)} recordings used")

    @property
    def mean_force(self) -> FloatArray:
        """Mean force of each recording (N), NaN where it is not used."""
        return np.array([recording.mean_force if recording.is_used else math.nan for recording in self.evaluated])

    @property
    def snow_density(self) -> FloatArray:
        """Density of each recording by the campaign's relation (kg/m³), NaN where it is not used."""
        name = self.recordings.settings.relation
        return np.array(
            [recording.windows[name].snow_density if recording.is_used else math.nan for recording in self.evaluated]
        )

    def at(self, sites: tuple[str, ...], spots: tuple[str, ...], values: FloatArray) -> FloatArray:
        """The mean of the values at each place: of the recordings at its spot, else of those at its site, else NaN."""
        finite = np.isfinite(values)
        of_spot = _means_by_site_and_spot(zip(self.recordings.site, self.recordings.spot, strict=True), values, finite)
        of_site = _means_by_site_and_spot(((site, "") for site in self.recordings.site), values, finite)
        return np.array(
            [
                of_spot[site, spot] if spot and (site, spot) in of_spot else of_site.get((site, ""), math.nan)
                for site, spot in zip(sites, spots, strict=True)
            ]
        )


def _means_by_site_and_spot(
    places: Iterable[tuple[str, str]], values: FloatArray, usable: BoolArray
) -> dict[tuple[str, str], float]:
    """Mean of the usable values, by site and spot; pairs without a usable value are left out."""
    collected: dict[tuple[str, str], list[float]] = {}
    for place, value, use in zip(places, values.tolist(), usable.tolist(), strict=True):
        if use:
            collected.setdefault(place, []).append(value)
    return {place: math.fsum(items) / len(items) for place, items in collected.items()}


def evaluate_recordings(recordings: SnowMicroPenRecordings) -> SnowMicroPenAnalysis:
    """Evaluate every recording of a campaign, one after the other."""
    evaluated = (
        evaluate_profile(
            recordings.profile(index),
            recordings.settings,
            surface=float(recordings.surface[index]),
            is_cancelled=bool(recordings.cancelled[index]),
        )
        for index in range(len(recordings))
    )
    return SnowMicroPenAnalysis(recordings, tuple(evaluated))


def evaluate_profile(
    profile: SnowMicroPenProfile,
    settings: SnowMicroPenSettings,
    *,
    surface: float = math.nan,
    is_cancelled: bool = False,
) -> EvaluatedRecording:
    """Mean force, shot noise, density and surface area of one recording.

    settings: between which depths, by which relation, how the surface is estimated.
    surface: where the snow begins (m from the first sample); NaN: it is estimated.
    is_cancelled: True if the row states it.

    Source: The page docs/methods/snow-micro-pen.md.
    """
    top: SnowSurface | None
    if math.isnan(surface):
        rise, hold = settings.surface_rise, settings.surface_hold
        top = snow_surface(profile.force, profile.sample_distance, rise=rise, hold=hold)
    else:
        air = profile.force[: round(surface / profile.sample_distance)]
        top = SnowSurface(surface, float(np.median(air)) if len(air) else 0.0)
    flags = [CANCELLED] if is_cancelled else []
    if top is None:
        return EvaluatedRecording((*flags, NO_SURFACE))
    reach = float(profile.depth[-1]) - top.depth
    if reach < settings.to_depth:
        return EvaluatedRecording((*flags, TOO_SHORT), top.depth, reach, top.air_force)
    force = profile.force - top.air_force if settings.subtract_air_force else profile.force
    first, last = (
        round((top.depth + depth) / profile.sample_distance) for depth in (settings.from_depth, settings.to_depth)
    )
    part = force[first:last]
    area = _cone_area(profile)
    windows = {name: _window_means(part, profile.sample_distance, area, name) for name in PENETROMETER_RELATIONS}
    mean, median = float(part.mean()), float(np.median(part))
    return EvaluatedRecording(tuple(flags), top.depth, reach, top.air_force, mean, median, mean / area, windows)


@dataclass(frozen=True, slots=True)
class DepthProfile:
    """Force, density and surface area over the depth below the snow surface, at the middle of each window.

    depth: m, downwards.
    force: median (N).
    snow_density, specific_surface_area: kg/m³ and m²/kg, NaN where the relation gives no value.
    """

    depth: FloatArray
    force: FloatArray
    snow_density: FloatArray
    specific_surface_area: FloatArray


def depth_profile(profile: SnowMicroPenProfile, settings: SnowMicroPenSettings, surface: float) -> DepthProfile:
    """Values of the windows of a recording from its ``surface`` (m from the first sample) to its end."""
    air = profile.force[: round(surface / profile.sample_distance)]
    taken_off = float(np.median(air)) if settings.subtract_air_force and len(air) else 0.0
    force = profile.force[len(air) :] - taken_off
    windows = _values_of_windows(force, profile.sample_distance, _cone_area(profile), settings.relation)
    step = windows.step * profile.sample_distance
    depth: FloatArray = np.arange(len(windows.median)) * np.float64(step) + 0.5 * windows.size * profile.sample_distance
    return DepthProfile(depth, windows.median, windows.snow_density, windows.specific_surface_area)


def _cone_area(profile: SnowMicroPenProfile) -> float:
    """Base area (m²) of the penetrometer's tip."""
    return 0.25 * math.pi * profile.tip_diameter**2


class _Windows(NamedTuple):
    """Values of a recording's windows, NaN where the shot noise is not determined; size and step in samples."""

    size: int
    step: int
    noise: ShotNoise
    median: FloatArray
    element_size: FloatArray
    snow_density: FloatArray
    specific_surface_area: FloatArray


def _values_of_windows(force: FloatArray, sample_distance: float, area: float, name: str) -> _Windows:
    """Shot-noise and snow values in each window of a force (N); NaN where the noise or the median is unusable."""
    relation = PENETROMETER_RELATIONS[name]
    size = max(round(relation.window / sample_distance), 3)
    step = max(round(size * (1.0 - OVERLAP)), 1)
    windows = windows_of(force, size, step)
    noise = shot_noise(windows, sample_distance)
    median = np.median(windows, axis=-1)
    usable = np.isfinite(noise.intensity) & (median > 0.0)
    element_size, density, surface_area = np.full((3, len(median)), np.nan)
    element_size[usable] = np.cbrt(area / noise.intensity[usable])
    density[usable] = relation.snow_density(median[usable], element_size[usable])
    if relation.specific_surface_area is not None:
        surface_area[usable] = relation.specific_surface_area(median[usable], element_size[usable])
    return _Windows(size, step, noise, median, element_size, density, surface_area)


def _window_means(force: FloatArray, sample_distance: float, area: float, name: str) -> WindowMeans:
    """Medians and means over the usable windows of a force (N); NaN and n = 0 if no window is usable."""
    values = _values_of_windows(force, sample_distance, area, name)
    usable = np.isfinite(values.element_size)
    if not usable.any():
        return WindowMeans()
    return WindowMeans(
        rupture_force=float(np.median(values.noise.rupture_force[usable])),
        deflection=float(np.median(values.noise.deflection[usable])),
        element_size=float(np.median(values.element_size[usable])),
        snow_density=float(values.snow_density[usable].mean()),
        specific_surface_area=float(values.specific_surface_area[usable].mean()),
        n=int(usable.sum()),
    )


def snow_micro_pen_results(analysis: SnowMicroPenAnalysis) -> Json:
    """The settings, and a row for each recording; NaN for missing values."""
    recordings = analysis.recordings
    names = zip(recordings.recording, recordings.site, recordings.spot, recordings.file, strict=True)
    return {
        **values_of(recordings.settings),
        "recordings": [
            dict(zip(("recording", "site", "spot", "file"), own, strict=True))
            | _recording_json(recording, recording.windows[recordings.settings.relation])
            for own, recording in zip(names, analysis.evaluated, strict=True)
        ],
    }


def _recording_json(recording: EvaluatedRecording, chosen: WindowMeans) -> Json:
    """JSON of a recording: flags, forces (N), and values by the chosen and by each other relation."""
    return {
        "used": recording.is_used,
        "flags": list(recording.flags),
        "surface_mm": recording.surface / MM,
        "reach_mm": recording.reach / MM,
        "air_force_N": recording.air_force,
        "mean_force_N": recording.mean_force,
        "median_force_N": recording.median_force,
        "penetration_resistance_kPa": recording.resistance / 1e3,
        "rupture_force_N": chosen.rupture_force,
        "deflection_mm": chosen.deflection / MM,
        "element_size_mm": chosen.element_size / MM,
        **_density_and_surface_area(chosen),
        "by_relation": {name: _density_and_surface_area(windows) for name, windows in recording.windows.items()},
    }


def _density_and_surface_area(windows: WindowMeans) -> Json:
    """JSON of density (kg/m³), specific surface area (m²/kg), and the number of windows."""
    return {
        "snow_density_kg_per_m3": windows.snow_density,
        "specific_surface_area_m2_per_kg": windows.specific_surface_area,
        "n_windows": windows.n,
    }
