"""Numbers of Mössner and others (2013) beside skisnow's: ``python -m benchmarks.printed_numbers``.

Writes the two tables of the page on validation. Numbers that follow from other printed numbers are computed;
those that need the paper's raw data, which are not public, are computed from simulated campaigns of the paper's design.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from collections import defaultdict
from typing import Final, Literal, NamedTuple

import numpy as np

import skisnow
from benchmarks.page_tables import write_tables
from skisnow._support.units import DEGREE, N_PER_MM2, N_PER_MM3
from skisnow.campaign import reference_campaign
from skisnow.forces.shear.machining import MachiningShear
from skisnow.snow.published import domine_2011, federolf_2006, moessner_2013

RMSE_ROWS: Final = {
    "H_e:a=linear,b=linear": "rmse, H_e, a and b linear (N)",
    "H_A:a=linear,b=linear": "rmse, H_A, a and b linear (N)",
    "H_V:a=linear,b=linear": "rmse, H_V, a and b linear (N)",
    "H_e:a=constant,b=constant": "rmse, H_e, a and b constant (N)",
    "H_A:a=constant,b=constant": "rmse, H_A, a and b constant (N)",
    "H_V:a=constant,b=constant": "rmse, H_V, a and b constant (N)",
    "H_V:a=none,b=linear": "rmse, H_V, b linear, Eqn 11 (N)",
    "H_V:a=none,b=constant": "rmse, H_V, b constant (N)",
    "H_V:a=none,b=one": "rmse, F = H_V V, Eqn 12 (N)",
}
PAIRS: Final = {
    ("S_f_N_per_mm2", "edge_angle_rad", "site I"): "S_f on edge angle, hard snow: p",
    ("S_f_N_per_mm2", "edge_angle_rad", "site J"): "S_f on edge angle, soft snow: p",
    ("S_f_N_per_mm2", "snow_density_kg_per_m3", "all"): "S_f on density: p",
    ("H_V_N_per_mm3", "snow_density_kg_per_m3", "all"): "H_V on density: p",
    ("H_V_N_per_mm3", "drop_cone_depth_mm", "all"): "H_V on drop-cone depth: p",
    ("S_f_N_per_mm2", "H_V_N_per_mm3", "all"): "S_f on H_V: p",
}
KINDS: Final[tuple[tuple[Literal["penetration", "shear"], str, str, str], ...]] = (
    ("penetration", "H_V_N_per_mm3", "H_V, lowest (N/mm³)", "H_V, highest (N/mm³)"),
    ("shear", "S_f_N_per_mm2", "S_f, lowest (N/mm²)", "S_f, highest (N/mm²)"),
)
COUNTS: Final = {
    ("S_f_N_per_mm2", "edge_angle_rad", "site I"): "shear tests at varied angle, hard snow",
    ("S_f_N_per_mm2", "edge_angle_rad", "site J"): "shear tests at varied angle, soft snow",
    ("S_f_N_per_mm2", "H_V_N_per_mm3", "all"): "tests with S_f and H_V",
}
PRINTED: Final = {
    **{RMSE_ROWS[model]: f"{rmse:g}" for model, rmse in moessner_2013.PRINTED_RMSE_N.items()},
    "Eqn 11: b_0": "0.99",
    "Eqn 11: b_1 (1/rad)": "0.14",
    "Eqn 13: S_f at 0° (N/mm²)": "0.059",
    "Eqn 13: relative decrease (1/rad)": "0.266",
    "Eqn 13: rmse (N/mm²)": "0.006",
    "Eqn 14: intercept (N/mm²)": "-0.047",
    "Eqn 14: slope (N/mm² per kg/m³)": "0.00031",
    "Eqn 14: rmse (N/mm²)": "0.059",
    PAIRS["S_f_N_per_mm2", "edge_angle_rad", "site I"]: "0.50",
    PAIRS["S_f_N_per_mm2", "edge_angle_rad", "site J"]: "< 0.01",
    PAIRS["S_f_N_per_mm2", "snow_density_kg_per_m3", "all"]: "< 0.01",
    PAIRS["H_V_N_per_mm3", "snow_density_kg_per_m3", "all"]: "0.99",
    PAIRS["H_V_N_per_mm3", "drop_cone_depth_mm", "all"]: "0.83",
    PAIRS["S_f_N_per_mm2", "H_V_N_per_mm3", "all"]: "0.52",
    "mean density, penetration tests (kg/m³)": "556",
    "mean density, shear tests (kg/m³)": "563",
    "mean drop-cone depth, penetration tests (mm)": "13.6",
    "mean drop-cone depth, shear tests (mm)": "24.8",
    "H_V, lowest (N/mm³)": "0.04",
    "H_V, highest (N/mm³)": "90",
    "S_f, lowest (N/mm²)": "0.04",
    "S_f, highest (N/mm²)": "0.40",
    "lowest density, penetration tests (kg/m³)": "420",
    "highest density, penetration tests (kg/m³)": "620",
    "lowest density, shear tests (kg/m³)": "420",
    "highest density, shear tests (kg/m³)": "740",
    "lowest drop-cone depth, penetration tests (mm)": "7.4",
    "highest drop-cone depth, penetration tests (mm)": "21.2",
    "lowest drop-cone depth, shear tests (mm)": "8.0",
    "highest drop-cone depth, shear tests (mm)": "47.0",
    "penetration tests": "236",
    "shear tests": "108",
    "shear tests at varied angle, hard snow": "20",
    "shear tests at varied angle, soft snow": "30",
    "tests with S_f and H_V": "35",
}
"""Printed number of each row that needs raw data."""


class Derived(NamedTuple):
    """A printed number that follows from others that are printed, its rounding, and the same number computed here."""

    what: str
    printed: float
    unit_of_last_digit: float
    ours: float

    @property
    def agrees(self) -> bool:
        """Within half of the last printed digit, or 1 %."""
        return abs(self.ours - self.printed) <= max(0.5 * self.unit_of_last_digit, 0.01 * abs(self.printed))


def derived() -> list[Derived]:
    """The numbers that need no raw data."""
    names = ("race piste", "recreational piste", "spring snow")
    printed = ((0.21, 0.01, 0.52, 0.01), (0.16, 0.01, 0.086, 0.001), (0.022, 0.001, 0.094, 0.001))
    rows = []
    for name, snow, (hardness, digit, stress, stress_digit) in zip(
        names, federolf_2006.named_snows().values(), printed, strict=True
    ):
        assert snow.snow_hardness is not None
        assert snow.failure_shear_stress is not None
        rows += [
            Derived(f"H_V of Federolf's {name} (N/mm³)", hardness, digit, snow.snow_hardness / N_PER_MM3),
            Derived(f"S_f of Federolf's {name} (N/mm²)", stress, stress_digit, snow.failure_shear_stress / N_PER_MM2),
        ]
    density = 500.0
    domine = float(domine_2011.failure_shear_stress_from_density(density)) / N_PER_MM2
    intercept, slope = moessner_2013.STRESS_BY_DENSITY
    shear = MachiningShear(dynamic_shear_strength=N_PER_MM2 / 10.0, transverse_friction=0.0)
    upright = float(shear.failure_force(1.0, 1.0, 90.0 * DEGREE)) / shear.dynamic_shear_strength
    simple, linear = (moessner_2013.PRINTED_RMSE_N[f"H_V:a=none,b={b}"] for b in ("one", "linear"))
    return [
        *rows,
        Derived("S_f of Domine at 500 kg/m³ (N/mm²)", 0.0015, 1e-4, domine),
        Derived("S_f by Eqn 14 at 500 kg/m³ (N/mm²)", 0.11, 0.01, intercept + slope * density),
        Derived("S_f / S by Eqn 10 at 90° without friction", 2.0, 1.0, upright),
        Derived("gain in rmse by the angle term (%)", 4.0, 1.0, 100.0 * (simple / linear - 1.0)),
    ]


def values_of(seed: int) -> dict[str, float]:
    """The numbers of one simulated campaign."""
    analysis = skisnow.analyse(reference_campaign(seed).campaign(), n_resamples=100)
    results = analysis.results
    models = {row["id"]: row for row in results["penetration"]["models"]}
    values = {RMSE_ROWS[name]: row["rmse_N"] for name, row in models.items()}
    values["Eqn 11: b_0"] = models["H_V:a=none,b=linear"]["b0"]
    values["Eqn 11: b_1 (1/rad)"] = models["H_V:a=none,b=linear"]["b1"]
    for row in results["regressions"]:
        pair = (row["response"], row["terms"][1], row["group"])
        if pair in PAIRS:
            values[PAIRS[pair]] = row["p"]
        if pair in COUNTS:
            values[COUNTS[pair]] = row["n"]
        if pair == ("S_f_N_per_mm2", "edge_angle_rad", "site J"):
            values["Eqn 13: S_f at 0° (N/mm²)"] = row["b"][0]
            values["Eqn 13: relative decrease (1/rad)"] = -row["b"][1] / row["b"][0]
            values["Eqn 13: rmse (N/mm²)"] = row["rmse"]
        if pair == ("S_f_N_per_mm2", "snow_density_kg_per_m3", "all"):
            values["Eqn 14: intercept (N/mm²)"], values["Eqn 14: slope (N/mm² per kg/m³)"] = row["b"]
            values["Eqn 14: rmse (N/mm²)"] = row["rmse"]
    for kind, result, lowest, highest in KINDS:
        tests = results[kind]["experiments"]
        values[f"{kind} tests"] = len(tests)
        estimates = [row[result] for row in tests if row["used"]]
        values |= {lowest: min(estimates), highest: max(estimates)}
        columns = analysis.observations[kind].columns
        for name, column in (
            ("density, {} tests (kg/m³)", "snow_density_kg_per_m3"),
            ("drop-cone depth, {} tests (mm)", "drop_cone_depth_mm"),
        ):
            for word, of in (("mean", np.nanmean), ("lowest", np.nanmin), ("highest", np.nanmax)):
                values[f"{word} {name.format(kind)}"] = float(of(columns[column]))
    return values


def simulated(seeds: range) -> dict[str, list[float]]:
    """Each number in each campaign."""
    numbers: dict[str, list[float]] = defaultdict(list)
    for count, seed in enumerate(seeds, start=1):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            for name, value in values_of(seed).items():
                numbers[name].append(value)
        print(f"\r{count} of {len(seeds)} campaigns", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    return numbers


def derived_table() -> list[str]:
    """Numbers that follow from printed ones, in Markdown."""
    lines = ["| follows from printed numbers | printed | ours |", "| --- | ---: | ---: |"]
    return lines + [f"| {row.what} | {row.printed:g} | {row.ours:.3g} |" for row in derived()]


def simulated_table(seeds: range) -> list[str]:
    """Median and range of the other numbers, in Markdown."""
    lines = [f"| *synthetic*, {len(seeds)} campaigns | printed | median | range |", "| --- | ---: | ---: | ---: |"]
    numbers = simulated(seeds)
    for name, printed in PRINTED.items():
        values = np.array(numbers.get(name, []), dtype=float)
        cells = (f"{np.median(values):.3g}", f"{values.min():.3g} to {values.max():.3g}") if len(values) else ("–", "–")
        lines.append(f"| {name} | {printed} | {' | '.join(cells)} |")
    return lines


def main() -> None:
    """Write the tables."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.printed_numbers")
    parser.add_argument("--campaigns", type=int, default=200)
    seeds = range(parser.parse_args().campaigns)
    write_tables("validation/index", {"printed-derived": derived_table(), "printed-simulated": simulated_table(seeds)})


if __name__ == "__main__":
    main()
