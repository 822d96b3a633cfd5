"""The outline of a ski from three widths: one arc along the sides, a rounded tip, a square tail."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from .layout import Layout

FloatArray = npt.NDArray[np.float64]

TIP_END_SHARE: Final = 0.2
"""Width at the very tip as a share of the tip width, where it is not given. Modelling assumption: a blunt end, so that
the ski has a width everywhere."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ArcOutline:
    """Widths over the stations of a ski of which three widths are known (m).

    Modelling assumptions:

    - The side line is one parabola (constant curvature to a part in a thousand) through the half widths at the front
      end, the middle and the rear end of the sidecut length. With tip and tail unlike, the ski is narrowest a little
      behind the middle, by `narrowing` less than the waist.
    - In front of the sidecut length the outline closes with a quarter ellipse, cut off at ``end_width``.
    - Behind the sidecut length it runs straight.

    Attributes
    ----------
    layout
        Of the ski.
    tip_width, waist_width, tail_width
        At the front end, the middle and the rear end of the sidecut length.
    end_width
        At the very tip; None: 20 % of the tip width.
    """

    layout: Layout
    tip_width: float
    waist_width: float
    tail_width: float
    end_width: float | None = None

    def width_at(self, station: FloatArray) -> FloatArray:
        """Width (m) at stations (m) between tip and tail."""
        front, rear = self.layout.widest_points
        share = (np.clip(station, rear, front) - self.layout.middle) / self.layout.sidecut_length
        taper = self.tip_width - self.tail_width
        side = self.waist_width + taper * share + 2.0 * self._deepening * share**2
        overhang = self.layout.tip - front
        if overhang <= 0:
            return side
        beyond = np.clip((station - front) / overhang, 0.0, 1.0)
        end = TIP_END_SHARE if self.end_width is None else self.end_width / self.tip_width
        return np.asarray(side * np.sqrt(1.0 - (1.0 - end**2) * beyond**2))

    @property
    def _deepening(self) -> float:
        return self.tip_width + self.tail_width - 2.0 * self.waist_width

    @property
    def narrowing(self) -> float:
        """How much narrower than the waist the narrowest place is (m): (tip - tail)²/(8 (tip + tail - 2 waist)).

        >>> from .layout import layout_of_lengths
        >>> layout = layout_of_lengths(length=1.593, running_length=1.396, sidecut_length=1.458)
        >>> slalom = ArcOutline(layout=layout, tip_width=0.116, waist_width=0.068, tail_width=0.101)
        >>> round(slalom.narrowing * 1e3, 2)  # mm
        0.35
        """
        taper = self.tip_width - self.tail_width
        return taper**2 / (8.0 * self._deepening) if self._deepening > 0 else 0.0
