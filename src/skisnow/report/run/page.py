"""Page of a simulated run, and its folder with run.nc, tables and figures."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final

import numpy as np
from markupsafe import Markup

from ..._support.errors import require_language
from ..._support.messages import ENGLISH, Message, in_language, local_number, outcome_words, template
from ..._support.staging import prepare_folder, staged, write_file
from ..._support.units import DEGREE, MM, N_PER_MM2, N_PER_MM3
from ..._support.user_files.json_text import json_number
from ...geometry.surfaces import Grid
from ...scenario.plausibility import implausible_values, model_limits
from ...simulation.run import Run
from ...simulation.run_summary import run_gates, run_warnings, summary_dict
from ...simulation.run_tables import write_track
from ...track.course.gates_table import gates_csv, time_warnings
from ..figures.course import edge_angles_of_skis
from ..figures.drawing import Picture, Progress, picture_files, silent, write_pictures
from ..formatting import counted, html, json_text, prose, significant, whole
from ..sheet import Header, Section, sheet
from .drawings import run_drawings
from .file import write_run_file
from .tables import energies_table, gates_table, scenario_table, skis_table, verification_table

FIGURES: Final = ("track", "motion", "along_ski", "grip", "energies")
"""Names of a run's figures, in figures/ as .png and .svg."""
FURTHER: Final = ("course", "balance", "boots")
"""Names of the further figures of a run with a course, a skier, or moving boots."""
REPLAY: Final = "replay.html"  # name of the file with the replay


def run_page(run: Run, summary: Mapping[str, Any], pictures: Sequence[Picture], *, has_replay: bool = False) -> str:
    """HTML of a run's report in the current language, with a link to the replay if there is one."""

    def drawn(*names: str) -> list[Picture]:
        return [picture for name in names for picture in pictures if picture.name == name]

    no_step = [] if pictures else [prose("The run ended before its first step; no figure can be drawn.")]
    gates, verification = run_gates(run), summary.get("verification")
    words = [] if gates is None else [prose("{text}.", text=text) for text in time_warnings(gates)]
    course, skis = [] if gates is None else [gates_table(gates)], [skis_table(run)]
    sections = [
        Section("gates", Message("Gates"), words=words, pictures=drawn("course"), tables=course),
        Section("motion", Message("Speed, heading, turn radius"), pictures=drawn("motion")),
        Section("balance", Message("Balance of the skier"), pictures=drawn("balance")),
        Section("boots", Message("Boots"), pictures=drawn("boots")),
        Section("along-skis", Message("Along the skis"), pictures=drawn("along_ski", "grip"), tables=skis),
        Section("energies", Message("Energies"), pictures=drawn("energies"), tables=[energies_table(dict(summary))]),
    ]
    again = [verification_table(verification)] if verification else []
    return sheet(
        _make_header(run, has_replay=has_replay),
        [
            Section("outcome", Message("Outcome"), outcome_sentences(run), no_step, drawn("track")),
            *(sections if pictures else []),
            Section("verification", Message("Computed again"), tables=again),
            Section("scenario", Message("Scenario"), tables=[scenario_table(summary["scenario"])]),
            Section("provenance", Message("Provenance"), words=provenance_sentences(run, summary)),
        ],
    )


def _make_header(run: Run, *, has_replay: bool) -> Header:
    """Header of a run's page: title, snow, skis, version and, with `has_replay`, the link to the replay."""
    scenario, contact = run.scenario, run.scenario.contact
    over, snow = contact.snow_map, contact.snow
    hardness = _value(snow.snow_hardness, None if over is None else over.hardness, N_PER_MM3, "N/mm³")
    strength = _value(
        snow.failure_shear_stress, None if over is None else over.failure_shear_stress, N_PER_MM2, "N/mm²"
    )
    ratio = significant(contact.unloading_ratio)
    facts = [
        (Message("Snow"), html(f"H_V {hardness}, S_f {strength}, k_u / H_V {ratio}")),
        (Message("Source of the snow"), snow.source),
        *((Message("{law}, given in Python", law=name.replace("_", " ").capitalize()), law)
          for name, law in run.given_laws.items() if law),
        (Message("Skis"), f"{scenario.ski.name}, {_edge_in_words(run)}"),
        (Message("Computed"), f"skisnow {version('skisnow')}"),
    ]  # fmt: skip
    if has_replay:
        link = Markup('<a href="{}">{}</a>').format(REPLAY, str(Message("the run in three dimensions")))
        facts.append((Message("Replay"), link))
    kind = Message("A simulated run of a skier on two flexible skis")
    if scenario.skier is None:
        kind = Message("A simulated run of a sledge on two flexible skis")
    length, time, outcome = _number(run.run_length), _number(run.simulated_s), outcome_words(run.outcome)
    title = Message("{length} m in {time} s: {outcome}", length=length, time=time, outcome=outcome)
    return Header(kind, title, facts, headline=_headline(run))


