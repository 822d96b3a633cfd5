"""The stated resolution against the Legendre projection of a wave, and against a wave that is smoothed."""

import numpy as np
import pytest
from scipy.special import spherical_jn

from skisnow.track.curvature import track_motion
from skisnow.track.resolution import Resolution

from .paths import track


@pytest.mark.parametrize("period", [0.5, 0.8, 1.2, 3.0])
def test_dense_points_pass_what_the_projection_on_a_parabola_passes(period: float) -> None:
    """The second derivative of the projection of exp(iωt) on P₂ is 15 j₂(z)/z² of its own, z = ω · half a window."""
    z = 2.0 * np.pi / period * 0.5
    found = Resolution.of_window(1.0, 0.0005, 0.02, None).share_passed(period)
    assert found == pytest.approx(15.0 * spherical_jn(2, z) / z**2, abs=3e-3)  # 401 points in place of an integral


def test_long_swings_lose_a_fourteenth_of_z_squared() -> None:
    z = 2.0 * np.pi / 20.0 * 0.5
    assert 1.0 - Resolution.of_window(1.0, 0.0005, 0.02, None).share_passed(20.0) == pytest.approx(
        z**2 / 14.0, rel=0.02
    )


@pytest.mark.parametrize("share", [0.5, 0.9])
def test_wave_of_the_stated_period_keeps_the_stated_share(share: float) -> None:
    """A path y = a sin(2πt/T), x = vt with a slope of at most 0.01: its curvature is y''/v² within 0.02 %."""
    speed, interval, window = 10.0, 0.02, 1.0
    period = Resolution.of_window(window, interval, 1.0, None).period_passed(share)
    time = interval * np.arange(round(6.0 * period / interval))
    angular = 2.0 * np.pi / period
    amplitude = 0.01 * speed / angular
    place = np.stack([speed * time, amplitude * np.sin(angular * time)], axis=1)
    curvature = track_motion(track(place, interval=interval), window=window).curvature
    inner = slice(60, -60)
    true = -amplitude * angular**2 * np.sin(angular * time[inner]) / speed**2
    assert curvature[inner] @ true / (true @ true) == pytest.approx(share, rel=2e-3)


@pytest.mark.parametrize("period", [0.8, 1.2, 3.0])
def test_good_velocities_pass_what_the_projection_on_a_line_passes(period: float) -> None:
    """Their slope is that of the projection on P₁: 3 j₁(z)/z of a wave's own; surer than by places, not finer."""
    z = 2.0 * np.pi / period * 0.5
    found = Resolution.of_window(1.0, 0.0005, 1e6, 0.02).share_passed(period)
    assert found == pytest.approx(3.0 * spherical_jn(1, z) / z, abs=3e-3)


def test_resolution_scales_with_the_window() -> None:
    short, long = (Resolution.of_window(window, 0.001, 0.02, None).half_period for window in (1.0, 3.0))
    assert long == pytest.approx(3.0 * short, rel=2e-3)
