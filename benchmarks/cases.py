"""``python -m benchmarks cases``: the inputs of ../shared/cases, their right answers, and the results of skisnow."""

from __future__ import annotations

import json
import math
import subprocess
import sys
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import numpy as np

import skisnow
from skisnow._support.errors import SkisnowError
from skisnow._support.units import N_PER_MM2, N_PER_MM3
from skisnow.campaign import read_campaign
from skisnow.campaign.caaml import read_caaml
from skisnow.campaign.smet import read_smet
from skisnow.estimation import analyse
from skisnow.interop.opensim import read_c3d, read_motion
from skisnow.racing import read_line
from skisnow.scenario import Scenario, load_scenario, read_snow_map, read_terrain
from skisnow.scenario.boots import read_boots
from skisnow.scenario.resolution import ContradictionError
from skisnow.simulation.run import LOST, OPEN_SHARE
from skisnow.track.read import read_track
from skisnow.track.summary import track_summary

CASES: Final = Path(__file__).parents[2] / "shared" / "cases"
Checked = tuple[bool, str]


def near(values: Any, right: Any, within: float) -> bool:
    """Whether all values are as near to the right ones."""
    return bool(np.all(np.abs(np.asarray(values) - np.asarray(right)) <= within))


def command(*words: object) -> dict[str, Any]:
    """Run a command; what it prints with --json."""
    line = (sys.executable, "-m", "skisnow", *map(str, words))
    out = subprocess.run(line, capture_output=True, text=True, check=False).stdout
    answer: dict[str, Any] = json.loads(out or "{}") if "--json" in words else {}
    return answer


def same_path(path: Path) -> Checked:
    """A straight track of 100 points at 10 m/s, of which other files are variants."""
    track, right = read_track(path), read_track(CASES / "track" / "joined-lines.nmea")
    gap = float(np.abs(track.place[:, :2] - right.place[: len(track), :2]).max())
    start = str(track.start).startswith("2024-02-10 10:00:00")
    text = f"{len(track)} points from {track.start}, places within {1e3 * gap:.2f} mm, left out {track.left_out}"
    return len(track) == 100 and gap < 1e-3 and start and bool(np.isfinite(track.speed).all()), text


def distance(metres: float, fastest: float) -> Callable[[Path], Checked]:
    """A track of known distance by recorded speeds, and of known highest speed."""

    def check(path: Path) -> Checked:
        summary = track_summary(read_track(path))
        found = summary.distances["recorded speed"]
        fits = near(found, metres, 0.5) and near(summary.max_speed, fastest, 0.03 * fastest)
        return fits, f"{found:.2f} m in {summary.track.time[-1]:.1f} s, at most {summary.max_speed:.3f} m/s"

    return check


def turns(path: Path) -> Checked:
    summary = track_summary(read_track(path))
    steps = np.diff(summary.track.place[:, :2], axis=0)
    assert summary.horizontal_distance is not None
    polyline, length = float(np.hypot(*steps.T).sum()), summary.horizontal_distance.value
    fits = near(summary.max_speed, 12.0, 0.36) and length >= polyline
    return fits, f"at most {summary.max_speed:.2f} m/s, {length:.1f} m, polyline {polyline:.1f} m"


def segments(path: Path) -> Checked:
    runs = [(run.distance, run.last - run.first + 1) for run in track_summary(read_track(path)).day.runs]
    fits = len(runs) == 2 and all(near(length, 1236.0, 4.0) and count == 121 for length, count in runs)
    return fits, ", ".join(f"{length:.1f} m of {count} points" for length, count in runs)


def points(count: int, *, notes: int = 0, flagged: int = 0) -> Callable[[Path], Checked]:
    """A track that is read whole, with notes and flagged rows."""

    def check(path: Path) -> Checked:
        track = read_track(path)
        text = f"{len(track)} points from {track.start}, flagged {track.flagged}, notes: {' '.join(track.notes) or '-'}"
        return (len(track), len(track.notes), sum(track.flagged.values())) == (count, notes, flagged), text

    return check


def fastest(path: Path) -> Checked:
    found = track_summary(read_track(path)).max_speed
    return near(found, 10.0, 0.1), f"at most {found:.3f} m/s"


def slope(path: Path) -> Checked:
    terrain = read_terrain(path)
    steepest = math.degrees(math.atan(math.hypot(*(float(g) for g in terrain.surface.gradients(40.0, 0.0)))))
    mean = float(terrain.height.mean())
    return near(steepest, 12.0, 0.7) and near(mean, 2491.5, 0.1), f"slope {steepest:.2f}°, mean height {mean:.2f} m"


def markers(*names: str) -> Callable[[Path], Checked]:
    """Markers of a C3D file; without names 300 of them."""

    def check(path: Path) -> Checked:
        motion = read_c3d(path)
        fits = motion.names == names if names else len(motion.names) == 300
        return fits, f"{len(motion.names)} markers, left out {', '.join(motion.omitted) or '-'}"

    return check


