"""A track in the frame of a scenario's slope."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np
import numpy.typing as npt

from .._support.errors import ParameterError
from .._support.units import DEGREE
from ..parameters import checked_table, made
from ..scenario import Plane, ScenarioFile
from ..scenario.identify_section import SITE, Site
from ..track.projection import GeodeticPoint, east_north_up
from ..track.slope_frame import in_slope_frame
from ..track.track import Track

FloatArray = npt.NDArray[np.float64]
FARTHEST: Final = 50_000.0
"""(m) from the site: a track beyond is of another place, and a plane no longer the earth (modelling assumption)."""


def in_scenario_frame(track: Track, scenario: ScenarioFile, site: object) -> tuple[Track, list[str]]:
    """The track with x down the fall line and y to the left, and how that was done, in words.

    Parameters
    ----------
    track
        In any frame; metres of its own file are taken as the slope's.
    scenario
        The scenario.
    site
        ``[identify.site]`` as it stands in the file: where the slope lies. None where it is left out.

    Raises
    ------
    ParameterError
        The track is east, north, up, and nothing says how the slope lies; or it is of another place.
    """
    if track.axes != "east_north_up":
        return track, []
    if site is None:
        raise ParameterError(
            f"{track.name} is in east, north and up, and the slope lies nowhere: write [identify.site] with "
            "fall_line_azimuth_deg (the compass direction in which it falls), and latitude_deg and longitude_deg "
            "of its x = y = 0; without these the track's first point is taken as the scenario's start"
        )
    said = _site(site)
    azimuth = said.fall_line_azimuth_deg * DEGREE
    slope = scenario.scenario.slope
    angle = slope.angle if isinstance(slope, Plane) else None
    if said.latitude_deg is not None and said.longitude_deg is not None and track.origin is not None:
        height = track.origin.height if said.height_m is None else said.height_m
        point = GeodeticPoint(said.latitude_deg, said.longitude_deg, height)
        origin = _place_of(point, track)
        turned = in_slope_frame(
            track, fall_line_azimuth=azimuth, slope_angle=angle, origin=origin, missing_height="on_slope"
        )
        return turned, [f"tracks are counted from the site at {point}"]
    return _from_its_first_point(track, scenario, azimuth, angle)


def _from_its_first_point(
    track: Track, scenario: ScenarioFile, azimuth: float, angle: float | None
) -> tuple[Track, list[str]]:
    first = int(np.argmax(track.usable))
    origin = np.nan_to_num(track.place[first])
    turned = in_slope_frame(
        track, fall_line_azimuth=azimuth, slope_angle=angle, origin=origin, missing_height="on_slope"
    )
    start = scenario.scenario.start
    place = turned.place + np.array([start.x, start.y, 0.0])
    method = "the first point of each track is taken as the scenario's start; its error is in all points"
    return replace(turned, place=place), [method]


def _place_of(point: GeodeticPoint, track: Track) -> FloatArray:
    """The site in the track's frame (m)."""
    assert track.origin is not None
    at = east_north_up(np.array([[point.latitude_deg, point.longitude_deg, point.height]]), origin=track.origin)[0]
    distance = math.hypot(at[0], at[1])
    if distance > FARTHEST:
        raise ParameterError(
            f"{track.name} is {distance / 1000.0:.4g} km from the site of [identify.site]: it is of another place, or "
            "latitude and longitude are swapped"
        )
    return at


def _site(site: object) -> Site:
    if not isinstance(site, Mapping):
        raise ParameterError(f"identify.site is {site!r}; it must be a table with {', '.join(SITE)}")
    found = made(Site, checked_table(Site, site, "[identify.site]"))
    if (found.latitude_deg is None) != (found.longitude_deg is None):
        raise ParameterError("[identify.site]: latitude_deg and longitude_deg go together; one is missing")
    return found
