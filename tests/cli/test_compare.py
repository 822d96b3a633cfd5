"""`skisnow compare` as a user meets it, on tracks whose distances are known by hand."""

import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skisnow.cli import main
from skisnow.cli.shell import json_schema

from .json_answer import json_answer

SCHEMA = json_schema("compare")
NUMBERS = {"max_m", "mean_m", "rms_m", "max_share", "mean_share", "rms_share"}
NORTH = ("--fall-line-azimuth-deg", "0")
Printed = pytest.CaptureFixture[str]


@pytest.fixture(autouse=True)
def fewer_places(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sums over an eighth of the places, in a fifth of the time."""
    monkeypatch.setattr("skisnow.comparison.alignment.PLACES", 256)


def answer(words: list[str], printed: Printed) -> Any:
    found = json_answer(["compare", *words], SCHEMA, printed)
    assert all(set(found[kind]) >= NUMBERS for kind in ("nearest", "arc_length", "time"))
    return found


def write(path: Path, place: Any, *, first_time: float = 0.0, speed: float = 5.0) -> Path:
    """Places (n, 2 or 3), passed at one speed."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(place, axis=0), axis=1))])
    rows = np.column_stack([first_time + along / speed, place])
    header = ",".join(["time_s", "x_m", "y_m", "z_m"][: rows.shape[1]])
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join([header, *(",".join(map(repr, row)) for row in rows.tolist())]) + "\n", encoding="utf-8")
    return path


@pytest.fixture
def straight(tmp_path: Path) -> Path:
    return write(tmp_path / "straight.csv", np.column_stack([np.linspace(0.0, 40.0, 81), np.zeros((81, 2))]))


def test_numbers_shares_and_places(straight: Path, capsys: Printed) -> None:
    """A line turned by 0.01 rad: 40 m · sin at the end; the share is of the measured 40 m."""
    line = 40.0 * np.linspace(0.0, 1.0, 7)[:, None] * [math.cos(0.01), math.sin(0.01), 0.0]
    found = answer([str(write(straight.parent / "a" / "track.csv", line).parent), str(straight)], capsys)
    nearest = found["nearest"]
    assert nearest["max_m"] == pytest.approx(40.0 * math.sin(0.01), rel=1e-9)
    assert nearest["max_share"] == pytest.approx(math.sin(0.01), rel=1e-9)
    assert nearest["mean_share"] == pytest.approx(math.sin(0.01) / 2.0, rel=1e-9)
    assert nearest["rms_share"] == pytest.approx(math.sin(0.01) / math.sqrt(3.0), rel=1e-9)
    assert nearest["max_at_m"] == pytest.approx(40.0)
    assert (found["dimensions"], found["fitted"]) == (3, None)
    assert found["measured"] == {"name": str(straight), "length_m": pytest.approx(40.0)}


def test_every_number_has_its_definition_beside_it(straight: Path, capsys: Printed) -> None:
    shifted = write(straight.parent / "late.csv", [[0.0, 0.25, 0.0], [40.0, 0.25, 0.0]], first_time=0.2)
    assert main(["compare", str(shifted), str(straight)]) == 0
    told = capsys.readouterr().out
    for words in (
        "nearest place: from each place of the measured track",
        "equal arc length: between the places that both tracks reach after the same arc length",
        "equal time: between the places where both are at the same time, counted from zero of the seconds",
        "integrals over the measured track's length",
        "largest 0.250 m, 0.62 % of the measured track's length",
        "largest 1.03 m",  # √(1² + 0.25²): 0.2 s at 5 m/s
    ):
        assert words in told
    assert "Fitted" not in told


def test_what_cannot_be_compared_is_null_with_a_reason(straight: Path, capsys: Printed) -> None:
    other = write(straight.parent / "other.csv", [[0.0, 0.25, 0.0], [40.0, 0.25, 0.0]], first_time=500.0)
    found = answer([str(straight), str(other)], capsys)
    assert all(found["time"][key] is None for key in NUMBERS)
    assert "begins 500 s later" in found["time"]["reason"]
    by_first_point = answer([str(straight), str(other), "--time-from", "first-point"], capsys)
    assert by_first_point["time"]["max_m"] == pytest.approx(0.25)


