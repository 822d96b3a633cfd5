"""Report of an identification: identification.json, fits.csv, figures and page."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final, TypeAlias

import numpy as np
from markupsafe import Markup
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from .._support.arrays import BoolArray
from .._support.errors import require_language
from .._support.messages import ENGLISH, Message, in_language, outcome_words, template
from .._support.spreadsheet_text import csv_text, protect_from_formulas
from .._support.staging import require_writable, staged, write_file
from ..identification.problem import Fit
from ..identification.result import Identification, Interval
from .figures.drawing import Drawing, Picture, Progress, picture_files, silent, write_pictures
from .figures.style import BLACK, BLUE, COLOURS, DOUBLE_MM, GREY, MARKERS, ORANGE, PALE, legend_below, new_figure
from .formatting import counted, figure_text, interval, json_text, prose, significant
from .sheet import Header, Section, sheet
from .table import Column, Table

Json: TypeAlias = "Mapping[str, Any]"
ANSWER: Final = "identification.json"
FIGURES: Final = ("tracks", "residuals_track", "residuals_photo_cells", "profiles")
"""Names of an identification's figures, in figures/ as .png and .svg."""
COLUMNS: Final = ("run", "kind", "along", "quantity", "measured", "identified", "sd")


def write_identify_report(
    result: Identification, contents: Json, folder: str | Path, *, language: str = ENGLISH, progress: Progress = silent
) -> Path:
    """Write identification.json, fits.csv, figures/ and report.html; returns the page's path.

    contents: contents of identification.json, from `identification_dict`.
    folder: output folder, created if necessary. Figures of an earlier identification are replaced or removed; other
        files stay.
    language: language of the page and the figures (en, de).
    progress: callback for progress messages.
    Raises OutputError: a file cannot be written.
    Raises ParameterError: the language is unknown.
    """
    require_language(language)
    folder = Path(folder)
    require_writable(folder)
    with staged(folder, last=ANSWER) as stage:
        stage.stale += picture_files(FIGURES)
        write_file(stage.path / ANSWER, f"{json_text(contents)}\n")
        write_file(stage.path / "fits.csv", fits_csv(result))
        with in_language(language):
            pictures = write_pictures(_drawings(result), stage.path / "figures", progress=progress)
            progress("report.html")
            write_file(stage.path / "report.html", identify_page(result, pictures))
    return folder / "report.html"


def fits_csv(result: Identification) -> str:
    """fits.csv: every measured number next to the identified one, with all digits; empty cells for NaN."""
    rows: list[Sequence[str]] = [COLUMNS]
    for fit in result.fits:
        for i, along in enumerate(fit.along):
            for k, label in enumerate(fit.labels):
                numbers = (fit.measured[i, k], fit.fitted[i, k], fit.sd[i, k])
                if math.isfinite(numbers[0]):
                    cells = [repr(float(number)) if math.isfinite(number) else "" for number in numbers]
                    rows.append([protect_from_formulas(fit.name), fit.kind, repr(float(along)), label, *cells])
    return csv_text(rows)


def identify_page(result: Identification, pictures: list[Picture]) -> str:
    """HTML of an identification's report in the current language."""
    fits = [picture for picture in pictures if picture.name != "profiles"]
    profiles = [picture for picture in pictures if picture.name == "profiles"]
    outcome = outcome_words(result.outcome)
    key = [prose("Outcome: {outcome}. {reason}", outcome=outcome, reason=result.reason)]
    warnings = [prose("{text}.", text=text) for text in result.warnings]
    correlations = [correlation_table(result)] if len(result.parameters) > 1 else []
    effort = result.effort
    runs = counted(effort.simulations, "{count} simulated run", "{count} simulated runs")
    rounds = counted(effort.rounds, "{count} Jacobian", "{count} Jacobians")
    methods = [prose("{name} was taken for {kind}.", name=name, kind=kind) for name, kind in result.data]
    methods += [prose("{text}.", text=text) for text in result.methods]
    methods.append(prose("{runs}, {rounds}, {wall:.1f} s.", runs=runs, rounds=rounds, wall=effort.wall_s))
    sections = [
        Section("outcome", Message("Outcome"), key=key, tables=[parameters_table(result)]),
        Section("warnings", Message("Warnings"), words=warnings),
        Section("fit", Message("Measured and identified"), pictures=fits),
        Section("correlation", Message("Correlations"), tables=correlations),
        Section("profiles", Message("Profiles"), pictures=profiles),
        Section("provenance", Message("How it was computed"), words=methods),
    ]
    facts = [
        (Message("Scenario"), result.scenario),
        (Message("Points"), str(result.points)),
        (Message("Computed"), f"skisnow {version('skisnow')}"),
    ]
    title = f"{', '.join(row.parameter.name for row in result.parameters)}: {outcome}"
    kind = Message("Parameters identified from measurements")
    return sheet(Header(kind, title, facts, headline=_headline(result)), sections)


