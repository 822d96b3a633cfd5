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
_ACTION: Final = "Look for wrong units, depths or tools, and for snow that follows none of these laws."


def fit_warnings(
    fits: tuple[ModelFit, ...], selected: ModelFit | None, load: npt.NDArray[np.float64]
) -> tuple[str, ...]:
    """Sentence about a selected model that misses the loads (N), or about all models where none fits them."""
    size = float(np.sqrt(np.mean(load**2)))
    if fits and all(fit.rmse > size for fit in fits):
        return tuple(_all_fail(fits, size))
    return tuple(_poor(selected, size))


def _poor(selected: ModelFit | None, size: float) -> Iterator[str]:
    if selected is not None and selected.rmse > POOR * size:
        yield (
            f"Even the selected law misses the loads by {100.0 * selected.rmse / size:.0f} % of their root mean square "
            f"({selected.rmse:.4g} N of {size:.4g} N). {_ACTION}"
        )


def _all_fail(fits: tuple[ModelFit, ...], size: float) -> Iterator[str]:
    best = min(fits, key=lambda fit: fit.rmse)
    yield (
        f"All candidate models miss the loads by more than their root mean square, {size:.4g} N; the smallest rmse is "
        f"{best.rmse:.5g} N, of {best.model.words}. No force at all would describe the readings better. {_ACTION}"
    )
