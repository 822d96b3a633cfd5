"""Page with the results of a study: chart, map, table and files."""

from __future__ import annotations

from typing import Any, Final
from urllib.parse import quote

from nicegui import app, run, ui
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import FileResponse, Response

from ..._support.errors import ParameterError
from ..._support.messages import ENGLISH, Message, outcome_words
from ...report.formatting import significant
from ...studies import Study, StudyTable
from ..elements import Words, add_head, choice, error_sentence, heading, link, named, page_frame, plain_page, sentence
from ..scenario_fields import field_label, typed_form
from ..settings import Lab
from ..studies import FIGURE, Studies
from ..study_fields import CARVE, STUDY, TABLE, study_keys
from ..uploads import zip_download, zip_of
from ..widgets import BEHIND, ChartLine, LineChart
from ..words import language_of, number_text, said

HERE: Final = "/study"
FILES: Final = f"{HERE}/files"
ALL: Final = "study.zip"
SKI: Final = "ski"
ROWS: Final = 200  # maximum number of rows on the page; the file has all
OF_CARVES: Final = {
    "turn_radius_boot_m": Message("Carved radius (m)"),
    "side_force_N": Message("Side force (N)"),
    "side_force_limit_N": Message("Shear capacity of the snow (N)"),
    "total_force_N": Message("Total force of the snow (N)"),
    "contact_length_m": Message("Contact length (m)"),
    "greatest_edge_depth_mm": Message("Greatest depth of the edge (mm)"),
}
OF_RUNS: Final = {
    "run_length_m": Message("Length of the run (m)"),
    "simulated_s": Message("Simulated time (s)"),
    "end_speed_m_per_s": Message("Speed at the end (m/s)"),
    "turn_radius_median_m": Message("Median turn radius (m)"),
    "greatest_edge_depth_mm": Message("Greatest depth of the edge (mm)"),
    "lost_friction_J": Message("Energy lost to friction (J)"),
}
TYPES: Final = {STUDY: "application/toml", TABLE: "text/csv", FIGURE: "image/svg+xml"}
NO_SCRIPTS: Final = "default-src 'none'; style-src 'unsafe-inline'; sandbox"


def table_address(name: str) -> str:
    """Address of the page with the results of the study `name`."""
    return f"{HERE}/{quote(name, safe='')}"


def _file_address(name: str, file: str) -> str:
    """Address of a file of a study."""
    return f"{FILES}/{quote(name, safe='')}/{file}"


def add_page(lab: Lab) -> None:
    """Add the page with the results of a study, and the addresses of its files."""
    studies = Studies(lab.runs)

    @ui.page(f"{HERE}/{{name}}")
    async def study_table(name: str) -> None:
        result = await run.io_bound(studies.table, name)
        if result is None:
            raise ParameterError("the lab is about to end").tag("lab_ends")
        with page_frame(Message("Study"), here=HERE):
            job = next((job for job in studies.jobs() if job.name == name), None)
            if job is not None:
                keys = study_keys(job.scenario)
                fixed = (f"{field_label(keys[name])}: {number_text(value)}" for name, value in job.changes.items())
                sentence(job.given, "quiet")
                sentence("; ".join(fixed), "quiet")
            with ui.element("div").classes("acts"):
                link(Message("Download everything"), _file_address(name, ALL), "main")
                link(Message("Download the table"), _file_address(name, TABLE))
            _ResultsView(*result)
            if (studies.folder / name / FIGURE).is_file():
                _show_map(name, job.language if job is not None else ENGLISH)

    @app.get(f"{FILES}/{{name}}/{{file}}")
    async def files(request: Request, name: str, file: str) -> Response:
        try:
            if file != ALL:
                place = studies.file(name, file)
                return FileResponse(place, media_type=TYPES[file], headers={"content-security-policy": NO_SCRIPTS})
            folder = studies.file(name, TABLE).parent
        except ParameterError as error:
            return plain_page(Message("This cannot be shown"), error_sentence(error), 404, request)
        return zip_download(await run_in_threadpool(lambda: zip_of(studies.files_of(folder))), "study.zip")


