"""The process of a search against plain linear algebra, its likelihood and its failures by hand."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.racing.search import Evaluated
from skisnow.racing.surrogate import Surrogate, times_of

FloatArray = npt.NDArray[np.float64]
DRAWN = np.random.default_rng(4).random((9, 2))
GIVEN = 5.0 + np.sin(3.0 * DRAWN[:, 0]) + 0.5 * DRAWN[:, 1] ** 2


def matern(first: FloatArray, second: FloatArray, lengths: FloatArray) -> FloatArray:
    """(1 + √5 r + 5 r²/3) exp(-√5 r), one pair after the other."""
    found = np.zeros((len(first), len(second)))
    for i, j in product(range(len(first)), range(len(second))):
        r = math.sqrt(sum(((a - b) / length) ** 2 for a, b, length in zip(first[i], second[j], lengths, strict=True)))
        found[i, j] = (1.0 + math.sqrt(5.0) * r + 5.0 * r**2 / 3.0) * math.exp(-math.sqrt(5.0) * r)
    return found


def test_the_process_is_that_of_the_textbook() -> None:
    """m + s k (K + σ² 1)⁻¹ z, and s² (1 - k (K + σ² 1)⁻¹ k), by plain linear algebra."""
    known, asked = Surrogate.of(DRAWN, GIVEN, 2), np.array([[0.2, 0.4], [0.9, 1.3]])
    inner = matern(DRAWN, DRAWN, known.lengths) + known.noise**2 * np.eye(9)
    outer = matern(asked, DRAWN, known.lengths)
    level, scale = np.mean(GIVEN), np.std(GIVEN)
    mean = level + scale * outer @ np.linalg.solve(inner, (GIVEN - level) / scale)
    variance = 1.0 - np.einsum("ij,ji->i", outer, np.linalg.solve(inner, outer.T))
    found = known.at(asked)
    assert found[0] == pytest.approx(mean, rel=1e-5)
    assert found[1] == pytest.approx(scale * np.sqrt(variance), rel=1e-3)


def test_the_process_is_the_likeliest() -> None:
    """Of its length (the same for both numbers) and noise every other is less likely, with a pull towards 0.7."""
    known = Surrogate.of(DRAWN, GIVEN + 0.05 * np.cos(40.0 * DRAWN[:, 0]), 1)
    standard = np.sin(3.0 * DRAWN[:, 0]) + 0.5 * DRAWN[:, 1] ** 2 + 0.05 * np.cos(40.0 * DRAWN[:, 0])
    standard = (standard - standard.mean()) / standard.std()

    def misfit(length: float, noise: float) -> float:
        inner = matern(DRAWN, DRAWN, np.full(2, length)) + (noise**2 + 1e-9) * np.eye(9)
        likelihood = 0.5 * standard @ np.linalg.solve(inner, standard) + 0.5 * np.linalg.slogdet(inner)[1]
        return float(likelihood + 0.1 * math.log(length / 0.7) ** 2)

    length, noise = float(known.lengths[0]), known.noise
    least = misfit(length, noise)
    assert known.lengths[1] == length
    others = [(length * 1.1, noise), (length / 1.1, noise), (length, max(noise * 1.2, 1e-3)), (length, noise / 1.2)]
    assert all(misfit(*other) > least - 1e-6 for other in others if other[1] > 1e-3)
    assert misfit(length * 1.3, noise) > least + 1e-3


def test_values_that_are_all_alike_are_learnt() -> None:
    assert Surrogate.of(DRAWN, np.full(9, 7.0), 2).at(DRAWN)[0] == pytest.approx(7.0)


def test_times_of_failures_by_hand() -> None:
    """A failure has its time at the last gate; one without, or a detour, three quarter widths above the median."""
    times = [8.0, 8.1, 8.2, 8.3]
    found = [Evaluated(i, (0.0,), {"value": time}) for i, time in enumerate(times)]
    straddled = Evaluated(4, (0.0,), {"value": 1000.4, "gates": [["straddled", 4.0], ["passed", 8.4]]})
    fell = Evaluated(5, (0.0,), {"value": 2003.0, "gates": [["passed", 4.0], ["not_reached", None]]})
    most = 8.2 + 3.0 * 0.2
    assert times_of([*found, straddled, fell]) == pytest.approx([*times, 8.4, most])
    detour = Evaluated(6, (0.0,), {"value": 20.0})
    assert times_of([*found, straddled, detour])[5] == pytest.approx(8.25 + 3.0 * 0.25)
    assert times_of([fell, Evaluated(7, (0.0,), {"value": math.inf})]) == pytest.approx(np.log([2003.0, 1e6]))
