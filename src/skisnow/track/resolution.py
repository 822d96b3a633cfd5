"""What a smoothing lets pass: the share of a curvature's swing that is left, by the time that the swing takes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Resolution:
    """The transfer function of local cubics on evenly spaced points, away from ends and gaps.

    Attributes
    ----------
    window
        Length of the window (s).
    offsets
        Times (s) of the points of a window from its middle.
    place_weights, rate_weights
        The estimate of the acceleration is the sum of these times places (1/s²) and recorded velocities (1/s).
    """

    window: float
    offsets: tuple[float, ...]
    place_weights: tuple[float, ...]
    rate_weights: tuple[float, ...]

    @classmethod
    def of_window(cls, window: float, interval: float, place_noise: float, rate_noise: float | None) -> Resolution:
        """Of points ``interval`` (s) apart, with these noises (m, and m/s or None without velocities)."""
        each_side = int(np.floor(window / 2.0 / interval + 1e-9))
        stride = max(1, each_side // 200)  # a dense window's transfer function needs no more points
        tau = np.arange(-each_side, each_side + 1, stride) * interval
        powers = np.arange(4)
        rows = tau[:, None] ** powers / place_noise
        if rate_noise is not None:
            slopes = powers * tau[:, None] ** np.maximum(powers - 1, 0) / rate_noise
            rows = np.concatenate([rows, slopes])
        scale = (window / 2.0) ** powers
        weights = 2.0 * np.linalg.pinv(rows / scale)[2] / scale[2]
        place, rate = weights[: len(tau)] / place_noise, weights[len(tau) :]
        faster = () if rate_noise is None else tuple((rate / rate_noise).tolist())
        return cls(window, tuple(tau.tolist()), tuple(place.tolist()), faster)

    def share_passed(self, period: float) -> float:
        """Share of the amplitude of a curvature that swings with this period (s), on a path that is nearly straight."""
        angular = 2.0 * np.pi / period
        tau = np.array(self.offsets)
        passed = np.array(self.place_weights) @ np.cos(angular * tau)
        if self.rate_weights:
            passed -= angular * (np.array(self.rate_weights) @ np.sin(angular * tau))
        return float(-passed / angular**2)

    def period_passed(self, share: float) -> float:
        """Shortest period (s) of which this share of the amplitude passes, and of all longer ones more.

        Parameters
        ----------
        share
            Between 0.1 and 0.99.
        """
        low, high = 0.4 * self.window, 0.4 * self.window
        while self.share_passed(high) < share:
            low, high = high, 1.05 * high
        return high if low == high else float(brentq(lambda period: self.share_passed(period) - share, low, high))

    @property
    def half_period(self) -> float:
        """Period (s) of which half of the amplitude is left: the resolution. Shorter swings are smoothed away."""
        return self.period_passed(0.5)

    @property
    def faithful_period(self) -> float:
        """Period (s) of which 90 % of the amplitude is left."""
        return self.period_passed(0.9)
