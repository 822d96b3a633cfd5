"""The line of a run over its course, with the edge angle as colour."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ..._support.errors import ParameterError
from ..._support.units import DEGREE
from ...scenario import Plane
from ...scenario.slope_surface import normals_of
from ...simulation.run_gates import run_gates
from .course_line import course_line

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ...simulation.run import Run

FloatArray = npt.NDArray[np.float64]


def run_course(run: Run) -> Figure:
    """Draw it; a run without a course has none."""
    result = run_gates(run)
    if result is None:
        raise ParameterError("the run has no course, or ended before its first step; give the scenario course.file")
    level = isinstance(run.scenario.slope, Plane)
    words = "distance down the fall line $x$" if level else "horizontal distance $x$"
    label = "edge angle (°)"
    return course_line(result, run.place, edge_angles(run) / DEGREE, label=label, diverging=True, axes_words=words)


def edge_angles(run: Run) -> FloatArray:
    """Angle of the bases at the boots to the snow's surface, mean of both skis, positive: left edges down (rad)."""
    return edge_angles_of_skis(run).mean(axis=1)


def edge_angles_of_skis(run: Run) -> FloatArray:
    """The same of each ski, (n, 2), or (n, 1) of skis that are edged alike."""
    normal = normals_of(run.scenario.slope, run.place[:, 0], run.place[:, 1])
    if run.boots is not None:
        left = run.boots.axes[:, :, 1]
    else:
        angle = run.scenario.sledge.edge_angle
        left = (run.attitude @ np.array([0.0, np.cos(angle), -np.sin(angle)]))[:, None]
    return np.asarray(np.arcsin(np.clip(-np.einsum("nka,na->nk", left, normal), -1.0, 1.0)))
