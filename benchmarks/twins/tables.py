"""Finished twins as the tables of docs/validation/identification.md."""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Final

import numpy as np
from scipy.stats import binomtest

from . import glides, shears
from .kept import KeptTwins
from .truth import ERRORS, FREE, SCENARIOS
from .turns import ELASTIC, NOISELESS

Rows = Sequence[Mapping[str, str]]
NO_ERROR: Final = "none"
ALLOWED: Final = 0.01
"""Largest deviation over the run's length."""
UNITS: Final = {"friction.mu_0": "", "drag.drag_area_m2": " m²", "start.heading_deg": "°"}


def page_tables(kept: Mapping[str, KeptTwins]) -> dict[str, str]:
    """Tables of the page by name."""
    return {
        "deviations": deviations(kept["turns"]),
        "coverage": coverage_of_turns(kept["turns"]),
        "without noise": without_noise(kept["noiseless"]),
        "elastic": elastic(kept["turns"]),
        "photo cells": photo_cells(kept["glides"]),
        "shear": shear_of_tracks(kept["shears"]),
    }


def deviations(turns: KeptTwins) -> str:
    """How far the identified run is from the true one."""
    rows = []
    for scenario in SCENARIOS:
        for error in ("", *ERRORS):
            twins = [row for row in turns.of(scenario) if row["error"] == error]
            if twins:
                nearest, at_time = (column(twins, name) for name in ("largest_nearest_m", "largest_at_time_m"))
                share = at_time / column(twins, "run_length_m")
                below = f"{int(np.sum(share < ALLOWED))} of {len(twins)}"
                numbers = (centimetres(nearest), centimetres(at_time), f"{100.0 * share.max():.2f}")
                residual = f"{np.median(column(twins, 'rms_residual')):.2f}"
                off = (biased(twins, key) for key in FREE[:2])
                rows.append((scenario, error or NO_ERROR, str(len(twins)), *numbers, below, residual, *off))
    head = (
        "scenario", "model error", "twins", "nearest place: median, largest (cm)", "equal time: median, largest (cm)",
        "largest share of the length (%)", "below 1 %", "rms residual (sd)", "error of mu_0", "error of drag_area (m²)",
    )  # fmt: skip
    return table(head, rows, words=2)


def coverage_of_turns(turns: KeptTwins) -> str:
    """How many intervals hold the truth, where the model is right."""
    rows = []
    for scenario in SCENARIOS:
        twins = [row for row in turns.of(scenario) if not row["error"]]
        rows += [(scenario, *coverage(twins, key)) for key in FREE if twins]
    return table(("scenario", *COVERAGE), rows, words=2)


def without_noise(noiseless: KeptTwins) -> str:
    """How far the answer is off because the truth has finer numbers, and that over its standard error."""
    rows = []
    for scenario in SCENARIOS:
        for row in noiseless.of(scenario + NOISELESS):
            off = (f"{float(row[f'{key} found']) - float(row[f'{key} true']):+.1e}{UNITS[key]}" for key in FREE)
            share = (f"{in_standard_errors(row, key):+.2f}" for key in FREE)
            words = (f"{one} ({other})" for one, other in zip(off, share, strict=True))
            rows.append((scenario, f"{100.0 * float(row['largest_at_time_m']):.2f}", *words))
    names = (key.partition(".")[2] for key in FREE)
    return table(("scenario", "largest at equal time (cm)", *names), rows, words=1)


def in_standard_errors(row: Mapping[str, str], key: str) -> float:
    """The error over a standard error; the interval is 2 × 1.96 of these wide."""
    value, true, low, high = (float(row[f"{key} {name}"]) for name in ("found", "true", "low", "high"))
    return (value - true) / ((high - low) / (2.0 * 1.959964))


def photo_cells(cells: KeptTwins) -> str:
    """Coverage, and standard errors over those of the Fisher information."""
    rows = []
    for case, count in glides.CASES.items():
        twins = cells.of(case)
        for key in list(glides.KEYS.values())[:count] if twins else []:
            ratio = column(twins, f"{key} error over Fisher")
            away = column(twins, f"{key} error over Fisher at the truth")
            off = (f"{np.abs(ratio - 1.0).max():.0e}", f"{np.abs(away - 1.0).max():.1e}")
            rows.append((case.partition(", ")[2], *coverage(twins, key), *off))
    head = ("looked for", *COVERAGE, "standard error off that of Fisher, at most", "the same at the truth")
    return table(head, rows, words=2)


