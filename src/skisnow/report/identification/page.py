"""Report of an identification: JSON, tables, figures and page."""

from __future__ import annotations

import csv
import io
import json
import math
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from markupsafe import Markup

from ..._support.language import ENGLISH, require_language
from ..._support.spreadsheet_text import guarded
from ..._support.staging import require_writable, staged, write_file
from ..figures.drawing import Drawing
from ..figures.figure_files import picture_files, write_pictures
from ..formatting import counted, interval, significant
from ..sheet import Header, Section, sheet
from ..symbols import figure_text, html, prose
from ..tables.table import Column, Table
from .figures import profiles_drawn, residuals_along, tracks_above

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from ...identification.result import Identification, Interval
    from ..figures.drawing import Picture

ANSWER: Final = "identification.json"
FIGURES: Final = ("tracks", "residuals_track", "residuals_photo_cells", "residuals_marks", "profiles")
"""Names of an identification's figures, in figures/ as .png and .svg."""
COLUMNS: Final = ("run", "kind", "along", "quantity", "measured", "identified", "sd")


def write_identify_report(
    found: Identification,
    contents: Mapping[str, Any],
    folder: str | Path,
    *,
    language: str = ENGLISH,
    progress: Callable[[str], None] | None = None,
) -> Path:
    """Write identification.json, fits.csv, figures/ and report.html; returns the page's path.

    Parameters
    ----------
    found
        What came out.
    contents
        What `identification_dict` gives.
    folder
        Made where it is missing. Other files in it stay; figures of an earlier identification are replaced or removed.
    language
        Of the page and the figures: en, or a language that there is a catalogue of (de).
    progress
        Called with a line of text now and then.

    Raises
    ------
    OutputError
        A file cannot be written.
    ParameterError
        There are no texts of the language.
    """
    require_language(language)
    folder = Path(folder)
    require_writable(folder)
    report = progress or _silent
    with staged(folder, last=ANSWER) as stage:
        stage.stale += picture_files(FIGURES)
        text = json.dumps(contents, ensure_ascii=False, allow_nan=False, indent=1)
        write_file(stage.path / ANSWER, f"{text}\n")
        write_file(stage.path / "fits.csv", fits_csv(found))
        pictures = write_pictures(
            _drawings(found), stage.path / "figures", every=FIGURES, language=language,
            names=frozenset(map(figure_text, names_in(found))), progress=report,
        )  # fmt: skip
        report("report.html")
        write_file(stage.path / "report.html", identify_page(found, pictures, language=language))
    return folder / "report.html"


def fits_csv(found: Identification) -> str:
    """Every measured number with what the identified parameters give; all digits, nothing where there is no number."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(COLUMNS)
    for fit in found.fits:
        for i, along in enumerate(fit.along):
            for k, label in enumerate(fit.labels):
                numbers = (fit.measured[i, k], fit.fitted[i, k], fit.sd[i, k])
                if math.isfinite(numbers[0]):
                    cells = [repr(float(each)) if math.isfinite(each) else "" for each in numbers]
                    writer.writerow([guarded(fit.name), fit.kind, repr(float(along)), label, *cells])
    return stream.getvalue()


def names_in(found: Identification) -> frozenset[str]:
    """What users wrote, and keys of a scenario's file: the same in every language."""
    parameters = {text for each in found.parameters for text in (each.parameter.name, each.parameter.key)}
    return frozenset(
        {found.scenario, *(fit.name for fit in found.fits), *(name for name, _ in found.data), *parameters}
    )


def identify_page(found: Identification, pictures: list[Picture], *, language: str = ENGLISH) -> str:
    """The HTML of the report."""
    fits = [picture for picture in pictures if picture.name != "profiles"]
    profiles = [picture for picture in pictures if picture.name == "profiles"]
    outcome = found.outcome.replace("_", " ")
    sections = [
        Section(
            "outcome",
            "Outcome",
            key=[prose("Outcome: {outcome}. {reason}", outcome=outcome, reason=found.reason)],
            tables=[parameters_table(found)],
        )
    ]
    if found.warnings:
        sections.append(Section("warnings", "Warnings", words=[prose("{text}.", text=text) for text in found.warnings]))
    if fits:
        sections.append(Section("fit", "Measured and identified", pictures=fits))
    if len(found.parameters) > 1:
        sections.append(Section("correlation", "Correlations", tables=[correlation_table(found)]))
    if profiles:
        sections.append(Section("profiles", "Profiles", pictures=profiles))
    sections.append(Section("provenance", "How it was computed", words=_methods(found)))
    facts = [("Scenario", found.scenario), ("Points", str(found.points)), ("Computed", f"skisnow {version('skisnow')}")]
    header = Header("Parameters identified from measurements", _title(found), facts, headline=_headline(found))
    return sheet(header, sections, language=language, names=names_in(found))