def _edge_in_words(run: Run) -> str:
    """Text of the edge angles (°), constant or as a range; "edged by the skier" with a skier."""
    if run.scenario.skier is not None:
        return Message("edged by the skier")
    if run.boots_by is not None:
        angles = edge_angles_of_skis(run) / DEGREE
        low, high = (significant(float(angle), 2) for angle in (np.nanmin(angles), np.nanmax(angles)))
        return Message("edge angles from {low}° to {high}°", low=low, high=high)
    return Message("edge angle {angle}°", angle=significant(run.scenario.sledge.edge_angle / DEGREE))


def _headline(run: Run) -> Markup:
    """Time through the gates; without gates the turn radius, or the speed of a nearly straight run."""
    result = run_gates(run)
    times = [] if result is None else [time for time in result.times if time is not None]
    if result is not None and len(times) > 1:
        return prose(
            "{value} between the first and the last gate that was reached; {passed} of {all} gates passed.",
            value=Markup("<strong>{} s</strong>").format(local_number(f"{times[-1] - times[0]:.2f}")),
            passed=result.passed, all=len(result.times),
        )  # fmt: skip
    shares = (0.05, 0.5, 0.95)
    sentence = template("Turn radius {value} (median; nine tenths of the time from {low} to {high}).")
    quantiles, unit = [run.turn_radius_quantile(share) for share in shares], "m"
    if not all(radius is not None and np.isfinite(radius) for radius in quantiles):
        sentence = template("Speed {value} (median; nine tenths of the time from {low} to {high}).")
        speed, unit = run.speed[np.isfinite(run.speed)], "m/s"
        if not speed.size:
            return Markup("")
        quantiles = np.quantile(speed, shares).tolist()
    low, middle, high = map(significant, quantiles)
    value = Markup("<strong>{} {}</strong>").format(middle, unit)
    return prose(sentence, value=value, low=low, high=f"{high}\u00a0{unit}")


def _value(value: float | None, over_place: Grid | None, size: float, unit: str) -> str:
    """Text of a number in a unit of this size, or of its range if it varies over the place, with the unit."""
    if over_place is None:
        return f"{_number(None if value is None else value / size)} {unit}"
    low, high = (_number(float(end) / size) for end in (over_place.values.min(), over_place.values.max()))
    return Message("{low} to {high} {unit} over the place", low=low, high=high, unit=unit)


def outcome_sentences(run: Run) -> list[Markup]:
    """Sentences with the outcome, its remedy, and the main numbers of the run."""
    deepest, error = float(np.nanmax(run.skis.edge_depth)) / MM, json_number(run.energy_balance_error)
    limits = [*model_limits(run.scenario.ski).values(), *(run_warnings(run) if error is not None else ())]
    sentences = [
        prose("Outcome: {outcome}. {remedy}", outcome=outcome_words(run.outcome), remedy=run.remedy),
        prose(
            "{length} m in {time} s, from {first} to {last} m/s, maximum {most} m/s.",
            length=_number(run.run_length), time=_number(run.simulated_s),
            first=_number(float(run.speed[0])), last=_number(float(run.speed[-1])),
            most=_number(float(np.nanmax(run.speed))),
        ),
        prose(
            "Heading from {first}° to {last}° (positive: left of the fall line); median turn radius {radius} m, 5 % of "
            "the time below {lower} m, without the first half second.",
            first=_angle(float(run.heading[0])), last=_angle(float(run.heading[-1])),
            radius=_number(run.turn_radius_quantile(0.5)), lower=_number(run.turn_radius_quantile(0.05)),
        ),
        prose("Deepest place of an edge in the snow: {deepest} mm.", deepest=_number(deepest)),
        *(prose("Warning: {text}.", text=text) for text in limits),
    ]  # fmt: skip
    if error is not None and not run_warnings(run):
        percent = _number(100.0 * error, 2)
        sentences.append(prose("The energy residual is {error} % of the energy exchanged.", error=percent))
    return sentences


