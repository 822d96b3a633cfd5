"""*Study*: the queue's cards, table and map of the results, files."""

import io
import json
import zipfile
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import pytest

from skisnow.report.formatting import significant
from skisnow.web.pages import study as study_page
from skisnow.web.runs import Job
from skisnow.web.studies import Studies
from skisnow.web.study_fields import CARVE, Range, StudyQuestion

from ..desk import Desk
from .shared import ANGLE, LOAD, TURN

TABLE_LINK = "link[main] Table and figure -> /study/a%20study"
OF_CARVES = {
    "turn_radius_boot_m": "Carved radius (m)",
    "side_force_N": "Side force (N)",
    "side_force_limit_N": "Shear capacity of the snow (N)",
    "total_force_N": "Total force of the snow (N)",
    "contact_length_m": "Contact length (m)",
    "greatest_edge_depth_mm": "Greatest depth of the edge (mm)",
}
OF_RUNS = {
    "run_length_m": "Length of the run (m)",
    "simulated_s": "Simulated time (s)",
    "end_speed_m_per_s": "Speed at the end (m/s)",
    "turn_radius_median_m": "Median turn radius (m)",
    "greatest_edge_depth_mm": "Greatest depth of the edge (mm)",
    "lost_friction_J": "Energy lost to friction (J)",
}


def finished(desk: Desk, what: StudyQuestion, rows: Sequence[Mapping[str, object]], **job: object) -> str:
    """The name of a study that is done, with this table."""
    made = Studies(desk.lab.runs).ask_for(what)
    folder = desk.lab.runs / "studies" / made.name
    results = OF_CARVES if what.of == CARVE else OF_RUNS
    columns = [*what.varied, *results, "outcome", "reason", "study"]
    lines = [",".join(str(row.get(name, "")) for name in columns) for row in rows]
    (folder / "table.csv").write_text("\n".join([",".join(columns), *lines, ""]), encoding="utf-8")
    kept = json.loads((folder / "job.json").read_text(encoding="utf-8")) | {"state": "done"} | job
    (folder / "job.json").write_text(json.dumps(kept), encoding="utf-8")
    return made.name


@pytest.mark.parametrize(
    ("state", "further", "lines"),
    [
        ("waiting", {}, ["button Cancel"]),
        ("running", {}, ["[quiet progress] 3 of 13 points", "button Cancel"]),
        ("cancelled", {}, ["button Go on"]),
        ("failed", {"said": "so"}, ["button Go on"]),
        ("done", {"said": "13 of 13"}, [TABLE_LINK]),
        ("done", {"scenario": "carved-46m"}, [TABLE_LINK]),
    ],
)
def test_a_card_shows_how_its_study_stands(
    desk: Desk, monkeypatch: pytest.MonkeyPatch, state: Any, further: Any, lines: list[str]
) -> None:
    page, studies, pressed = desk.open("/replay"), Studies(desk.lab.runs), list[tuple[str, str]]()
    for name in ("cancel", "go_on"):
        monkeypatch.setattr(studies, name, partial(lambda did, of: pressed.append((did, of)), name))
    told = {"name": "a study", "scenario": CARVE, "changes": {}, "asked_at": "2026", "given": f"{LOAD}: 4 to 5"}
    job = Job(**told | {"state": state} | further)
    before = len(page.outline())

    def shown() -> None:
        with page.content:
            study_page._Card(studies, job, lambda action: action()).show(job)

    studies.progress = "3 of 13 points"
    desk.do(shown, page.client)
    words = [further.get("scenario", "carved turns"), f"{LOAD}: 4 to 5", state, *([job.said] if job.said else [])]
    assert page.outline()[before:] == ["h3 a study", f"[quiet] {' · '.join(words)}", *lines]
    if lines[-1] == "button Cancel":
        page.press("Cancel a study")
        assert pressed == [("cancel", "a study")]
    elif lines[-1] == "button Go on":
        page.press("Go on with a study")
        assert pressed == [("go_on", "a study")]
    else:
        assert page.link("Table and figure") == "/study/a%20study"


