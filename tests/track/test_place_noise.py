"""Noise of places on simulated tracks of known noise, with turns that the points resolve and turns that they do not."""

from functools import cache

import numpy as np
import pytest

from skisnow import track_summary
from skisnow._support.arrays import FloatArray
from skisnow.track.path_estimate import PlaceNoise, estimate_place_noise
from skisnow.track.smoothing import SmoothedTrack, smooth_track
from skisnow.track.summary import summary_dict
from tests.present import present

from .paths import track


def linked_turns(turn_s: float, step: float, count: int, seed: int) -> FloatArray:
    """Places (count, 2) at 12 m/s; the heading swings by ±0.8 rad, each turn takes ``turn_s``."""
    fine = np.arange(count * 50) * step / 50
    heading = 0.8 * np.sin(np.pi * fine / turn_s + seed)
    return np.cumsum(np.column_stack([np.cos(heading), np.sin(heading)]), axis=0)[::50] * 12.0 * step / 50


def noise_of(turn_s: float, step: float, noise: float, seed: int, count: int = 200) -> PlaceNoise:
    made = track(linked_turns(turn_s, step, count, seed), interval=step, noise=noise, seed=seed)
    return present(estimate_place_noise(made, smoothed(step, count)))


@cache
def smoothed(step: float, count: int) -> SmoothedTrack:
    """Only parts and usable points matter, which all tracks share."""
    return smooth_track(track(linked_turns(4.0, step, count, 0), interval=step))


@pytest.mark.parametrize(("turn_s", "step"), [(1.0, 0.1), (3.0, 0.2), (12.0, 0.4), (0.8, 0.04)])
@pytest.mark.parametrize("noise", [0.02, 0.3, 3.0])
def test_dense_points_give_the_noise(turn_s: float, step: float, noise: float) -> None:
    """Standard error of one 8 %, of the mean of 20 below 2 %; up to 5 % of the path may be left."""
    found = [noise_of(turn_s, step, noise, seed) for seed in range(20)]
    given = [each.value for each in found if not each.is_bound]
    assert len(given) >= 15
    assert np.mean(given) == pytest.approx(noise, rel=0.07)


@pytest.mark.parametrize("turn_s", [1.0, 2.0, 4.0, 10.0])
@pytest.mark.parametrize("noise", [0.0, 0.02, 0.3, 3.0])
def test_a_point_each_second_gives_a_bound(turn_s: float, noise: float) -> None:
    """Of 20 bounds at 97.5 % more than two too low have a probability of 1 %."""
    found = [noise_of(turn_s, 1.0, noise, seed) for seed in range(20)]
    assert all(each.is_bound for each in found)
    assert sum(each.value < noise for each in found) <= 2


def test_a_bound_is_below_the_error_of_the_smoothing() -> None:
    made = track(linked_turns(4.0, 1.0, 200, 0), interval=1.0, noise=0.02)
    about_cubics = smooth_track(made)
    found = present(estimate_place_noise(made, about_cubics))
    assert 0.02 < found.value < 0.1 * about_cubics.place_noise


@pytest.mark.usefixtures("pathless")
def test_uneven_times_and_gaps_take_no_part() -> None:
    made = track(linked_turns(3.0, 0.1, 200, 0), interval=0.1, noise=0.3)
    made.time[100:] += 0.05
    found = present(estimate_place_noise(made, smooth_track(made)))
    assert found.value == pytest.approx(0.3, rel=0.25)
    made.time[::5] += 0.03
    assert estimate_place_noise(made, smooth_track(made)) is None
    assert summary_dict(track_summary(made))["smoothing"]["place_noise_m"] is None
