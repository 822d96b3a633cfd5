"""What is so far off in the fitted laws that a number alone would be passed over."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy.typing as npt

    from .models import ModelFit

POOR: Final = 0.5
"""A selected law whose rmse is above this share of the loads' rms leaves a quarter of their squares open (modelling
assumption)."""
_DEPTH: Final = " with errors in depth"
_ACTION: Final = "Look for wrong units, depths or tools, and for snow that follows none of these laws."


def fit_warnings(
    fits: tuple[ModelFit, ...], selected: ModelFit | None, in_depth: tuple[ModelFit, ...], load: npt.NDArray[np.float64]
) -> tuple[str, ...]:
    """Sentences about rows that miss the loads (N) by more than the loads themselves, and a poor selected row."""
    size = float(np.sqrt(np.mean(load**2)))
    return (*_poor(selected, size), *_worse_than_nothing(fits, "", size), *_worse_than_nothing(in_depth, _DEPTH, size))


def _poor(selected: ModelFit | None, size: float) -> Iterator[str]:
    if selected is not None and POOR * size < selected.rmse <= size:
        yield (
            f"Even the selected law misses the loads by {100.0 * selected.rmse / size:.0f} % of their root mean square "
            f"({selected.rmse:.4g} N of {size:.4g} N). {_ACTION}"
        )


def _worse_than_nothing(fits: tuple[ModelFit, ...], how: str, size: float) -> Iterator[str]:
    rows = [fit for fit in fits if fit.rmse > size]
    if rows:
        worst = max(rows, key=lambda fit: fit.rmse)
        yield (
            f"{len(rows)} of the nine candidate models{how} {'misses' if len(rows) == 1 else 'miss'} the loads by more "
            f"than their root mean square, {size:.4g} N; the rmse of {worst.model.words} is {worst.rmse:.5g} N. "
            f"No force at all would describe the readings better. {_ACTION}"
        )