def elastic(turns: KeptTwins) -> str:
    """The same twins, identified with the snow that made them and with elastic snow."""
    rows = []
    for scenario in SCENARIOS:
        alike = {row["seed"] for row in turns.of(scenario + ELASTIC)}
        for words, case in (("hypoplastic", scenario), ("elastic", scenario + ELASTIC)):
            twins = [row for row in turns.of(case) if row["seed"] in alike]
            if twins:
                converged = f"{sum(row['outcome'] == 'converged' for row in twins)} of {len(twins)}"
                off = (biased(twins, key) for key in FREE)
                apart = (centimetres(column(twins, name)) for name in ("largest_nearest_m", "largest_at_time_m"))
                residual = f"{np.median(column(twins, 'rms_residual')):.2f}"
                rows.append((scenario, words, converged, *apart, residual, *off))
    head = (
        "scenario", "identified as", "converged", "nearest place: median, largest (cm)",
        "equal time: median, largest (cm)", "rms residual (sd)", "error of mu_0", "error of drag_area (m²)",
        "error of heading (°)",
    )  # fmt: skip
    return table(head, rows, words=2)


def shear_of_tracks(twins: KeptTwins) -> str:
    """By whether the edge slips: errors of S_f and u_y, how many intervals hold the truth, how they hang together."""
    rows = []
    for words, slips in (("holds", "0"), ("slips", "1")):
        those = [row for row in twins.of(shears.CASE) if row["slips"] == slips]
        known = [row for row in those if row["outcome"] == "converged"]
        told = np.abs(column(those, "correlation"))
        rows.append((
            words, str(len(those)), f"{len(known)} of {len(those)}",
            *(cell for key in shears.FREE for cell in (rms_factor(known, key), covered_words(known, key))),
            f"{np.nanmedian(told):.2f}" if those else "",
            f"{sum(row['near the limit'] == '1' for row in those)} of {len(those)}",
        ))  # fmt: skip
    head = (
        "the edge", "twins", "converged", "error of S_f (%)", "S_f covered", "error of u_y (%)", "u_y covered",
        "correlation, median of its size", "warned: near the limit",
    )  # fmt: skip
    return table(head, rows, words=1)


COVERAGE: Final = ("parameter", "twins", "rms error", "covered", "99 % interval of that share (%)", "holds 95 %")


def coverage(twins: Rows, key: str) -> tuple[str, ...]:
    """Parameter, twins, rms error, covered, binomial interval, whether that holds 95 %; none open is left out."""
    k, n = covered(twins, key)
    low, high = binomial(k, n)
    holds = "yes" if low <= 0.95 <= high else "**no**"
    error = column(twins, f"{key} found") - column(twins, f"{key} true")
    rms = f"{np.sqrt(np.mean(error**2)):.2g}{UNITS.get(key, ' m/s')}"
    name = key.partition(".")[2]
    return name, str(n), rms, str(k), f"{100.0 * low:.1f} to {100.0 * high:.1f}", holds


def covered(twins: Rows, key: str) -> tuple[int, int]:
    """How many intervals hold the truth, of how many; an end that is open holds everything on its side."""
    inside = 0
    for row in twins:
        low, high = (row[f"{key} {end}"] for end in ("low", "high"))
        value = float(row[f"{key} true"])
        inside += (not low or float(low) <= value) and (not high or value <= float(high))
    return inside, len(twins)


def binomial(k: int, n: int) -> tuple[float, float]:
    """Clopper and Pearson's 99 % interval of a share k/n.

    Of 5 of 5, (0.005)^(1/5) is the lower end by hand.
    """
    found = binomtest(k, n).proportion_ci(0.99, method="exact")
    return float(found.low), float(found.high)


def covered_words(twins: Rows, key: str) -> str:
    """Such as 19 of 20."""
    k, n = covered(twins, key)
    return f"{k} of {n}" if n else ""


def rms_factor(twins: Rows, key: str) -> str:
    """Rms of the logarithm, in per cent."""
    if not twins:
        return ""
    off = np.log(column(twins, f"{key} found") / column(twins, f"{key} true"))
    return f"{100.0 * math.sqrt(float(np.mean(off**2))):.0f}"


def biased(twins: Rows, key: str) -> str:
    """Mean error ± standard deviation of one, which a single one does not have."""
    error = column(twins, f"{key} found") - column(twins, f"{key} true")
    return f"{error.mean():+.2g}" + (f" ± {error.std(ddof=1):.1g}" if len(error) > 1 else "")


def centimetres(lengths: np.ndarray) -> str:
    """Median and largest."""
    return f"{100.0 * np.median(lengths):.1f}, {100.0 * lengths.max():.1f}"


def column(twins: Rows, name: str) -> np.ndarray:
    """Numbers; what does not exist is NaN."""
    return np.array([float(row[name] or "nan") for row in twins])


def table(head: Sequence[str], rows: Iterable[Sequence[str]], *, words: int) -> str:
    """Markdown; the first `words` columns are words, the others numbers."""
    lines = [f"| {' | '.join(head)} |", f"| {' | '.join(['---'] * words + ['---:'] * (len(head) - words))} |"]
    return "\n".join(lines + [f"| {' | '.join(row)} |" for row in rows])