def test_a_table_of_turns_over_one_input(desk: Desk) -> None:
    what = StudyQuestion(CARVE, {"edge_angle_deg": Range(10.0, 70.0, 3)}, TURN, named=("ski: carver",))
    rows = [
        {"edge_angle_deg": 70.0, "turn_radius_boot_m": 5.0474, "side_force_N": 2197.98, "outcome": "slips"},
        {"edge_angle_deg": 10.0, "turn_radius_boot_m": 13.0018, "side_force_N": 141.06, "outcome": "equilibrium"},
        {"edge_angle_deg": 40.0, "outcome": "error", "reason": "it is not a ski"},
        {"edge_angle_deg": 50.0, "outcome": "not_converged", "reason": "so"},
    ]
    name = finished(desk, what, rows)
    page = desk.open(f"/study/{name}")
    lines = page.outline()
    begin = lines.index("h2 Table") + 1
    assert lines[begin : begin + 8] == [ANGLE, *OF_CARVES.values(), "Outcome"]
    shown = [lines[at : at + 8] for at in range(begin + 8, len(lines), 8)]
    dashes = ["–"] * 4
    assert [row[:7] for row in shown] == [
        ["70.0", "5.05", "2198", *dashes],
        ["10.0", "13.0", "141", *dashes],
        ["40.0", "–", "–", *dashes],
        ["50.0", "–", "–", *dashes],
    ]
    assert [row[7].partition(":")[0] for row in shown] == ["slips", "equilibrium", "error", "not converged"]
    links = [page.link(text).rpartition("/")[2] for text in ("Download everything", "Download the table")]
    assert links == ["study.zip", "table.csv"]
    chart = page.charts()["Carved radius (m)"]
    assert chart["x"] == ANGLE
    (line,) = chart["lines"]
    assert (line["x"], line["y"]) == ([10.0, 40.0, 50.0, 70.0], [13.002, None, None, 5.047])
    assert (line["style"], line["name"], line["points"]) == (0, "", False)
    assert page.field("Result").options == OF_CARVES
    page.fill("Result", "side_force_N")
    assert list(page.charts()) == ["Side force (N)"]
    assert page.charts()["Side force (N)"]["lines"][0]["y"] == [141.1, None, None, 2198.0]
    assert [each.text for each in page.of() if each.props.get("aria-current") == "page"] == ["Study"]
    place = next(each for each in page.of() if "table" in each.classes)
    assert {key: place.props[key] for key in ("tabindex", "role", "aria-label")} == {
        "tabindex": "0", "role": "region", "aria-label": "Table",
    }  # fmt: skip
    assert [each.props["scope"] for each in page.tagged("th")] == ["col"] * 8
    assert ["n" in each.classes for each in page.tagged("td")] == [*[True] * 7, False] * 4


def test_of_two_inputs_the_one_with_more_values_is_along_the_axis(desk: Desk) -> None:
    """Of five loads the first, the middle and the last are named, over the others."""
    varied = {"load_N": Range(400.0, 800.0, 5), "edge_angle_deg": Range(10.0, 60.0, 6)}
    fixed = {name: value for name, value in TURN.items() if name != "load_N"}
    rows = [
        {"load_N": load, "edge_angle_deg": angle, "turn_radius_boot_m": load / angle, "outcome": "equilibrium"}
        for load in (400.0, 500.0, 600.0, 700.0, 800.123)
        for angle in (60.0, 50.0, 40.0, 30.0, 20.0, 10.0)
    ]
    page = desk.open(f"/study/{finished(desk, StudyQuestion(CARVE, varied, fixed), rows)}")
    lines = page.charts()["Carved radius (m)"]["lines"]
    assert page.charts()["Carved radius (m)"]["x"] == ANGLE
    assert [(line["style"], line["name"]) for line in lines] == [
        (3, ""), (3, ""), (0, f"{LOAD}: 400"), (1, f"{LOAD}: 600"), (2, f"{LOAD}: 800.1"),
    ]  # fmt: skip
    angles = [10.0, 20.0, 30.0, 40.0, 50.0, 60.0]
    for line, load in zip(lines, (500.0, 700.0, 400.0, 600.0, 800.123), strict=True):
        assert line["x"] == angles
        assert line["y"] == pytest.approx([load / angle for angle in angles], abs=0.01)
    assert page.tagged("th")[0].slots["default"].children[0].text == LOAD


