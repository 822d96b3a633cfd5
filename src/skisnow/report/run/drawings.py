"""Figures of a run with their captions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, Final, NamedTuple

from markupsafe import Markup
from matplotlib.figure import Figure

from ..._support.errors import ParameterError
from ..._support.messages import Message, template
from ..._support.units import DEGREE, MM
from ..._support.user_files.json_text import json_number
from ...parameters import suggest_and_list
from ...simulation.run import Run
from ..figures.course import run_course
from ..figures.drawing import Drawing
from ..figures.style import journal_style
from ..formatting import prose, significant
from . import time_figures
from .track_figure import CUTOUT, STEADY, run_track


class RunFigure(NamedTuple):
    """A figure of a run: function that draws it, template of its caption, description for screen readers.

    ``fields`` of a run: values in both texts. ``further`` sentences of the caption.
    """

    draw: Callable[[Run], Figure]
    caption: str
    alt: str
    fields: Callable[[Run], dict[str, Any]] = lambda _run: {}
    further: Callable[[Run], Markup] = lambda _run: Markup("")


def run_drawings(run: Run) -> Iterator[Drawing]:
    """All figures in order, drawn in the style in force when they are requested; none for a run without a step."""
    if len(run.time) < 2:
        return
    absent = {
        "course": run.scenario.course is None,
        "boots": run.scenario.skier is not None or run.boots_by is None,
        "balance": run.scenario.skier is None,
    }
    for name, (draw, caption, alt, fields, further) in _FIGURES.items():
        if not absent.get(name, False):
            values = fields(run)
            words = prose(caption, **values) + further(run)
            yield Drawing(name, words, Message(alt, **values), draw(run), wide=True)


def _carved_radius(run: Run) -> Markup:
    """Sentence about the dotted line of the carved radius; empty for moving boots, which have none."""
    if run.boots_by is not None:
        return Markup("")
    return prose(
        " Dotted: the radius of a ski that is bent onto a hard plane at {angle:.3g}° without twist.",
        angle=run.scenario.sledge.edge_angle / DEGREE,
    )


def _other_strength(run: Run) -> Markup:
    """Caption's sentence about Python laws that replace laws of the scenario, except friction; empty without one."""
    laws = [name.replace("_", " ") for name, law in run.given_laws.items() if law and name != "friction"]
    if not laws:
        return Markup("")
    return prose(
        " S_f here is the scenario's; the run had another strength ({given}, given in Python), whose limit is not at "
        "1.",
        given=", ".join(laws),
    )


_FIGURES: Final = {
    "track": RunFigure(
        run_track,
        template(
            "(a) The run from above, the same scale along both axes. (b, c) The grooves of both skis over {length} m "
            "at half time: along the track of the loaded edge in metres, across it in millimetres. Their edges are "
            "medians over {lines} lines of snow."
        ),
        template("Tracks of both skis from above, {run_length} m long, and their grooves."),
        lambda run: {"length": significant(CUTOUT, 2), "lines": STEADY, "run_length": significant(run.run_length)},
    ),
    "course": RunFigure(
        run_course,
        template(
            "The line of the middle between the boots over the course, from above; colour: edge angle at the boots, "
            "positive with the left edges down. A cross: the gate was not passed. Gates to which no outer pole is "
            "known are drawn with a piece of their line."
        ),
        template("Line over the gates of the course, coloured by edge angle."),
    ),
    "motion": RunFigure(
        time_figures.run_motion,
        template(
            "(a) Speed, (b) heading of the skis and (c) radius of the path of the middle between the boots. The "
            "radius is not drawn where it is more than three times its median."
        ),
        template("Speed, heading and turn radius over time."),
        further=_carved_radius,
    ),
    "boots": RunFigure(
        time_figures.run_boots,
        template(
            "(a) Edge angle of each boot to the snow's surface. Force of each ski on its boot, in the boot's axes: (b) "
            "off the base, (c) across it. (d) Moment of the ski on its boot about the boot's long axis, positive where "
            "it turns the left edge up. Each axis leaves one peak in a hundred out."
        ),
        template("Edge angles of both boots, and forces and edging moment of the skis on them, over time."),
    ),
    "balance": RunFigure(
        time_figures.run_balance,
        template(
            "(a) Lean of the line from the middle of the boots to the centre of mass, edge angle, and the lean that "
            "would be in balance with speed and path radius of the centre of mass. Force of the snow on each ski: (b) "
            "total, (c) normal, (d) side force. The axes of (b, c, d) leave one peak in a hundred out."
        ),
        template("Lean, edge angle and forces of a skier over time."),
    ),
    "along_ski": RunFigure(
        time_figures.run_along_ski,
        template(
            "(a, b) Depth of the edge below the undisturbed surface and (c, d) normal force of the snow per length, "
            "over time. White: the edge is above the snow, or the snow does not press: behind the place of the largest "
            "load the afterbody runs in the groove that the forebody cut. Up to one value in 200 is beyond a scale and "
            "has its last colour."
        ),
        template("Maps of edge depth and normal force per length over position along the ski and time, for both skis."),
    ),
    "grip": RunFigure(
        time_figures.run_grip,
        template(
            "Grip utilisation of each ski. Net: the sum of its side force over the capacity, the sum of S_f e; at 1 "
            "the ski side-slips. Gross: the sum of the sizes of the shear instead, which is more where parts of the "
            "edge pull against each other. A place of snow slips by {slip} mm across while a ski passes. In a carved "
            "turn such pulls end with a shear displacement u_y of 0.5 to 1 mm."
        ),
        template("Grip utilisation of each ski over time."),
        lambda run: {"slip": significant(json_number(time_figures.slip_of_a_place(run) / MM), 2)},
        _other_strength,
    ),
    "energies": RunFigure(
        time_figures.run_energies,
        template(
            "(a) Where the energy is and went; the potential energy is above its minimum. Everything on top of each "
            "other must stay at the dashed line. (b) Only the losses."
        ),
        template("Stored energies and losses over time, stacked."),
    ),
}
"""Figures by name, in the order of the report."""


def run_figure(run: Run, what: str) -> Figure:
    """Figure of a run with the name `what`, in the style of the reports; rejects unknown names and empty runs."""
    if what not in _FIGURES:
        raise ParameterError("unknown figure {figure!r} of a run. {nearest}").tag(
            "unknown_figure", figure=what, nearest=suggest_and_list(what, _FIGURES)
        )
    if len(run.time) < 2:
        raise ParameterError("the run ended before its first step ({outcome}); no figure can be drawn").tag(
            "nothing_to_draw", outcome=run.outcome
        )
    with journal_style():
        return _FIGURES[what].draw(run)