def _headline(found: Identification) -> Markup:
    """The first parameter with its interval."""
    if not found.parameters:
        return Markup("")
    first = found.parameters[0]
    ends = "without an interval"
    if first.interval is not None and None not in first.interval:
        ends = f"95 % interval {interval([float(end) for end in first.interval if end is not None])}"
    value = Markup("<strong>{}</strong>").format(f"{significant(first.value)} {first.parameter.unit}".strip())
    return prose("{name} {value}, {ends}.", name=first.parameter.name, value=value, ends=ends)


def _title(found: Identification) -> str:
    names = ", ".join(each.parameter.name for each in found.parameters)
    return f"{names}: {found.outcome.replace('_', ' ')}"


def _methods(found: Identification) -> list[Markup]:
    effort = found.effort
    runs = counted(effort.simulations, "simulated run")
    last = prose(
        "{runs}, {rounds}, {wall} s.", runs=runs, rounds=counted(effort.rounds, "Jacobian"), wall=f"{effort.wall_s:.1f}"
    )
    data = [prose("{name} was taken for {kind}.", name=name, kind=kind) for name, kind in found.data]
    return [*data, *(prose("{text}.", text=text) for text in found.methods), last]


def _drawings(found: Identification) -> Iterator[Drawing]:
    """One after the other, inside the house style."""
    tracks = [fit for fit in found.fits if fit.kind == "track"]
    if tracks:
        yield Drawing(
            "tracks",
            html("Tracks from above: points measured, lines with the identified parameters."),
            "Measured points and identified tracks from above.",
            tracks_above(tracks),
            wide=True,
        )
    for kind, words in (("track", "along the run"), ("photo_cells", "over the distance"), ("marks", "place by place")):
        fits = [fit for fit in found.fits if fit.kind == kind]
        if fits:
            yield Drawing(
                f"residuals_{kind}",
                prose(
                    "Measured minus identified {words}; the band is ± two standard deviations of the data.", words=words
                ),
                f"Residuals {words}.",
                residuals_along(fits),
                wide=True,
            )
    if found.profiles:
        yield Drawing(
            "profiles",
            html("Rise of the sum of squares, in squared standard deviations, along each parameter."),
            "Profiles of the sum of squares.",
            profiles_drawn(found),
            wide=True,
        )


def _silent(_text: str) -> None:
    return


def parameters_table(found: Identification) -> Table:
    """Values, intervals, bounds, priors."""
    return Table(
        "identified",
        "What was identified, with 95 % intervals; a dash: not asked for, or open.",
        (
            Column("key", "Key", "text"),
            Column("value", "Value", digits=4),
            Column("unit", "Unit", "text"),
            Column("interval", "Interval by curvature", "interval"),
            Column("profile", "By profile", "interval"),
            Column("bootstrap", "By bootstrap", "interval"),
            Column("posterior", "Posterior", "interval"),
            Column("start", "Start"),
            Column("bounds", "Bounds", "range"),
            Column("prior_mean", "Prior mean"),
            Column("prior_sd", "Prior s.d."),
        ),
        [
            (
                each.parameter.key, each.value, each.parameter.unit, _pair(each.interval), _pair(each.profile_interval),
                _pair(each.bootstrap_interval), _pair(each.posterior_interval), each.parameter.start,
                [each.parameter.lower, each.parameter.upper], each.parameter.prior_mean, each.parameter.prior_sd,
            )
            for each in found.parameters
        ],
    )  # fmt: skip


def correlation_table(found: Identification) -> Table:
    """Correlations of the estimates."""
    names = [each.parameter.name for each in found.parameters]
    rows = [
        (names[i], *(float(r) if np.isfinite(r) else None for r in found.correlation[i])) for i in range(len(names))
    ]
    return Table(
        "correlation",
        "Correlations of the estimates. Beyond ±0.9 two parameters are hardly told apart.",
        (Column("parameter", "Parameter", "text"), *(Column(name, name.replace("_", " ")) for name in names)),
        rows,
    )


def _pair(interval: Interval | None) -> list[float] | None:
    if interval is None or interval[0] is None or interval[1] is None:
        return None
    return [interval[0], interval[1]]