def _headline(result: Identification) -> Markup:
    """Sentence with the first identified parameter and its interval."""
    if not result.parameters:
        return Markup("")
    first = result.parameters[0]
    ends = Message("without an interval")
    if (pair := _pair(first.interval)) is not None:
        ends = Message("95 % interval {interval}", interval=interval(pair))
    value = Markup("<strong>{}</strong>").format(f"{significant(first.value)} {first.parameter.unit}".strip())
    return prose("{name} {value}, {ends}.", name=first.parameter.name, value=value, ends=ends)


def _drawings(result: Identification) -> Iterator[Drawing]:
    """All figures in order; each is drawn when it is requested, so that it gets the style in force."""
    tracks = [fit for fit in result.fits if fit.kind == "track"]
    if tracks:
        words = prose("Tracks from above: points measured, lines with the identified parameters.")
        alt = Message("Measured points and identified tracks from above.")
        yield Drawing("tracks", words, alt, draw_tracks(tracks), wide=True)
    for kind, (caption, alt) in _RESIDUALS.items():
        fits = [fit for fit in result.fits if fit.kind == kind]
        if fits:
            yield Drawing(f"residuals_{kind}", prose(caption), alt, draw_residuals(fits), wide=True)
    if result.profiles:
        words = prose("Rise of the sum of squares, in squared standard deviations, along each parameter.")
        yield Drawing("profiles", words, Message("Profiles of the sum of squares."), draw_profiles(result), wide=True)


_RESIDUALS: Final = {
    "track": (
        template("Measured minus identified along the run; the band is ± two standard deviations of the data."),
        Message("Residuals along the run."),
    ),
    "photo_cells": (
        template("Measured minus identified over the distance; the band is ± two standard deviations of the data."),
        Message("Residuals over the distance."),
    ),
}
"""Caption and alternative text of the residuals of each kind of data."""
_RESIDUAL_LABELS: Final = {
    "x (m)": Message("x\nmeasured − identified (m)"),
    "y (m)": Message("y\nmeasured − identified (m)"),
    "speed (m/s)": Message("speed\nmeasured − identified (m/s)"),
    "time (s)": Message("time\nmeasured − identified (s)"),
}


def parameters_table(result: Identification) -> Table:
    """Table of the identified parameters: values, intervals, bounds, priors."""
    return Table(
        "identified",
        Message("Identified parameters with 95 % intervals; a dash: not requested, or undetermined."),
        (
            Column("key", Message("Key"), "text"),
            Column("value", Message("Value"), digits=4),
            Column("unit", Message("Unit"), "text"),
            Column("interval", Message("Interval by curvature"), "interval"),
            Column("profile", Message("By profile"), "interval"),
            Column("bootstrap", Message("By bootstrap"), "interval"),
            Column("posterior", Message("Posterior"), "interval"),
            Column("start", Message("Start")),
            Column("bounds", Message("Bounds"), "range"),
            Column("prior_mean", Message("Prior mean")),
            Column("prior_sd", Message("Prior s.d.")),
        ),
        [
            (
                row.parameter.key, row.value, row.parameter.unit, _pair(row.interval), _pair(row.profile_interval),
                _pair(row.bootstrap_interval), _pair(row.posterior_interval), row.parameter.start,
                [row.parameter.lower, row.parameter.upper], row.parameter.prior_mean, row.parameter.prior_sd,
            )
            for row in result.parameters
        ],
    )  # fmt: skip


def correlation_table(result: Identification) -> Table:
    """Table with the correlation of each pair of estimated parameters; None if it is not finite."""
    names = [row.parameter.name for row in result.parameters]
    correlations = [[r if np.isfinite(r) else None for r in row] for row in result.correlation.tolist()]
    return Table(
        "correlation",
        Message("Correlations of the estimates. Beyond ±0.9 two parameters are hardly told apart."),
        (Column("parameter", Message("Parameter"), "text"), *(Column(name, name.replace("_", " ")) for name in names)),
        [(name, *row) for name, row in zip(names, correlations, strict=True)],
    )


def _pair(interval: Interval | None) -> list[float] | None:
    """Both ends of an interval as a list; None without an interval, or if an end is unknown."""
    ends = [end for end in interval or () if end is not None]
    return ends if len(ends) == 2 else None


_LARGEST_MM, _SMALLEST_MM = 120.0, 55.0
_MOST_RUNS: Final = len(COLOURS)