def provenance_sentences(run: Run, summary: Mapping[str, Any]) -> list[Markup]:
    """Sentences about program versions, steps, computing time and files."""
    provenance = summary["provenance"]
    versions = ", ".join(f"{name} {number}" for name, number in provenance.get("versions", {}).items())
    numbers = ", ".join(f"{name} {local_number(f'{value:.6g}')}" for name, value in run.numbers.items())
    rate = run.simulated_s / run.wall_s if run.wall_s > 0.0 else None
    return [
        prose("Programs: {versions}.", versions=versions or f"skisnow {version('skisnow')}"),
        prose(
            "{steps} ({rejected} rejected) in {wall} s: {rate} times real time. {numbers}.",
            steps=counted(run.steps, "{count} step", "{count} steps"), rejected=whole(run.rejected_steps),
            wall=_number(run.wall_s),
            rate=_number(rate), numbers=numbers,
        ),
        prose(
            "Unrounded numbers: {summary}, {track}, and everything over time and along the skis in {file}.",
            summary=Markup("<code>summary.json</code>"), track=Markup("<code>track.csv</code>"),
            file=Markup("<code>run.nc</code>"),
        ),
    ]  # fmt: skip


def _angle(angle: float) -> str:
    """Text of an angle (rad) in degrees with three digits; below a thousandth of a degree it is 0."""
    return _number(angle / DEGREE if abs(angle) >= 0.001 * DEGREE else 0.0)


def _number(value: float | None, digits: int = 3) -> str:
    """A number with a few digits; a dash for None, NaN and infinity."""
    return significant(None if value is None else json_number(value), digits)


SUMMARY, GATES, PAGE = "summary.json", "gates.csv", "report.html"
_STALE: Final = (*picture_files((*FIGURES, *FURTHER)), GATES, REPLAY)


def write_run(
    run: Run,
    folder: str | Path,
    *,
    summary: Mapping[str, Any] | None = None,
    write_more: Callable[[Path], None] | None = None,
    language: str = ENGLISH,
    progress: Progress = silent,
) -> Path:
    """Write all files of a run to a temporary folder and move them into place together.

    folder: output folder, created if necessary. Figures of an earlier run are replaced or removed; other files stay.
    summary: contents of summary.json (default: those of `summary_dict`).
    write_more: function that writes further files of the run into the temporary folder.
    language: language of the page and the figures (en, de).
    progress: callback for progress messages.
    Returns: Path of report.html.
    Raises OutputError: a file cannot be written.
    Raises ParameterError: the language is unknown.
    """
    require_language(language)
    folder = Path(folder)
    for sentence in prepare_folder(folder):
        progress(sentence)
    contents = summary_dict(run, warnings=implausible_values(run.scenario)) if summary is None else summary
    with staged(folder, last=SUMMARY) as stage:
        stage.stale += _STALE
        write_file(stage.path / SUMMARY, f"{json_text(contents)}\n")
        write_track(run, stage.path / "track.csv")
        result = run_gates(run)
        if result is not None:
            write_file(stage.path / GATES, gates_csv(result))
        if write_more is not None:
            write_more(stage.path)
        progress("run.nc")
        write_run_file(run, contents["scenario"], stage.path / "run.nc", provenance=contents["provenance"])
        has_replay = (stage.path / REPLAY).is_file()
        with in_language(language):
            pictures = write_pictures(run_drawings(run), stage.path / "figures", progress=progress)
            progress(PAGE)
            write_file(stage.path / PAGE, run_page(run, contents, pictures, has_replay=has_replay))
    return folder / PAGE