def test_a_fit_is_reported_with_what_was_before(straight: Path, capsys: Printed) -> None:
    along = np.linspace(0.0, 40.0, 200)
    place = np.column_stack([along, 3.0 * np.sin(along / 5.0), 0.1 * along])
    one = write(straight.parent / "one.csv", place)
    two = write(straight.parent / "two.csv", place + np.array([1.0, -0.5, 0.25]), first_time=3.0)
    found = answer([str(one), str(two), "--fit-offset", "start,time"], capsys)
    fitted = found["fitted"]
    assert fitted["what"] == ["start", "time"]
    moved = [fitted[f"moved_{axis}_m"] for axis in "xyz"]
    assert moved == pytest.approx([1.0, -0.5, 0.25], abs=1e-6)
    assert (fitted["turned_deg"], fitted["later_s"]) == pytest.approx((0.0, -3.0), abs=1e-6)
    assert found["time"]["max_m"] < 1e-5
    assert fitted["before"]["arc_length"]["max_m"] == pytest.approx(math.sqrt(1.0 + 0.25 + 0.0625))
    assert main(["compare", str(one), str(two), "--fit-offset", "start"]) == 0
    told = capsys.readouterr().out
    assert "Fitted: start." in told
    assert "start by x 1.00 m, y -0.500 m, z 0.250 m" in told
    assert "before" in told


@pytest.mark.usefixtures("undrawn")
def test_out_writes_the_json_and_the_figure(straight: Path, tmp_path: Path, capsys: Printed) -> None:
    folder = tmp_path / "new" / "folder"
    other = straight.rename(straight.with_name("Straße.csv"))
    found = answer([str(other), str(other), "--out", str(folder)], capsys)
    text = (folder / "compare.json").read_text(encoding="utf-8")
    assert json.loads(text) == found
    assert text.startswith('{\n "')  # lines indented by one, as in every file of ours
    assert "Straße.csv" in text
    assert {path.suffix for path in folder.glob("track_comparison.*")} == {".png", ".svg", ".pdf", ".csv"}


@pytest.mark.usefixtures("undrawn")
def test_two_runs_through_one_course_are_compared_gate_by_gate(straight: Path, tmp_path: Path, capsys: Printed) -> None:
    folders = []
    for name, time in (("mine", 2.25), ("theirs", 2.0)):
        folders.append(tmp_path / name)
        folders[-1].mkdir()
        (folders[-1] / "track.csv").write_text(straight.read_text(encoding="utf-8"), encoding="utf-8")
        rows = f"gate,outcome,time_s,x_m,y_m\n1,passed,1.0,10,0\n2,passed,{time},20,1\n"
        (folders[-1] / "gates.csv").write_text(rows, encoding="utf-8")
    out = tmp_path / "out"
    found = answer([str(each) for each in folders] + ["--out", str(out)], capsys)
    assert [(row["gate"], row["gap_s"], row["lost_s"]) for row in found["gates"]] == [
        ("1", 0.0, 0.0),
        ("2", 0.25, 0.25),
    ]
    assert (out / "gate_gaps.csv").read_text(encoding="utf-8").splitlines()[2] == "2,passed,2.25,passed,2.0,0.25,0.25"
    assert "0.25 s behind" in (out / "report.html").read_text(encoding="utf-8")
    assert (out / "gate_gaps.pdf").is_file()
    assert main(["compare", *map(str, folders)]) == 0
    assert "crosses gate 2 0.25 s behind" in capsys.readouterr().out
    (folders[0] / "gates.csv").unlink()
    assert "gates" not in answer([str(each) for each in folders] + ["--out", str(out)], capsys)
    assert not list(out.glob("gate_gaps*"))
    assert "0.25 s behind" not in (out / "report.html").read_text(encoding="utf-8")