def draw_tracks(fits: Sequence[Fit]) -> Figure:
    """Measured points and identified lines from above, the same scale along both axes."""
    places = np.vstack([fit.measured[:, :2] for fit in fits])
    x, y = np.ptp(places[:, 0]) + 2.0, np.ptp(places[:, 1]) + 2.0
    height = float(np.clip((DOUBLE_MM - 25.0) * y / x + 25.0, _SMALLEST_MM, _LARGEST_MM))
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=height)
    axes = figure.subplots()
    points: dict[str, Any] = {"linestyle": "none", "color": BLACK, "markerfacecolor": "none", "markersize": 3.0}
    handles: list[Line2D] = []
    for number, fit in enumerate(fits[:_MOST_RUNS]):
        label = Message("{name}, identified", name=figure_text(fit.name))
        line = axes.plot(*fit.fitted.T[:2], label=label, color=COLOURS[number], zorder=3)
        label = Message("{name}, measured", name=figure_text(fit.name))
        handles += axes.plot(*fit.measured.T[:2], label=label, marker=MARKERS[number], zorder=2, **points) + line
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel(Message("x, down the fall line (m)"))
    axes.set_ylabel(Message("y, to the left (m)"))
    legend_below(figure, handles)
    return figure


def draw_residuals(fits: Sequence[Fit]) -> Figure:
    """Measured minus identified for each quantity; the band is twice the standard deviation."""
    labels = [label for i, label in enumerate(fits[0].labels) if any(_measured_mask(fit, i).any() for fit in fits)]
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=30.0 + 34.0 * len(labels))
    rows = figure.subplots(len(labels), 1, sharex=True, squeeze=False)[:, 0]
    handles = []
    for number, fit in enumerate(fits[:_MOST_RUNS]):
        colour, marker = COLOURS[number], MARKERS[number]
        for axes, label in zip(rows, labels, strict=True):
            i = fit.labels.index(label)
            use = _measured_mask(fit, i)
            along, residual, sd = fit.along[use], fit.residual[use, i], fit.sd[use, i]
            axes.fill_between(along, -2.0 * sd, 2.0 * sd, color=PALE, alpha=0.35, linewidth=0.0, zorder=0)
            axes.plot(along, residual, color=colour, marker=marker, markerfacecolor="none", linewidth=0.6, zorder=3)
        handles.append(Line2D([], [], color=colour, marker=marker, markerfacecolor="none", label=figure_text(fit.name)))
    for axes, label in zip(rows, labels, strict=True):
        axes.axhline(0.0, color=GREY, linewidth=0.6, zorder=1)
        axes.set_ylabel(_RESIDUAL_LABELS[label])
    is_track = fits[0].kind == "track"
    rows[-1].set_xlabel(Message("time (s)") if is_track else Message("distance from the start (m)"))
    figure.align_ylabels()
    legend_below(figure, handles)
    return figure


def _measured_mask(fit: Fit, i: int) -> BoolArray:
    """True where column i of a fit has a measured value and its standard deviation."""
    return np.isfinite(fit.measured[:, i]) & np.isfinite(fit.sd[:, i])


def draw_profiles(result: Identification) -> Figure:
    """One panel for each parameter: its profile, the parabola from the curvature, the limit of the 95 % interval."""
    columns = min(3, len(result.profiles))
    rows = -(-len(result.profiles) // columns)
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=20.0 + 50.0 * rows)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes, profile in zip(panels, result.profiles, strict=False):
        row = result[profile.key]
        finite = np.isfinite(profile.rise)
        axes.plot(profile.value[finite], profile.rise[finite], color=BLUE, marker="o", markerfacecolor="none")
        if row.value is not None and row.standard_error:
            value = np.linspace(profile.value[0], profile.value[-1], 101)
            parabola = ((value - row.value) / row.standard_error) ** 2
            axes.plot(value, parabola, color=ORANGE, linestyle=(0, (4, 2)))
        axes.axhline(profile.limit, color=GREY, linewidth=0.8, linestyle=(0, (1, 1.2)))
        unit = f" ({row.parameter.unit})" if row.parameter.unit else ""
        axes.set_xlabel(f"{row.parameter.name.replace('_', ' ')}{unit}")
        axes.set_ylim(-0.5, 3.0 * profile.limit)
    for axes in panels[len(result.profiles) :]:
        axes.set_visible(False)
    panels[0].set_ylabel(Message("rise of the sum of squares"))
    handles = [
        Line2D([], [], color=BLUE, marker="o", markerfacecolor="none", label=Message("others refitted")),
        Line2D([], [], color=ORANGE, linestyle=(0, (4, 2)), label=Message("from the curvature")),
        Line2D([], [], color=GREY, linestyle=(0, (1, 1.2)), label=Message("limit of the 95 % interval")),
    ]
    legend_below(figure, handles)
    for axes in panels:
        axes.tick_params(colors=BLACK)
    return figure
