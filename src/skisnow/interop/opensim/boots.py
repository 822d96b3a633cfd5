"""Poses of boots from markers, for ``boots.file`` of a scenario."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError, require_choice
from ..._support.units import DEGREE
from ...geometry.boot_axes import angles_of
from ...scenario.boots import ANGLES, LARGEST, OF_SLOPE, SIDES, Boots
from .markers import Markers

FROM_OPENSIM: Final = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""From axes with y up and z to the right to those with y to the left and z up."""


@dataclass(frozen=True, slots=True)
class BootMarkers:
    """Three markers of a boot, and where its sole is from the one at the heel.

    Attributes
    ----------
    heel, toe
        Names of markers one behind the other along the boot.
    left
        Name of a marker to the left of that line, at the height of the base where the ski lies flat.
    sole
        Middle of the sole at the level of the base, from the heel's marker: ahead, left, up in the boot's axes (m).
    """

    heel: str
    toe: str
    left: str
    sole: tuple[float, float, float] = (0.0, 0.0, 0.0)


def boots_of_markers(
    markers: Markers,
    left: BootMarkers,
    right: BootMarkers,
    *,
    up: Literal["y", "z"] = "y",
    slope_angle: float = 0.0,
) -> Boots:
    """Poses of both boots in the slope's axes.

    Parameters
    ----------
    markers
        In axes whose x points horizontally down the slope and whose third or second axis points up.
    left, right
        The markers of each boot.
    up
        "y" as OpenSim has it (z to the right), or "z" (y to the left).
    slope_angle
        Angle of the slope (rad): the boots' poses are turned into its axes. 0 where the markers' axes are those of the
        slope.

    Raises
    ------
    ParameterError
        A marker is missing, was not seen in a frame (the error gives name and time), or three lie on one line.
    """
    require_choice("up", up, ("y", "z"))
    c, s = np.cos(slope_angle), np.sin(slope_angle)
    turned = np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]]) @ (FROM_OPENSIM if up == "y" else np.eye(3))
    poses = [_pose(markers, boot, turned) for boot in (left, right)]
    place, axes = (np.stack(pose, axis=1) for pose in zip(*poses, strict=True))
    return Boots(markers.time, place, axes, frame="slope", source="markers")


def _pose(markers: Markers, of: BootMarkers, turned: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Places (n, 3) and axes (n, 3, 3), rows ahead, left and off the base."""
    heel, toe, left = (_seen(markers, name) @ turned.T for name in (of.heel, of.toe, of.left))
    ahead = _unit(toe - heel, of)
    off = _unit(np.cross(ahead, left - heel), of)
    axes = np.stack([ahead, np.cross(off, ahead), off], axis=1)
    return heel + np.einsum("c,nca->na", np.asarray(of.sole), axes), axes


def _seen(markers: Markers, name: str) -> FloatArray:
    place = markers.of(name)
    unseen = ~np.isfinite(place).all(axis=1)
    if unseen.any():
        first = float(markers.time[int(np.argmax(unseen))])
        raise ParameterError(
            "marker {name} was not seen in {count} frames, first at {first:g} s; fill the gaps before",
            code="gap",
            name=name,
            count=int(unseen.sum()),
            first=first,
        )
    far = ~(np.abs(place) <= LARGEST).all(axis=1)
    if far.any():
        first = float(markers.time[int(np.argmax(far))])
        raise ParameterError(
            "marker {name} is beyond ±{largest:g} m in {count} frames, first at {first:g} s. Correct the numbers, or "
            "the unit of the file.",
            code="out_of_range",
            name=name,
            largest=LARGEST,
            count=int(far.sum()),
            first=first,
        )
    return place


def _unit(vectors: FloatArray, of: BootMarkers) -> FloatArray:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    if not np.all(length > 1e-9):
        raise ParameterError(
            "markers {heel}, {toe} and {left} lie on one line; three that span a plane are needed",
            code="out_of_range",
            heel=of.heel,
            toe=of.toe,
            left=of.left,
        )
    return np.asarray(vectors / length)


def boots_text(boots: Boots, *, edge_angles_only: bool = False) -> str:
    """Poses in the slope's frame as the text of a CSV file for ``boots.file``.

    Parameters
    ----------
    boots
        As `boots_of_markers` gives them.
    edge_angles_only
        Edge angles alone: the sledge of the scenario carries the boots, and the snow it.
    """
    angles = angles_of(boots.axes) / DEGREE
    columns: dict[str, Sequence[float]] = {"time_s": boots.at.tolist()}
    for k, side in enumerate(SIDES):
        if not edge_angles_only:
            columns |= {f"{side}_{name}": boots.place[:, k, i].tolist() for i, name in enumerate(OF_SLOPE)}
        names = ANGLES[:1] if edge_angles_only else ANGLES
        columns |= {f"{side}_{name}": angles[:, k, i].tolist() for i, name in enumerate(names)}
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([repr(cell) for cell in row] for row in zip(*columns.values(), strict=True))
    return stream.getvalue()