def radians(path: Path) -> Checked:
    with TemporaryDirectory() as folder:
        written = Path(folder) / "written.mot"
        command("convert", path, written)
        lines = [line for line in written.read_text(encoding="utf-8").splitlines() if "inDegrees" in line]
    return not read_motion(path).in_degrees and "inDegrees=yes" not in lines, f"radians; written: {lines}"


def number(read: Callable[[Path], Any], right: Any, unit: str, within: float = 1e-3) -> Callable[[Path], Checked]:
    """A quantity of a file against its right value."""

    def check(path: Path) -> Checked:
        found = np.asarray(read(path), float)
        return near(found, right, within), f"{np.round(found, 3).tolist()} {unit}"

    return check


def rejected(read: Callable[[Path], Any], *words: str) -> Callable[[Path], Checked]:
    """An error of skisnow whose text has some words."""

    def check(path: Path) -> Checked:
        try:
            return False, f"read: {read(path)!r}"[:100]
        except SkisnowError as error:
            text = str(error).replace(str(path), path.name)
            return all(word in text for word in words), f"rejected: {text}"

    return check


def runnable(stated: dict[str, Any]) -> tuple[Scenario, list[str]]:
    """The scenario without the keys that it rejects because they have no effect, and these."""
    changes, dropped = dict(stated["set"]), list[str]()
    while True:
        try:
            return load_scenario(stated["base"], changes=changes), dropped
        except ContradictionError as error:
            dropped.append(next(key for key in error.keys if key in changes))
            del changes[dropped[-1]]


def energy(path: Path) -> Checked:
    scenario, dropped = runnable(json.loads(path.read_text(encoding="utf-8")))
    run = skisnow.simulate(scenario)
    falls = min(float(np.min(np.diff(run.energies[name]))) for name in LOST if name in run.energies)
    share = math.inf if run.energy_balance_error is None else abs(run.energy_balance_error)
    fits = falls > -1e-6 and (share < OPEN_SHARE or run.outcome == "energy_open")
    text = f"{run.outcome}, {100.0 * share:.4f} % open, largest fall of a loss {max(0.0, -falls):.1e} J"
    return fits, text + (f"; keys without effect, removed: {', '.join(dropped)}" if dropped else "")


def compared(path: Path) -> Checked:
    with TemporaryDirectory() as folder:
        run = Path(folder) / "run"
        command("simulate", "carved-46m", "--set", "run.duration_s=4", "--out", run)
        answer = command("compare", run, path, "--fit-offset", "start,heading", "--json")
    angle, share = answer["fitted"]["fall_line_azimuth_deg"], answer["nearest"]["compared_share"]
    return near(angle, 135.0, 1.0) and share > 0.95, f"{angle:.2f}°, {100.0 * share:.1f} % compared"


def gates(path: Path) -> Checked:
    profile = path.parent / "slope-8-12-8.csv"
    # a carve does not brake: on 12° the skier has to skid
    keys = (
        *(f"course.file={path}", "slope.kind=profile", f"slope.profile={profile}"),
        *("start.speed_m_per_s=6", "skier.brakes_to_m_per_s=6"),
    )
    answer = command("simulate", "slalom-20-gates", *(word for key in keys for word in ("--set", key)), "--json")
    return answer.get("gates_passed") == 10, f"{answer.get('outcome')}, {answer.get('gates_passed')} of 10 gates"


def workbook(path: Path) -> Checked:
    with TemporaryDirectory() as folder:
        campaign = Path(folder) / "campaign"
        command("import", path, "--out", campaign, "--yes")
        analysis = analyse(read_campaign(campaign), n_resamples=100)
    read = analysis.campaign
    assert analysis.penetration is not None and analysis.shear is not None
    assert read.penetration is not None and read.shear is not None
    hardness = dict(
        zip(read.penetration.experiment, analysis.penetration.hardness["H_V"].value / N_PER_MM3, strict=True)
    )
    stress = dict(zip(read.shear.experiment, analysis.shear.stress.value / N_PER_MM2, strict=True))
    found = (hardness["Hang oben 2"], hardness["Hang unten 6"], stress["Hang oben S1"])
    return near(found, (1.424, 0.896, 0.159), 6e-4), "{:.3f}, {:.3f}, {:.3f}".format(*found)