def _show_map(name: str, language: str) -> None:
    """Show the figure of a study, with a note if its English is not the page's language."""
    with named(ui.element("figure").classes("map").props("tabindex=0 role=region"), Message("Map")):
        ui.element("img").props(f'src="{_file_address(name, FIGURE)}"').props["alt"] = said(
            Message("Turn radius over the inputs that vary, as skisnow study draws it")
        )
    if language_of() != language == ENGLISH:
        sentence(Message("Figures and the report are in English."), "quiet")


class _ResultsView:
    """Rows of a study, and a chart of a chosen result: over one input, with a line for each value of the other."""

    def __init__(self, study: Study, table: StudyTable) -> None:
        self._table = table
        of = getattr(study.subject, "scenario", CARVE)
        self._keys = study_keys(of)
        count = {name: len({row[name] for row in table.rows}) for name in study.varied if name != SKI}
        self._x, *others = sorted(count, key=lambda name: -count[name])
        self._others = [name for name in study.varied if name in (SKI, *others)]
        self._lines = sorted({self._line_of(row) for row in table.rows})
        self._results = dict(OF_CARVES if of == CARVE else OF_RUNS)
        self._shown = choice(Message("Result"), self._results, next(iter(self._results)))
        self._chart = ui.element("div")
        self._shown.on_value_change(self._draw_chart)
        self._draw_chart()
        self._add_table(study)

    def _draw_chart(self) -> None:
        """Draw the chosen result over the first input; three lines have names, the others are pale."""
        result = str(self._shown.value)
        x, y = field_label(self._keys[self._x]), self._results[result]
        self._chart.clear()
        with self._chart:
            chart = LineChart(x, y, Message("Chart of {y} over {x}", y=y, x=x), height=320)
        count = len(self._lines)
        styles = {self._lines[number]: style for style, number in enumerate(dict.fromkeys((0, count // 2, count - 1)))}
        order = [*(line for line in self._lines if line not in styles), *styles]  # lines with names are on top
        chart.show([self._chart_line(line, styles.get(line, BEHIND), result) for line in order])

    def _line_of(self, row: dict[str, Any]) -> tuple[Any, ...]:
        """Values of the inputs that all points of a row's line share."""
        return tuple(row["ski_name" if name == SKI else name] for name in self._others)

    def _input_name(self, name: str) -> str:
        """Label of an input, "Ski" for the ski."""
        return Message("Ski") if name == SKI else field_label(self._keys[name])

    def _chart_line(self, values: tuple[Any, ...], style: int, result: str) -> ChartLine:
        """Line of the points that share values; only lines that are not in the background have a name."""
        rows = [row for row in self._table.rows if self._line_of(row) == values]
        rows.sort(key=lambda row: row[self._x])
        words = []
        for name, value in zip(self._others, values, strict=True):
            text = number_text(f"{value:.4g}") if isinstance(value, float) else typed_form(value)  # as in the map
            words.append(value if name == SKI else f"{said(self._input_name(name))}: {text}")
        x, y = ([row[column] for row in rows] for column in (self._x, result))
        return ChartLine(x, y, style, name="" if style == BEHIND else ", ".join(words))

    def _add_table(self, study: Study) -> None:
        """Add the table of the study, up to a maximum number of rows."""
        heading(Message("Table"))
        columns = {name: self._input_name(name) for name in study.varied} | self._results
        place = named(ui.element("div").classes("table").props("tabindex=0 role=region"), Message("Table"))
        with place, ui.element("table"):
            add_head((*columns.values(), Message("Outcome")))
            with ui.element("tbody"):
                for row in self._table.rows[:ROWS]:
                    _add_row(row, list(columns))
        if len(self._table.rows) > ROWS:
            sentence(
                Message(
                    "The first {rows} of {n_rows} rows; the file has all of them and all columns.",
                    rows=ROWS,
                    n_rows=len(self._table.rows),
                ),
                "note",
            )


def _add_row(row: dict[str, Any], columns: list[str]) -> None:
    """Add a row of the table with its outcome; a missing number is a dash."""
    outcome = outcome_words(str(row["outcome"]))
    if row["outcome"] == "error":
        outcome = Message("error: {reason}", reason=row["reason"])
    with ui.element("tr"):
        for name in columns:
            with ui.element("td").classes("n"):
                Words(row["ski_name"] if name == SKI else "–" if row[name] is None else significant(row[name]))
        with ui.element("td"):
            Words(outcome)