@pytest.mark.parametrize("count", [200, 201])
def test_a_long_table_is_shown_in_part(desk: Desk, count: int) -> None:
    rows = [{"edge_angle_deg": 10.0 + n, "outcome": "equilibrium"} for n in range(count)]
    what = StudyQuestion(CARVE, {"edge_angle_deg": Range(10.0, 70.0, 2)}, TURN)
    page = desk.open(f"/study/{finished(desk, what, rows)}")
    assert len(page.tagged("tr")) == 201
    more = ["[note] The first 200 of 201 rows; the file has all of them and all columns."]
    assert [line for line in page.outline() if line.startswith("[note]")] == (more if count == 201 else [])
    assert (page.outline()[-9:-1] if count == 201 else page.outline()[-8:])[0] == significant(209.0)


@pytest.mark.parametrize(
    ("language", "of_map", "n"), [("en", "en", 0), ("de", "de", 0), ("en", "de", 0), ("de", "en", 1)]
)
def test_the_map_stands_above_the_table(desk: Desk, language: str, of_map: str, n: int) -> None:
    what = StudyQuestion(CARVE, {"edge_angle_deg": Range(10.0, 70.0, 2)}, TURN)
    name = finished(desk, what, [{"edge_angle_deg": 10.0, "outcome": "equilibrium"}], language=of_map)
    assert desk.open(f"/study/{name}").tagged("img") == []
    (desk.lab.runs / "studies" / name / "map.svg").write_text("<svg/>", encoding="utf-8")
    page = desk.open(f"/study/{name}", language)
    (image,) = page.tagged("img")
    assert image.props["src"] == f"/study/files/{name}/map.svg"
    if language == "en":
        assert image.props["alt"]
        (figure,) = page.tagged("figure")
        assert dict(figure.props) == {"tabindex": "0", "role": "region", "aria-label": "Map"}
    assert sum("English" in line for line in page.outline()) == n


def test_the_files_of_a_study(desk: Desk) -> None:
    what = StudyQuestion(CARVE, {"edge_angle_deg": Range(10.0, 70.0, 2)}, TURN)
    name = finished(desk, what, [{"edge_angle_deg": 10.0, "outcome": "equilibrium"}])
    folder = desk.lab.runs / "studies" / name
    (folder / "map.svg").write_text("<svg/>", encoding="utf-8")
    for file, kind in {"study.toml": "application/toml", "table.csv": "text/csv", "map.svg": "image/svg+xml"}.items():
        answer = desk.get(f"/study/files/{name}/{file}")
        assert (answer.status_code, answer.content) == (200, (folder / file).read_bytes())
        assert answer.headers["content-type"].partition(";")[0] == kind
        assert "sandbox" in answer.headers["content-security-policy"]
    answer = desk.get(f"/study/files/{name}/study.zip")
    assert "study.zip" in answer.headers["content-disposition"]
    assert answer.headers["content-type"] == "application/zip"
    with zipfile.ZipFile(io.BytesIO(answer.content)) as packed:
        assert {each: packed.read(each) for each in packed.namelist()} == {
            f"study/{file}": (folder / file).read_bytes() for file in ("study.toml", "table.csv", "map.svg")
        }


@pytest.mark.parametrize("file", ["job.json", "study.zip", "map.svg"])
def test_a_file_that_is_not_there_is_reported(desk: Desk, file: str) -> None:
    name = Studies(desk.lab.runs).ask_for(StudyQuestion(CARVE, {"edge_angle_deg": Range(1.0, 7.0, 2)}, TURN)).name
    answer = desk.get(f"/study/files/{name}/{file}")
    assert (answer.status_code, desk.code) == (404, "unknown_file")
    assert desk.fields["file"] == ("table.csv" if file == "study.zip" else file)