ROWS: Final[tuple[tuple[str, str, Callable[[Path], Checked]], ...]] = (
    ("track/gga-10hz-rmc-1hz.nmea", "299 m at 10 m/s", distance(299.0, 10.0)),
    ("track/gns.nmea", "the same path as with GGA", same_path),
    ("track/no-checksums.nmea", "read", same_path),
    ("track/rawx_first.ubx", "NMEA sentences read", same_path),
    ("track/date-2005-before-fix.nmea", "points with a fix only", same_path),
    ("track/cr-only.nmea", "as with LF", same_path),
    ("track/joined-lines.nmea", "all sentences read", same_path),
    ("track/no-fix-start.nmea", "590 m in 59 s", distance(590.0, 10.0)),
    ("track/turns_T10_1hz.gpx", "12.0 m/s within 3 %, at least the polyline's length", turns),
    ("track/turns_T4_1hz.gpx", "12.0 m/s within 3 %, at least the polyline's length", turns),
    ("track/segments.gpx", "2 × 1236 m, every point retained", segments),
    ("track/segments_short.gpx", "2 × 1236 m, every point retained", segments),
    ("track/trailing_ff.fit", "read, with a note", points(22, notes=1)),
    ("track/excel_serial.csv", "days since 1899-12-30, with a note", points(120, notes=1)),
    ("track/Caps.csv", "read", points(120)),
    ("track/dup25.gpx", "10 m/s", fastest),
    ("track/nan_ind.pos", "read, one row flagged", points(200, flagged=1)),
    ("track/inf_ratio.pos", "read, one row flagged", points(200, flagged=1)),
    *((f"terrain/{name}", "slope 12°, mean height 2491.5 m", slope)
      for name in ("ok.tif", "scaled_dm.tif", "dxdy.asc", "onerow.asc", "wrap.asc")),
    ("terrain/merc.tif", "true lengths, or rejected", rejected(read_terrain, "stretch")),
    ("terrain/deg.asc", "names degrees and a remedy", rejected(read_terrain, "degree", "gdalwarp")),
    ("terrain/hole_nohead.asc", "a hole", rejected(read_terrain, "-9999", "hole")),
    ("terrain/nrows-1e309.asc", "an error", rejected(read_terrain, "nrows")),
    ("terrain/map-huge-value.csv", "an error", rejected(read_snow_map, "1e308")),
    ("motion/many300.c3d", "300 markers", markers()),
    ("motion/angles.c3d", "angles and forces left out", markers("LHEE", "LTOE")),
    ("motion/stofileadapter.sto", "radians; never inDegrees=yes on a guess", radians),
    ("weather/v10_fahrenheit.smet", "0 °C and 10 °C",
     number(lambda path: read_smet(path).fields["TA"] - 273.15, (0.0, 10.0), "°C")),
    ("weather/semicolon_comment.smet", "read", number(lambda path: read_smet(path).fields["ISWR"], (320, 340), "W/m²")),
    ("weather/tz-out-of-range.smet", "an error with line and range", rejected(read_smet, "99999", "row 9")),
    ("pits/elev_ft.caaml", "8200 ft = 2499.36 m", number(lambda path: read_caaml(path).elevation, 2499.36, "m")),
    ("pits/v603_tempF.caaml", "23 °F = -5 °C",
     number(lambda path: read_caaml(path).temperatures[0].temperature_C, -5.0, "°C")),
    ("pits/density_gcm3.caaml", "300 kg/m³",
     number(lambda path: read_caaml(path).densities[0].snow_density, 300.0, "kg/m³")),
    ("pits/encoding-utf-9.caaml", "an error", rejected(read_caaml, "UTF-9")),
    ("boots/boots.csv", "an error", rejected(read_boots, "row 4")),
    ("boots/b.mot", "an error", rejected(read_boots, "row 9")),
    ("ski/table-memory.toml", "an error before memory is taken", rejected(skisnow.read_ski, "/dev/zero")),
    ("course/line-short-row.csv", "an error that names the row",
     rejected(lambda path: read_line(path, skisnow.read_course("slalom-20-gates"), (0.0, 0.0)), "row 3")),
    *((f"energy/scenario-{number}.json", "no loss falls; closed within 0.5 %, or reported", energy)
      for number in (9, 75, 123, 249)),
    ("compare/north.gpx", "135° within 1°, above 95 % compared", compared),
    ("campaign/one-sheet-a-site.xlsx", "H_V 1.424 and 0.896 N/mm³, S_f 0.159 N/mm²", workbook),
    ("course/gates-semicolon.csv", "all ten gates passed", gates),
)  # fmt: skip


def results() -> Iterator[tuple[str, str, str, bool]]:
    """Input, expectation, result, and whether it fits."""
    for name, expected, check in ROWS:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                fits, text = check(CASES / name)
            except Exception as error:  # a traceback is a result, too
                fits, text = False, f"{'' if isinstance(error, SkisnowError) else 'TRACEBACK '}{error}"
        yield name, expected, text, fits


def print_table() -> None:
    """Print a table in Markdown; nothing without the folder."""
    if not CASES.is_dir():
        print(f"skipped: {CASES} is absent")
        return
    print("| input | right answer | result | |\n| --- | --- | --- | --- |")
    for name, expected, text, fits in results():
        print(f"| `{name}` | {expected} | {text.replace('|', '/')} | {'ok' if fits else '**not**'} |", flush=True)