def test_a_gpx_beside_a_run_names_missing_columns_and_has_no_unmeasured_digits(tmp_path: Path, capsys: Printed) -> None:
    """A watch's places are known to metres: 12.3 m to the side is 12 m, 0.02 m is below a metre."""
    north = np.linspace(47.0, 47.0004, 21)  # 44.5 m
    rows = "".join(
        f'<trkpt lat="{lat!r}" lon="11.0"><time>2026-01-01T10:00:{t:02}Z</time></trkpt>'
        for t, lat in enumerate(north.tolist())
    )
    head = '<gpx xmlns="http://www.topografix.com/GPX/1/1" version="1.1" creator="x"><trk><trkseg>'
    gpx = f"{head}{rows}</trkseg></trk></gpx>"
    (tmp_path / "watch.gpx").write_text(gpx, encoding="utf-8")
    along = np.linspace(0.0, 44.5, 50)
    run = write(tmp_path / "run.csv", np.column_stack([along, np.full(50, 12.34)]))
    words = ["compare", str(run), str(tmp_path / "watch.gpx")]
    assert main(words) == 0
    told = capsys.readouterr()
    for option in ("--fall-line-azimuth-deg", "--slope-angle-deg", "--fit-offset"):
        assert option in told.out
    assert "largest" not in told.out
    assert told.err
    assert main([*words, *NORTH]) == 0
    told = capsys.readouterr()
    assert re.search(r"largest 12 m, 28 %", told.out)
    assert main([*words, *NORTH, "--known-to-m", "0.1"]) == 0
    assert "largest 12.3 m, 28 %" in capsys.readouterr().out
    assert main([*words, "--fit-offset", "start,heading"]) == 0
    assert " below 1 m, " in capsys.readouterr().out
    found = answer([*words[1:], "--fall-line-azimuth-deg", "0"], capsys)
    assert (found["in_one_frame"], found["known_to_m"]) == (True, 3.0)
    assert found["nearest"]["max_m"] == pytest.approx(12.34, abs=1e-3)


def written_map_track(path: Path, azimuth: float, slope: float, along: Any, aside: Any, *, heights: bool) -> Path:
    """A track on a slope (degrees) that falls towards an azimuth, in latitude and longitude near 47° N, 11° E."""
    down, to_left = (math.radians(azimuth + turn) for turn in (0.0, -90.0))
    ahead = along * math.cos(math.radians(slope))
    north = ahead * math.cos(down) + aside * math.cos(to_left)
    east = ahead * math.sin(down) + aside * math.sin(to_left)
    columns = [np.arange(len(along)) / 10.0, 47.0 + north / 111_177.0, 11.0 + east / 76_057.0]  # m in a degree there
    names = "time,lat,lon"
    if heights:
        columns.append(2000.0 - along * math.sin(math.radians(slope)))
        names += ",alt_m"
    rows = [",".join(map(repr, row)) for row in np.column_stack(columns).tolist()]
    path.write_text("\n".join([names, *rows]), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("azimuth", "slope", "side", "known"),
    [(130.0, 30.0, -1.0, "option"), (250.0, 18.0, 1.0, "run"), (80.0, 30.0, 1.0, "heights")],
)
def test_a_run_on_a_slope_is_laid_on_the_map_before_it_is_fitted(
    azimuth: float, slope: float, side: float, known: str, tmp_path: Path, capsys: Printed
) -> None:
    """A third of the run is not measured. Without the slope, lengths down it are up to 15 % too long for the map."""
    along = np.linspace(0.0, 60.0, 151)
    aside = side * (5.0 * np.sin(along / 6.0) + 3.0 * np.cos(along / 11.0))
    file = write(tmp_path / "run" / "track.csv", np.column_stack([along, aside, 0.0 * along]))
    there = written_map_track(
        tmp_path / "there.csv", azimuth, slope, along[50:], aside[50:], heights=known == "heights"
    )
    if known == "run":
        scenario = {"slope": {"kind": "plane", "angle_deg": slope}}
        file.with_name("summary.json").write_text(json.dumps({"scenario": scenario}), encoding="utf-8")
    words = [str(file.parent), str(there), "--fit-offset", "start,heading"]
    found = answer([*words, *(["--slope-angle-deg", str(slope)] if known == "option" else [])], capsys)
    fitted = found["fitted"]
    azimuth_found = fitted["fall_line_azimuth_deg"]
    assert azimuth_found == pytest.approx(azimuth, abs=0.2)  # metres of a degree are rounded
    assert math.remainder(fitted["turned_deg"] + azimuth - 90.0, 360.0) == pytest.approx(0.0, abs=0.2)
    assert fitted["slope_angle_deg"] == pytest.approx(slope, abs=0.2)
    assert found["dimensions"] == (3 if known == "heights" else 2)
    assert found["nearest"]["max_m"] < 0.05
    assert found["nearest"]["compared_share"] > 0.99
    [told] = [each for each in found["warnings"] if "from north" in each]
    assert f"{azimuth_found:.1f}°" in told


