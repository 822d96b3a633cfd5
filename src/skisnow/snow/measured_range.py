"""The range in which a relation was measured, the warning outside it, and the relations of penetrometers.

Outside its range a relation is computed and the reader is warned; nothing is clipped.
"""

from __future__ import annotations

import threading
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, TypeVar

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import RangeWarning
from .._support.messages import Message, template
from .published import calonne_2020, king_2020, proksch_2015

T = TypeVar("T")
_OUTSIDE: Final = template(
    "{relation}: {quantity} {value:.4g} {unit} is outside the {lowest:.4g} to {highest:.4g} {unit} that were measured "
    "({source}); computed all the same"
)
_OUTSIDE_WITHOUT_UNIT: Final = template(
    "{relation}: {quantity} {value:.4g} is outside the {lowest:.4g} to {highest:.4g} that were measured ({source}); "
    "computed all the same"
)
_ONE_AT_A_TIME: Final = threading.RLock()
"""Lock for the warning filters, which are a setting of the whole process."""


@dataclass(frozen=True, slots=True)
class MeasuredRange:
    """Measured range of one quantity, with its source.

    quantity: The quantity in words.
    lowest, highest: Ends of the range, in SI.
    unit, unit_factor: The unit that the warning prints, and its size in SI.
    source: Who measured it.
    """

    quantity: str
    lowest: float
    highest: float
    unit: str
    unit_factor: float
    source: str

    def warn_outside(self, value: npt.ArrayLike, relation: str, *, stacklevel: int = 2) -> None:
        """Issue one `RangeWarning` if any of the values (SI) is outside; NaN does not count as outside.

        value: Input of the relation, scalar or array.
        relation: The relation's name, for the message.
        stacklevel: As for `warnings.warn`, counted from the caller of this method.

        Examples
        --------
        >>> import warnings
        >>> angles = MeasuredRange("edge angle", 0.0, 1.0, "rad", 1.0, "a test")
        >>> with warnings.catch_warnings(record=True) as caught:
        ...     warnings.simplefilter("always")
        ...     angles.warn_outside([0.5, 1.25], "a law")
        >>> print(caught[0].message)
        a law: edge angle 1.25 rad is outside the 0 to 1 rad that were measured (a test); computed all the same
        """
        values = np.asarray(value, float)
        outside = values[(values < self.lowest) | (values > self.highest)]
        if outside.size == 0:
            return
        # the value that lies farthest out speaks for an array
        farthest = outside[np.argmax(np.maximum(self.lowest - outside, outside - self.highest))]
        message = Message(
            _OUTSIDE if self.unit else _OUTSIDE_WITHOUT_UNIT,
            relation=relation,
            quantity=self.quantity,
            value=float(farthest) / self.unit_factor,
            unit=self.unit,
            lowest=self.lowest / self.unit_factor,
            highest=self.highest / self.unit_factor,
            source=self.source,
        )
        warnings.warn(RangeWarning(message).tag("outside_measured"), stacklevel=stacklevel + 1)


def with_range_warnings(act: Callable[[], T]) -> tuple[T, tuple[str, ...]]:
    """Result of a function and its range warnings; any other warning is passed on. One thread at a time."""
    with _ONE_AT_A_TIME, warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        value = act()
    for other in caught:
        if not issubclass(other.category, RangeWarning):
            warnings.warn_explicit(other.message, other.category, other.filename, other.lineno)
    return value, tuple(warning.message.message for warning in caught if isinstance(warning.message, RangeWarning))


@contextmanager
def without_range_warnings() -> Iterator[None]:
    """Suppress range warnings inside the block. One thread at a time."""
    with _ONE_AT_A_TIME, warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        yield


@dataclass(frozen=True, slots=True)
class PenetrometerRelation:
    """Published relation of density and surface area to median force F (N) and element size L (m) of windows.

    source: the publication in short.
    window: length of the windows that it was fitted with (m).
    density: coefficients of ρ, see `density_of_form` of Proksch and others (2015).
    specific_surface_area: SSA (m²/kg) of F and L, or None.

    >>> laws, F, L = PENETROMETER_RELATIONS.values(), np.array(2.0), np.array(0.5e-3)
    >>> [round(float(law.snow_density(F, L)), 3) for law in laws]
    [364.529, 349.502, 288.843, 287.291]
    """

    source: str
    window: float
    density: tuple[float, float, float, float]
    specific_surface_area: Callable[[FloatArray, FloatArray], FloatArray] | None = None

    def snow_density(self, median_force: FloatArray, element_size: FloatArray) -> FloatArray:
        """Snow density ρ (kg/m³) from the median force F (N) and the element size L (m)."""
        return proksch_2015.density_of_form(self.density, median_force, element_size)


PENETROMETER_RELATIONS: Final[Mapping[str, PenetrometerRelation]] = MappingProxyType(
    {
        "proksch-2015": PenetrometerRelation(
            proksch_2015.SOURCE, proksch_2015.WINDOW, proksch_2015.DENSITY, proksch_2015.specific_surface_area
        ),
        "calonne-2020": PenetrometerRelation(
            calonne_2020.SOURCE, calonne_2020.WINDOW, calonne_2020.DENSITY, calonne_2020.specific_surface_area
        ),
        "king-2020a": PenetrometerRelation(king_2020.SOURCE, king_2020.WINDOW, king_2020.DENSITY_A),
        "king-2020b": PenetrometerRelation(king_2020.SOURCE, king_2020.WINDOW, king_2020.DENSITY_B),
    }
)
"""By name. A further relation is one more publication's file and its entry here."""
