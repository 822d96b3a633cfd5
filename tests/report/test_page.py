"""The report of a campaign: page and written files."""

import json
import math
import re
from collections.abc import Iterable
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pytest
from markupsafe import escape

from skisnow._support.errors import OutputError
from skisnow._support.messages import in_language
from skisnow._support.staging import write_file
from skisnow.campaign import QUALITY_FLAGS, Campaign
from skisnow.campaign.records import TurningReadings
from skisnow.estimation.results import results_json
from skisnow.report import write_report
from skisnow.report.campaign.data import ReportData
from skisnow.report.campaign.key_results import key_results
from skisnow.report.campaign.verdicts import verdicts
from skisnow.report.figures.drawing import FORMS
from skisnow.report.formatting import interval, significant
from tests.coded import raises
from tests.present import present

from ..conftest import only_drawn
from .conftest import Reported, altered, analysis_of, first_series, first_shear, reported

_HOSTILE = "<script>alert('x')</script> & a_b"


class _Reader(HTMLParser):
    """Tags with their attributes, tables as rows of texts, open tags at the end."""

    VOID = frozenset({"meta", "img", "br", "link", "mspace", "hr"})

    def __init__(self, html: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.tables: dict[str, list[list[str]]] = {}
        self.text: list[str] = []
        self._open: list[str] = []
        self._rows: list[list[str]] | None = None
        self._cell: list[str] | None = None
        self.feed(html)
        self.close()
        assert self._open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in self.VOID:
            self._open.append(tag)
        name = str(dict(attrs).get("id") or "")
        if tag == "div" and name.startswith("table-"):
            self._rows = self.tables.setdefault(name.removeprefix("table-"), [])
        if tag == "tr" and self._rows is not None:
            self._rows.append([])
        if tag in ("td", "th"):
            self._cell = []

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        assert self._open.pop() == tag
        if tag in ("td", "th") and self._cell is not None and self._rows:
            self._rows[-1].append(" ".join("".join(self._cell).split()))
            self._cell = None

    def handle_data(self, data: str) -> None:
        self.text.append(data)
        if self._cell is not None:
            self._cell.append(data)


@pytest.fixture(scope="module")
def read(reference: Reported) -> _Reader:
    return _Reader(reference.html)


def _agrees(printed: str, value: float | None, digits: int) -> bool:
    """Whether a printed number is the value rounded to that many significant digits (half a unit of the last)."""
    if value is None:
        return printed == "–"
    if value == 0:
        return printed == "0"
    last = 10.0 ** (math.floor(math.log10(abs(value))) - digits + 1)
    mantissa, _, power = printed.replace("−", "-").partition("×10")
    exponent = power.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
    return abs((float(mantissa) * 10.0 ** int(exponent or 0)) - value) <= 0.5000001 * last


def _estimate(cell: str) -> tuple[str, list[str]]:
    number, _, rest = cell.partition(" [")
    return number, rest.rstrip("]").split(", ") if rest else []


def test_the_nine_rows_are_those_of_the_results(reference: Reported, read: _Reader) -> None:
    head, *rows = read.tables["models"]
    models = reference.results["penetration"]["models"]
    assert len(rows) == len(models) == 9
    for cells, model in zip(rows, models, strict=True):
        row = dict(zip(head, cells, strict=True))
        for header, key in (
            ("RMSE with 1/n N", "rmse_N"),
            ("RMSE with 1/(n − p) N", "rmse_dof_N"),
            ("RMSE without the defining reading N", "rmse_free_N"),
        ):
            assert _agrees(row[header], model[key], 4)
        for name in ("a0", "a1", "b0", "b1"):
            number, ends = _estimate(row[name])
            if model["intervals"][name] is not None:
                assert _agrees(number, model[name], 3)
                assert all(_agrees(end, value, 3) for end, value in zip(ends, model["intervals"][name], strict=True))
            else:
                assert ends == []
        assert (row["sel."] == "✓") == (model["id"] == reference.results["penetration"]["selected"]["id"])


def test_the_paper_s_printed_rmse_stand_beside_the_rows(read: _Reader) -> None:
    """The sequence printed in the paper: 140, 58.4, 53.6; 207, 75.2, 54.8; 53.8; 54.9; 56.1 N."""
    assert [float(row[-1]) for row in read.tables["models"][1:]] == [140, 58.4, 53.6, 207, 75.2, 54.8, 53.8, 54.9, 56.1]


def test_every_experiment_is_listed_with_its_hardness(reference: Reported, read: _Reader) -> None:
    rows = read.tables["penetration_experiments"][1:]
    experiments = reference.results["penetration"]["experiments"]
    assert [row[0] for row in rows] == [experiment["experiment"] for experiment in experiments]
    for row, experiment in zip(rows, experiments, strict=True):
        number, ends = _estimate(row[-1])
        assert _agrees(number, experiment["H_V_N_per_mm3"], 3)
        assert all(map(_agrees, ends, experiment["H_V_interval_N_per_mm3"], (3, 3)))


def test_regressions_are_those_of_the_results(reference: Reported, read: _Reader) -> None:
    rows = read.tables["regressions"][1:]
    for row, found in zip(rows, reference.results["regressions"], strict=True):
        assert row[2:4] == [found["group"], str(found["n"])]
        slope, ends = _estimate(row[5])
        assert _agrees(slope, found["b"][1], 3)
        assert all(map(_agrees, ends, found["interval"][1], (3, 3)))


@pytest.mark.usefixtures("undrawn")
def test_the_headline_of_one_site_is_its_hardness(campaign: Campaign, tmp_path: Path) -> None:
    one = reported(replace(campaign, shear=None, penetration=first_series(campaign, 30)), tmp_path)
    row = next(row for row in one.results["comparisons"] if row["quantity"] == "H_V_N_per_mm3" and row["own"])
    low, high = row["own_interval"]
    (headline,) = re.findall(r'<p class="headline">(.*?)</p>', one.html)
    told = re.findall(r"-?\d+\.\d+|\d+", re.sub(r"<su[bp]>.*?</su[bp]>", "", headline).replace("95 %", ""))
    assert [float(each) for each in told[:3]] == pytest.approx([row["own"], low, high], rel=0.005)


def test_a_report_on_several_sites_begins_with_the_verdicts(reference: Reported) -> None:
    top = reference.html.partition("<dl")[0]
    assert 'class="headline"' not in top
    assert [escape(verdict) for verdict in verdicts(reference.results)] == re.findall("<li>(.*?)</li>", top)


def test_means_by_site_are_means(reference: Reported, read: _Reader) -> None:
    """Geometric for H_V, arithmetic for S_f, computed here from the results."""
    rows = {row[0]: row for row in read.tables["sites"][1:]}
    hardness = [
        e["H_V_N_per_mm3"]
        for e in reference.results["penetration"]["experiments"]
        if e["site"] == "site C" and e["used"]
    ]
    stress = [
        e["S_f_N_per_mm2"] for e in reference.results["shear"]["experiments"] if e["site"] == "site C" and e["used"]
    ]
    assert _agrees(_estimate(rows["site C"][3])[0], math.exp(sum(map(math.log, hardness)) / len(hardness)), 3)
    assert _agrees(_estimate(rows["site C"][7])[0], sum(stress) / len(stress), 3)


def test_nothing_is_fetched_from_anywhere(reference: Reported, read: _Reader) -> None:
    for _, attributes in read.tags:
        for name in ("src", "href", "srcset", "poster", "data", "action", "xlink:href"):
            value = attributes.get(name)
            assert value is None or value.startswith(("#", "data:image/"))
    page = re.sub(r"base64,[A-Za-z0-9+/=]+", "", reference.html)
    for pattern in (r"https?:|@import|url\(", "<script|<link", "<iframe|<object"):
        assert not re.search(pattern, page)


def test_the_page_is_built_of_meaning(read: _Reader) -> None:
    names = [tag for tag, _ in read.tags]
    assert names.count("h1") == names.count("main") == 1
    assert names.count("figure") == names.count("figcaption") == names.count("img") == 11
    assert all(attributes.get("alt") for tag, attributes in read.tags if tag == "img")
    assert all(attributes.get("scope") in ("row", "col") for tag, attributes in read.tags if tag == "th")
    assert names.count("caption") == names.count("table")
    targets = {attributes["href"] for tag, attributes in read.tags if tag == "a"}
    ids = [attributes["id"] for _, attributes in read.tags if "id" in attributes]
    assert targets <= {f"#{name}" for name in ids}
    assert len(ids) == len(set(ids))


def test_synthetic_stands_wherever_the_numbers_do(reference: Reported) -> None:
    html = reference.html
    assert "synthetic" in html.partition("<title>")[2].partition("</title>")[0]
    captions = re.findall(r"<(?:caption|figcaption)>(.*?)</(?:caption|figcaption)>", html, re.DOTALL)
    assert len(captions) > 20
    assert all("Synthetic data." in caption for caption in captions)
    assert all("ynthetic" in alt for alt in re.findall(r'<img alt="(.*?)"', html))
    for path in (reference.folder / "figures").glob("*.svg"):
        assert "synthetic data" in path.read_text(encoding="utf-8")
    for path in (reference.folder / "tables").iterdir():
        assert "synthetic" in path.name
        assert path.suffix == ".csv" or "Synthetic data." in path.read_text(encoding="utf-8")


@pytest.mark.usefixtures("svg_alone")
def test_a_measured_campaign_is_not_called_synthetic(campaign: Campaign, tmp_path: Path) -> None:
    measured = replace(campaign, name="Hintertux", place="glacier", penetration=None, shear=first_shear(campaign, 2))
    found = reported(measured, tmp_path)
    page = re.sub(r"base64,[A-Za-z0-9+/=]+", "", found.html)
    assert "ynthetic" not in page
    assert not [path for path in tmp_path.rglob("*") if "synthetic" in path.name]
    for path in (tmp_path / "figures").glob("*.svg"):
        assert "synthetic" not in path.read_text(encoding="utf-8")


@pytest.mark.usefixtures("undrawn")
def test_names_are_text_and_never_markup(campaign: Campaign, tmp_path: Path) -> None:
    shear = replace(present(campaign.shear), site=tuple(f"{_HOSTILE} {name}" for name in present(campaign.shear).site))
    evil = replace(campaign, name=_HOSTILE, place="{{ 7 * 7 }}", observers=("<b>",), shear=shear, penetration=None)
    found = reported(evil, tmp_path)
    reader = _Reader(found.html)
    assert not [tag for tag, _ in reader.tags if tag == "script"]
    assert _HOSTILE in "".join(reader.text)
    assert "{{ 7 * 7 }}" in "".join(reader.text)
    assert f"{_HOSTILE} site J" in [row[0] for row in reader.tables["sites"]]


@pytest.mark.usefixtures("undrawn")
def test_what_is_not_stated_is_reported(campaign: Campaign, tmp_path: Path) -> None:
    unknown = ("gauge_resolution", "load_uncertainty", "moment_uncertainty", "lever_arm_uncertainty", "density")
    changes: dict[str, Any] = dict.fromkeys(unknown)
    changes |= {"drop_cone": None, "penetration": first_series(campaign, 30), "shear": first_shear(campaign, 30)}
    silent = replace(campaign, **changes)
    text = " ".join(" ".join(_Reader(reported(silent, tmp_path).html).text).split())
    assert "no interval carries" in text
    for name in ("loads", "moments", "lever arms"):
        assert f"{name} is not stated" in text
    assert not list((tmp_path / "figures").glob("fig06_*"))


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize(
    ("case", "figures"),
    [
        pytest.param("only shear", 5, marks=pytest.mark.slow),
        pytest.param("only penetration", 7, marks=pytest.mark.slow),
        ("one of each", 3),
        ("nothing used", 0),
    ],
)
def test_small_campaigns_have_a_report(case: str, figures: int, campaign: Campaign, tmp_path: Path) -> None:
    """A figure for each of its subjects with data; several sites are compared in one more."""
    cases: dict[str, dict[str, Any]] = {
        "only shear": {"penetration": None},
        "only penetration": {"shear": None},
        "one of each": {"penetration": first_series(campaign, 1), "shear": first_shear(campaign, 1), "density": None},
        "nothing used": {
            "penetration": replace(first_series(campaign, 2), cancelled=("crushed", "tilted")),
            "shear": replace(first_shear(campaign, 1), cancelled=("slipped",)),
        },
    }
    found = reported(replace(campaign, **cases[case]), tmp_path)
    reader = _Reader(found.html)
    drawn = sorted(path.stem for path in (tmp_path / "figures").glob("*.svg"))
    assert len(drawn) == figures
    assert ("sites" in drawn) == case.startswith("only")
    assert len([tag for tag, _ in reader.tags if tag == "img"]) == figures
    visible = " ".join(text for text in reader.text)
    assert not re.search(r"\bnan\b|\bNone\b(?! of the)|\binf\b", visible)
    assert ("Figures without data" in visible) == (figures < 11)
    # with one series the nine candidate models give no result: no choice, no table of them
    assert ("No law" in visible) == (case == "one of each")
    assert ("smallest rmse" in visible.lower() or "simplest of the" in visible) == (case == "only penetration")


@pytest.mark.usefixtures("undrawn")
def test_a_mark_says_its_sentence_its_count_and_whom_it_concerns(campaign: Campaign, tmp_path: Path) -> None:
    pressed, sheared = first_series(campaign, 40), first_shear(campaign, 3)
    same_name = ("P1", "P2", pressed.experiment[0])
    cancelled_tests = replace(
        campaign,
        penetration=replace(pressed, cancelled=("crushed", *pressed.cancelled[1:])),
        shear=replace(sheared, cancelled=("", "", "slipped"), experiment=same_name),
    )
    rows = _Reader(reported(cancelled_tests, tmp_path).html).tables["marks"]
    cancelled = next(row for row in rows if row[0] == "cancelled")
    assert cancelled[1] == QUALITY_FLAGS["cancelled"].sentence
    assert cancelled[2:] == ["yes", "1", pressed.experiment[0], "1", pressed.experiment[0]]


@pytest.mark.usefixtures("undrawn")
def test_what_was_not_measured_has_no_section_and_what_was_has(campaign: Campaign, tmp_path: Path) -> None:
    """Two tests turned by 1° up to 80 % of their moment: u_y = 1°/0.8 × 250 mm = 5.45 mm."""
    shear = first_shear(campaign, 2)
    share = np.tile([0.2, 0.4, 0.8, 1.0], 2)
    angle = np.radians(np.tile([0.25, 0.5, 1.0, 1.25], 2))
    turning = TurningReadings(np.array([0, 4, 8]), angle, share * np.repeat(shear.moment, 4))
    plain = reported(replace(campaign, penetration=None, shear=shear), tmp_path / "plain").html
    both = reported(
        replace(campaign, penetration=first_series(campaign, 40), shear=replace(shear, turning=turning)), tmp_path
    ).html
    for title in ("Shear displacement: how", "Unloading: the permanent"):
        assert title not in plain
        assert title in both
    assert _Reader(both).tables["shear_displacement_sites"][1][2].startswith("5.45")


@pytest.mark.usefixtures("undrawn")
def test_long_tables_are_cut_with_a_sentence(campaign: Campaign, tmp_path: Path) -> None:
    tests = present(campaign.penetration)
    names: dict[str, Any] = {
        name: getattr(tests, name) * 2 for name in ("experiment", "site", "tool", "spot", "cancelled")
    }
    columns: dict[str, Any] = {
        name: np.tile(getattr(tests, name), 2)
        for name in ("edge_angle", "snow_density", "drop_cone_depth", "load", "penetration_depth", "row")
    }
    first = np.concatenate((tests.first, tests.first[1:] + tests.first[-1]))
    twice = replace(tests, **names, **columns, first=first, further={}, unloading=None)
    found = reported(replace(campaign, penetration=twice, shear=None), tmp_path)
    reader = _Reader(found.html)
    assert len(reader.tables["penetration_experiments"]) == 301
    assert "first 300 of 472" in "".join(reader.text)
    csv = (tmp_path / "tables" / "penetration_experiments_synthetic.csv").read_bytes()
    assert csv.count(b"\r\n") == 473


def test_the_days_of_the_campaign_are_read_from_its_times(campaign: Campaign) -> None:
    shear = first_shear(campaign, 3)
    times = ("2026-02-03 10:00", "2026-01-31T09:30", "2026-02-31")
    dated = replace(
        campaign, penetration=None, density=None, drop_cone=None, shear=replace(shear, further={"time": times})
    )
    assert str(ReportData(analysis_of(dated)).dates) == "31 Jan 2026 to 3 Feb 2026"
    with in_language("de"):
        assert str(ReportData(analysis_of(dated)).dates) == "31. 1. 2026 bis 3. 2. 2026"
    assert ReportData(analysis_of(replace(dated, shear=shear))).dates is None


def plain(markup: str) -> str:
    return re.sub(r"<[^>]+>", "", str(markup)).replace("\u00a0", " ")


@pytest.fixture(scope="module")
def data(campaign: Campaign) -> ReportData:
    two = replace(campaign, name="real", shear=None, penetration=first_series(campaign, 60))
    return ReportData(analysis_of(two))


def test_the_first_sentence_is_about_the_sites(data: ReportData) -> None:
    hardness = plain(key_results(data)[0])
    for row in data.results["site_means"]:
        assert f"{row['site']} {significant(row['mean'])} N/mm³ (95 % interval {interval(row['interval'])}" in hardness
    assert "fewer than 4" in hardness


def test_one_site_has_an_interval_over_its_experiments(campaign: Campaign) -> None:
    one = replace(campaign, name="real", shear=None, penetration=first_series(campaign, 30))
    analysis = analysis_of(one)
    results = analysis.results
    hardness = plain(key_results(ReportData(analysis))[0])
    own = next(row for row in results["comparisons"] if row["quantity"] == "H_V_N_per_mm3")
    assert f"{significant(own['own'])} N/mm³ (95 % interval {interval(own['own_interval'])}" in hardness
    assert "30 of 30 penetration" in hardness


def test_relations_stand_where_their_p_value_puts_them(reference: Reported) -> None:
    results = reference.results
    rows = [row for row in results["regressions"] if row["p"] is not None][:4]
    judged = [row | {"p": p, "interval_by_site": None} for row, p in zip(rows, (0.011, 0.05, 0.049, 0.6), strict=True)]
    other = altered(reference.analysis, results | {"regressions": judged})
    relations = plain(key_results(ReportData(other))[-1])
    yes, no = relations.split("; not significant: ")
    assert re.findall(r"p = ([0-9.]+)", yes) == ["0.011", "0.049"]
    assert re.findall(r"p = ([0-9.]+)", no.partition(". How large")[0]) == ["0.050", "0.60"]


FIGURES = {
    "fig05_force_depth", "fig06_hardness_density", "fig07_shear_force_depth", "fig08_stress_angle", "fig09_machining",
    "fig10_stress_density", "fig11_stress_hardness", "residuals", "seating",
}  # fmt: skip


def _contents(folder: Path) -> dict[str, bytes]:
    return {
        path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()
    }


def test_every_figure_and_table_is_there(reference: Reported) -> None:
    names = set(_contents(reference.folder))
    assert {f"figures/{name}.{form}" for name in FIGURES for form in FORMS} <= names
    tables = {name.removesuffix(".csv") for name in names if name.startswith("tables/") and name.endswith(".csv")}
    assert {"tables/models_synthetic", "tables/sites_synthetic", "tables/regressions_synthetic"} <= tables


def test_results_json_is_that_of_the_estimates(reference: Reported) -> None:
    text = (reference.folder / "results.json").read_bytes()
    assert text == results_json(reference.results)
    assert json.loads(text) == json.loads(json.dumps(reference.results))


def test_equal_results_give_equal_bytes(campaign: Campaign, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The second time under other settings of the drawing library, which stay as they are."""
    written: list[str] = []
    said: list[str] = []
    small = {"penetration": first_series(campaign, 2), "shear": first_shear(campaign, 2), "drop_cone": None}
    once = reported(replace(campaign, **small), tmp_path / "once")  # type: ignore[arg-type]

    def noting(path: Path, content: str | bytes | Iterable[bytes]) -> None:
        written.append(path.name)
        write_file(path, content)

    monkeypatch.setattr("skisnow.report.campaign.page.write_file", noting)
    others: Any = {"font.size": 31.0, "svg.fonttype": "path", "axes.grid": True}
    with matplotlib.rc_context(others), only_drawn("svg"):
        write_report(once.analysis, tmp_path / "again", progress=said.append)
        assert matplotlib.rcParams["font.size"] == 31.0
        assert matplotlib.rcParams["svg.fonttype"] == "path"
        assert matplotlib.rcParams["axes.grid"]
    again, first = _contents(tmp_path / "again"), _contents(once.folder)
    assert again.keys() == first.keys()
    assert [name for name in first if again[name] != first[name]] == []
    assert written[-2:] == ["report.html", "results.json"]
    assert written.count("results.json") == 1
    assert any("fig05" in each for each in said)
    assert said[-1] == "results.json"


@pytest.mark.usefixtures("undrawn")
def test_other_files_stay_and_those_of_an_earlier_report_go(campaign: Campaign, tmp_path: Path) -> None:
    (tmp_path / "figures").mkdir()
    mine = tmp_path / "figures" / "photo.png"
    mine.write_bytes(b"mine")
    reported(replace(campaign, penetration=None), tmp_path)
    assert list((tmp_path / "figures").glob("fig08_*.svg"))
    assert list((tmp_path / "tables").glob("shear_*"))
    reported(replace(campaign, name="real", shear=None, penetration=first_series(campaign, 2)), tmp_path)
    names = set(_contents(tmp_path))
    assert mine.read_bytes() == b"mine"
    gone = {f"figures/fig08_stress_angle.{form}" for form in FORMS} | {"tables/shear_experiments.csv"}
    assert not gone & names
    assert not [name for name in names if "synthetic" in name]
    assert "tables/models.csv" in names
    assert any(name.startswith("figures/fig05_") for name in names)


def test_a_place_that_cannot_be_written_is_a_clear_error(reference: Reported, tmp_path: Path) -> None:
    taken = tmp_path / "taken"
    taken.write_text("a file, not a folder")
    with raises(OutputError, "cannot_write"):
        write_report(reference.analysis, taken)
    assert taken.read_text() == "a file, not a folder"
