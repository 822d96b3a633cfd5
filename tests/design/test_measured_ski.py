"""Skis of what a maker has: any layout gives the same ski, tests give the stiffness back, errors name the way out."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl
import pytest

from skisnow._support.errors import ParameterError
from skisnow._support.units import DEGREE, MM
from skisnow.cli import main
from skisnow.design import Mapped, Measured, measured_ski
from skisnow.design.measured_ski import stiffness_of_tests
from skisnow.ski import read_ski, ski_named

from ..coded import raises

LENGTH, BOOT = 1705.0, 800.0
WIDTHS = [
    (1705.0, 30.0), (1580.0, 119.5), (1400.0, 104.0), (1200.0, 84.0), (1000.0, 73.5), (840.0, 70.8), (600.0, 74.0),
    (400.0, 83.0), (200.0, 96.5), (50.0, 105.0), (0.0, 104.0),
]  # fmt: skip
"""Distance from the tail and width (mm)."""
BEND = [(1400.0, 210.0), (1100.0, 340.0), (800.0, 450.0), (500.0, 330.0), (250.0, 160.0)]
"""Distance from the tail (mm) and EI (N m²)."""


def lay(path: Path, rows: Sequence[Sequence[object]], separator: str = ",") -> Path:
    if path.suffix == ".xlsx":
        book = openpyxl.Workbook()
        (sheet,) = book.worksheets
        for row in rows:
            sheet.append(list(row))
        book.save(path)
    else:
        path.write_text("\n".join(separator.join(map(str, row)) for row in rows), encoding="utf-8")
    return path


def comma(value: float) -> str:
    return f"{value:g}".replace(".", ",")


def measured(*paths: Path, **given: Any) -> Measured:
    how = {"name": "mine", "stations_from": "tail", "boot": BOOT * MM, "running_length": 1.5, "mass": 1.9}
    return Measured(tables=paths, **(how | given))  # type: ignore[arg-type]


def one_file(tmp_path: Path) -> Measured:
    rows: list[Sequence[object]] = [
        ["station_mm", "width_mm", "EI_N_m2"],
        *([x, w, dict(BEND).get(x, "")] for x, w in WIDTHS),
    ]
    rows += [[x, "", EI] for x, EI in BEND if x not in dict(WIDTHS)]
    return measured(lay(tmp_path / "one.csv", rows))


def two_files_from_the_tip(tmp_path: Path) -> Measured:
    widths: list[Sequence[object]] = [
        ["Ski 17"],
        ["Abstand (cm)", "Breite [mm]"],
        *([comma((LENGTH - x) / 10), comma(w)] for x, w in WIDTHS),
    ]
    flex: list[Sequence[object]] = [["x (m)", "EI (kN m²)"], *([(LENGTH - x) / 1e3, EI / 1e3] for x, EI in BEND)]
    paths = lay(tmp_path / "w.csv", widths, ";"), lay(tmp_path / "flex.csv", flex)
    return measured(*paths, stations_from="tip")


def workbook_from_the_boot(tmp_path: Path) -> Measured:
    rows: list[Sequence[object]] = [["Ort", "W"], ["mm", "cm"], *([x - BOOT, w / 10] for x, w in reversed(WIDTHS))]
    flex: list[Sequence[object]] = [
        ["position [mm]", "EI (N mm²)"],
        *([x - BOOT, EI * 1e6] for x, EI in reversed(BEND)),
    ]
    mapped = Mapped({"Ort": "station_mm", "w": "width_mm"})
    paths = lay(tmp_path / "w.xlsx", rows), lay(tmp_path / "flex.csv", flex)
    return measured(*paths, stations_from="boot", boot=None, mapped=mapped)


@pytest.mark.parametrize("layout", [two_files_from_the_tip, workbook_from_the_boot])
def test_every_layout_of_the_tables_gives_the_same_ski(tmp_path: Path, layout: Any) -> None:
    ski, expected = (measured_ski(make(tmp_path)).ski for make in (layout, one_file))
    for name in ("station", "width", "base_height", "bending_stiffness", "torsional_stiffness", "mass_per_length"):
        np.testing.assert_allclose(getattr(ski, name), getattr(expected, name), rtol=1e-9, atol=1e-12)
    assert ski.length == pytest.approx(LENGTH * MM)
    assert ski.station[-1] == pytest.approx(-BOOT * MM)
    assert ski.sidecut_length == pytest.approx(1.53)
    assert ski.mass == pytest.approx(1.9)
    for x, value in BEND:
        assert np.interp((x - BOOT) * MM, ski.station[::-1], ski.bending_stiffness[::-1]) == pytest.approx(value)
    for x, value in WIDTHS:
        assert np.interp((x - BOOT) * MM, ski.station[::-1], ski.width[::-1]) == pytest.approx(value * MM)


def bent(EI: Any, place: float, span: float, load: float = 100.0) -> float:
    """Deflection (m) in the middle of a span by the conjugate beam, from double integration of M/EI."""
    x = np.linspace(-span / 2, span / 2, 4001)
    curvature = load * (span / 2 - abs(x)) / 2 / EI(place + x)
    slope = np.concatenate(([0.0], np.cumsum((curvature[1:] + curvature[:-1]) / 2 * np.diff(x))))
    deflection = np.concatenate(([0.0], np.cumsum((slope[1:] + slope[:-1]) / 2 * np.diff(x))))
    chord = deflection[-1] * (x + span / 2) / span
    return float((chord - deflection)[2000])


def test_bend_tests_give_a_changing_stiffness_back() -> None:
    """A compliance that is linear between the tests exactly; EI = F L³/(48 w) alone is up to 11 % off here."""
    station = np.array([0.5, 0.3, 0.1, -0.1, -0.3, -0.5])
    EI = np.array([120.0, 260.0, 440.0, 450.0, 280.0, 110.0])

    def stiffness(x: Any) -> Any:
        return 1.0 / np.interp(x, station[::-1], 1.0 / EI[::-1])

    span = np.full(6, 0.3)
    compliance = np.array([bent(stiffness, place, 0.3) / 100.0 for place in station])
    found = stiffness_of_tests(station, span, compliance, 1e-7 * np.ones(6), bend=True)
    np.testing.assert_allclose(found.value, EI, rtol=1e-4)
    alone = span**3 / 48 / compliance
    assert 0.05 < np.max(abs(alone / EI - 1)) < 0.15


def test_errors_are_those_of_repeated_tests() -> None:
    station, span, true = np.array([0.4, 0.0, -0.4]), np.full(3, 0.4), np.array([2.7e-6, 1.3e-6, 2.9e-6])
    rng, step = np.random.default_rng(3), 2e-8
    values = [
        stiffness_of_tests(station, span, true + step * rng.standard_normal(3), np.full(3, step), bend=True).value
        for _ in range(400)
    ]
    stated = stiffness_of_tests(station, span, true, np.full(3, step), bend=True).error
    np.testing.assert_allclose(np.std(values, axis=0), stated, rtol=0.15)


def test_a_torsion_test_of_one_place_is_moment_times_length_over_twist() -> None:
    found = stiffness_of_tests(np.array([0.1]), np.array([0.5]), np.array([2e-3]), np.array([1e-5]), bend=False)
    assert found.value == pytest.approx([0.5 / 2e-3])
    assert found.error == pytest.approx([0.5 / 2e-3 * 1e-5 / 2e-3])


def test_three_widths_and_a_radius_are_enough() -> None:
    given = Measured(name="plain", widths=(0.120, 0.072, 0.105), length=1.7, radius=15.0)
    made = measured_ski(given)
    assert made.ski.sidecut_radius_of_three_widths == pytest.approx(15.0, rel=1e-3)
    carver = ski_named("carver")
    assert made.ski.bending_stiffness.max() == pytest.approx(carver.bending_stiffness.max(), rel=1e-3)
    per_area = [ski.mass / -np.trapezoid(ski.width, ski.station) for ski in (made.ski, carver)]
    assert per_area[0] == pytest.approx(per_area[1])
    assert {message.fields["ski"] for message in made.assumed if "ski" in message.fields} == {"carver"}
    assert {"EI", "GJ"} <= {message.fields.get("quantity") for message in made.assumed}


def test_the_command_writes_a_ski_that_is_read_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows: list[Sequence[object]] = [["station_mm", "width_mm"], *WIDTHS]
    load = 98.0665  # 10 kg
    tests: list[Sequence[object]] = [["station_mm", "span (mm)", "load (kg)", "deflection (mm)"]]
    tests += [[x, 400, 10, f"{load * 0.4**3 / 48 / 300.0 / MM:.6f}"] for x, _ in BEND]
    paths = lay(tmp_path / "w.csv", rows), lay(tmp_path / "t.csv", tests)
    options = [word for path in paths for word in ("--table", str(path))]
    done = main(["new", "ski", str(tmp_path / "mine.toml"), *options, "--stations-from", "tail", "--boot-mm", "800"])
    assert done == 0
    ski = read_ski(tmp_path / "mine.toml")
    np.testing.assert_allclose(ski.bending_stiffness, 300.0, rtol=1e-4)
    assert ski.name == "mine"
    assert "300" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("rows", "given", "error"),
    [
        ([["position", "width_mm"], [0, 100], [1, 90]], {}, ("no_unit", {"heading": "position"})),
        ([["station_mm", "width_mm"], [0, "wide"], [1, 90]], {}, ("not_a_number", {"cell": "wide", "row": 2})),
        ([["station_mm", "EI_N_m2"], [0, "1e300"], [1, 90]], {}, ("not_a_number", {"cell": "1e300", "row": 2})),
        ([["a", "b"], [0, 1]], {}, ("missing", {})),
        ([["station_mm", "width_mm"]], {}, ("missing", {})),
        ([["station_mm", "width_mm"], [0, ""]], {}, ("missing", {})),
        ([["station_mm", "width_mm"], *WIDTHS], {"stations_from": None}, ("missing", {})),
        ([["station_mm", "EI_N_m2"], [0, 100], [1, 90]], {}, ("missing", {})),
        ([["station_mm", "width_mm"], *((x, 0) for x, _ in WIDTHS)], {"running_length": None}, ("invalid_ski", {})),
    ],
)
def test_what_is_missing_or_wrong_is_named(
    tmp_path: Path, rows: list[Sequence[object]], given: dict[str, Any], error: tuple[str, dict[str, Any]]
) -> None:
    with raises(ParameterError, error[0], **error[1]):
        measured_ski(measured(lay(tmp_path / "t.csv", rows), **given))


def test_tests_that_contradict_each_other_are_refused() -> None:
    station, span = np.array([0.1, 0.0, -0.1]), np.full(3, 0.6)
    with raises(ParameterError, "contradiction"):
        stiffness_of_tests(station, span, np.array([1e-6, 1e-4, 1e-6]), np.zeros(3), bend=True)


def test_steps_of_the_gauges_are_in_the_error(tmp_path: Path) -> None:
    tests: list[Sequence[object]] = [["station_mm", "span (mm)", "load (N)", "deflection (mm)"], [800, 400, 100, 0.5]]
    rows: list[Sequence[object]] = [["station_mm", "width_mm"], *WIDTHS]
    paths = lay(tmp_path / "w.csv", rows), lay(tmp_path / "t.csv", tests)
    made = measured_ski(measured(*paths, dial_step=0.1 * MM, angle_step=DEGREE))
    assert made.bending is not None
    assert made.bending.error / made.bending.value == pytest.approx([0.1 / 12**0.5 / 0.5], rel=1e-3)
