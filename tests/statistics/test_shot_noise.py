"""Shot noise whose parameters are known is drawn, and they are found again."""

from __future__ import annotations

import numpy as np
import pytest

from skisnow.statistics.shot_noise import shot_noise, windows_of

STEP = 4e-6


def saw_teeth(force: float, deflection: float, intensity: float, length: float, seed: int) -> np.ndarray:
    """The sum of teeth that rise to ``force`` over ``deflection`` and begin at random places."""
    rng = np.random.default_rng(seed)
    place = np.arange(round(length / STEP)) * STEP
    found = np.zeros(len(place))
    for start in rng.uniform(-deflection, length, rng.poisson(intensity * (length + deflection))):
        first, last = np.searchsorted(place, (start, start + deflection))
        found[first:last] += force * (place[first:last] - start) / deflection
    return found


@pytest.mark.parametrize(("force", "deflection", "intensity"), [(0.02, 1e-4, 2e4), (0.05, 2e-4, 2e4)])
def test_parameters_of_drawn_shot_noise(force: float, deflection: float, intensity: float) -> None:
    """A window of 0.4 m with 8000 teeth; ten seeds scatter by 2 % in f₀ and δ and 4 % in λ about the true value."""
    found = shot_noise(saw_teeth(force, deflection, intensity, 0.4, seed=3), STEP)
    assert float(found.rupture_force) == pytest.approx(force, rel=0.05)
    assert float(found.deflection) == pytest.approx(deflection, rel=0.05)
    assert float(found.intensity) == pytest.approx(intensity, rel=0.1)


def test_force_and_length_have_their_scales() -> None:
    """Twice the force: twice f₀ alone. Twice the distance between samples: twice δ, half λ."""
    drawn = saw_teeth(0.02, 1e-4, 4e5, 0.01, seed=1)
    one, stronger, longer = shot_noise(drawn, STEP), shot_noise(2 * drawn, STEP), shot_noise(drawn, 2 * STEP)
    np.testing.assert_allclose(
        [stronger.rupture_force / one.rupture_force, stronger.deflection / one.deflection], [2, 1]
    )
    np.testing.assert_allclose([longer.deflection / one.deflection, longer.intensity / one.intensity], [2, 0.5])


def test_a_line_beneath_does_not_lengthen_the_deflection() -> None:
    """A layer that grows harder: without the line taken off, δ would be several times as long."""
    drawn = saw_teeth(0.02, 1e-4, 4e5, 0.01, seed=1)
    slope = np.linspace(0.0, 5.0, len(drawn))
    np.testing.assert_allclose(shot_noise(drawn + slope, STEP).deflection, shot_noise(drawn, STEP).deflection)


def test_what_says_nothing_is_nan() -> None:
    flat, below, alternating = np.ones(50), -np.ones(50) + np.arange(50) % 2 / 10, np.zeros(50)
    found = shot_noise(np.stack([flat, below, alternating]), STEP)
    for each in (found.rupture_force, found.deflection, found.intensity):
        assert np.isnan(each).all()


def test_windows_are_whole_and_overlap() -> None:
    assert windows_of(np.arange(7.0), 4, 2).tolist() == [[0, 1, 2, 3], [2, 3, 4, 5]]
    assert windows_of(np.arange(3.0), 4, 2).shape == (0, 4)
