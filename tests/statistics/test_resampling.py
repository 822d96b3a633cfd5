"""Bootstrap counts and percentile intervals."""

from __future__ import annotations

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.statistics import percentile_interval, resampling_counts
from skisnow.statistics.shot_noise import shot_noise, windows_of


@pytest.mark.parametrize("chunk", [1, 2, 7, 40, 1000])
@pytest.mark.parametrize("n_units", [1, 3, 236])
def test_counts_do_not_depend_on_the_chunk(n_units: int, chunk: int) -> None:
    whole = np.vstack(list(resampling_counts(n_units, 41, np.random.default_rng(9))))
    parts = list(resampling_counts(n_units, 41, np.random.default_rng(9), chunk=chunk))
    np.testing.assert_array_equal(np.vstack(parts), whole)
    assert max(len(part) for part in parts) <= chunk
    assert whole.shape == (41, n_units)
    assert whole.dtype == np.float64


def test_every_resample_draws_as_many_as_there_are() -> None:
    for part in resampling_counts(17, 100, np.random.default_rng(1), chunk=13):
        np.testing.assert_array_equal(part.sum(axis=1), 17)
        assert part.min() >= 0


def test_counts_are_multinomial() -> None:
    n, B = 20, 40_000
    counts = np.vstack(list(resampling_counts(n, B, np.random.default_rng(4))))
    # mean 1, variance 1 - 1/n, covariance -1/n; five standard errors of each, about √(2/B)
    assert np.abs(counts.mean(axis=0) - 1).max() < 5 * np.sqrt(1 / B)
    covariance = np.cov(counts.T)
    assert np.abs(np.diag(covariance) - (1 - 1 / n)).max() < 5 * np.sqrt(3 / B)
    assert np.abs(covariance[~np.eye(n, dtype=bool)] + 1 / n).max() < 5 * np.sqrt(1 / B)
    # a unit is left out with probability (1 - 1/n)^n
    q = (1 - 1 / n) ** n
    assert abs(float(np.mean(counts == 0)) - q) < 5 * np.sqrt(q * (1 - q) / B)


def test_another_seed_gives_other_counts() -> None:
    one, other = (next(resampling_counts(50, 1, np.random.default_rng(seed))) for seed in (1, 2))
    assert np.any(one != other)


def test_many_units_come_in_small_parts() -> None:
    parts = resampling_counts(150_000, 3, np.random.default_rng(1))
    sizes = [part.nbytes for part in parts]
    assert sizes == [150_000 * 8] * 3


def test_bootstrap_of_a_mean_has_the_known_standard_error() -> None:
    values = np.random.default_rng(6).normal(size=60)
    means = np.concatenate([part @ values / 60 for part in resampling_counts(60, 20_000, np.random.default_rng(7))])
    # exact: the variance of a resampled mean is Σ(x - x̄)²/n²; the spread of a standard deviation over B is 1/√(2B)
    assert means.std() == pytest.approx(values.std() / np.sqrt(60), rel=5 / np.sqrt(2 * 20_000))


@pytest.mark.parametrize(("n_units", "n_resamples", "chunk"), [(0, 1, None), (1, -1, None), (1, 1, 0)])
def test_bad_sizes(n_units: int, n_resamples: int, chunk: int | None) -> None:
    with pytest.raises(ParameterError):
        resampling_counts(n_units, n_resamples, np.random.default_rng(1), chunk=chunk)


def test_percentiles_of_an_even_row() -> None:
    samples = np.random.default_rng(1).permutation(np.arange(1001.0))
    np.testing.assert_allclose(percentile_interval(samples), [25, 975], rtol=1e-13)
    shaped = percentile_interval(np.stack((samples, -2 * samples), axis=1)[:, None, :], confidence=0.8)
    np.testing.assert_allclose(shaped, [[[100, 900], [-1800, -200]]], rtol=1e-13)


def test_nan_is_not_forgotten() -> None:
    samples = np.ones((5, 2))
    samples[3, 1] = np.nan
    assert percentile_interval(samples)[0].tolist() == [1.0, 1.0]
    assert np.isnan(percentile_interval(samples)[1]).all()
    assert np.isnan(percentile_interval(np.empty((0, 3)))).all()
    with pytest.raises(ParameterError):
        percentile_interval(1.0)


# Shot noise whose parameters are known is drawn, and they are found again


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