def test_warning_of_an_unknown_slope_and_of_one_that_heights_contradict(tmp_path: Path, capsys: Printed) -> None:
    along = np.linspace(0.0, 60.0, 151)
    aside = 5.0 * np.sin(along / 6.0) + 3.0 * np.cos(along / 11.0)
    run = write(tmp_path / "run.csv", np.column_stack([along, aside, 0.0 * along]))
    flat = written_map_track(tmp_path / "flat.csv", 20.0, 18.0, along, aside, heights=False)
    words = ["--fit-offset", "start,heading"]
    found = answer([str(run), str(flat), *words], capsys)
    assert found["fitted"]["slope_angle_deg"] is None
    assert any("unknown" in each for each in found["warnings"])
    high = written_map_track(tmp_path / "high.csv", 20.0, 18.0, along, aside, heights=True)
    found = answer([str(run), str(high), *words, "--slope-angle-deg", "8"], capsys)
    assert any("18.0°" in each and "8.0°" in each for each in found["warnings"])


def test_the_slope_of_a_run_counts_with_a_known_azimuth(tmp_path: Path, capsys: Printed) -> None:
    along = np.linspace(0.0, 60.0, 151)
    aside = 5.0 * np.sin(along / 6.0)
    file = write(tmp_path / "run" / "track.csv", np.column_stack([along, aside, 0.0 * along]))
    there = written_map_track(tmp_path / "there.csv", 140.0, 25.0, along, aside, heights=True)
    scenario = {"slope": {"kind": "plane", "angle_deg": 25.0}}
    file.with_name("summary.json").write_text(json.dumps({"scenario": scenario}), encoding="utf-8")
    found = answer([str(file.parent), str(there), "--fall-line-azimuth-deg", "140"], capsys)
    assert found["nearest"]["max_m"] < 0.05
    assert found["measured"]["length_m"] == pytest.approx(found["simulated"]["length_m"], rel=1e-3)


CASE = Path(__file__).parents[3] / "shared" / "cases" / "compare" / "north.gpx"


@pytest.mark.slow
@pytest.mark.usefixtures("undrawn")
@pytest.mark.skipif(not CASE.is_file(), reason="no ../shared")
def test_the_shared_track_of_a_carved_turn_is_found(tmp_path: Path, capsys: Printed) -> None:
    run = tmp_path / "run"
    assert main(["simulate", "carved-46m", "--set", "run.duration_s=4", "--out", str(run)]) == 0
    capsys.readouterr()
    found = answer([str(run), str(CASE), "--fit-offset", "start,heading"], capsys)
    azimuth = found["fitted"]["fall_line_azimuth_deg"]
    assert azimuth == pytest.approx(135.0, abs=1.0)
    assert found["nearest"]["compared_share"] > 0.95


def test_two_tracks_in_degrees_are_put_on_one_plane(tmp_path: Path, capsys: Printed) -> None:
    """Each alone has its own first point as origin; 0.001 degrees of longitude at 47 degrees north are 76.1 m apart."""
    north = np.linspace(47.0, 47.001, 21)
    for name, lon, first in (("west", 11.0, 0), ("east", 11.001, 5)):
        rows = [f"{t},{lat!r},{lon}" for t, lat in enumerate(north[first:].tolist())]
        (tmp_path / f"{name}.csv").write_text("\n".join(["time,lat,lon", *rows]), encoding="utf-8")
    found = answer([str(tmp_path / "west.csv"), str(tmp_path / "east.csv")], capsys)
    curvature = 6378137.0 / math.sqrt(
        1.0 - 0.00669437999 * math.sin(math.radians(47.0005)) ** 2
    )  # of the prime vertical
    apart = math.radians(0.001) * curvature * math.cos(math.radians(47.0005))
    # the parallels draw together by 2 parts in 100 000 over the 0.001 degrees
    assert found["nearest"]["mean_m"] == pytest.approx(apart, rel=3e-5)
    assert found["nearest"]["compared_share"] == pytest.approx(1.0, abs=0.01)
    assert found["warnings"] == []


def test_another_country_and_a_missing_file(straight: Path, capsys: Printed) -> None:
    assert main(["compare", str(straight), str(straight), "--fit-offset", "scale"]) == 1
    assert "'scale'" in capsys.readouterr().err
    far = write(straight.parent / "far.csv", [[0.0, 5000.0, 0.0], [40.0, 5000.0, 0.0]])
    assert main(["compare", str(far), str(straight)]) == 1
    assert " 5 km" in capsys.readouterr().err
    assert main(["compare", str(straight), str(straight.parent / "none.csv")]) == 1
    assert "none.csv" in capsys.readouterr().err
