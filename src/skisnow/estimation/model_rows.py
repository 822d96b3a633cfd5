"""The nine candidate models in results.json: their rows, the F tests between them, which was chosen and why."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.units import MM2, MM3
from .hardness import DEFINITIONS
from .models import MODELS

if TYPE_CHECKING:
    from .model_choice import NestedRows
    from .models import Model, ModelFit
    from .parts import ModelTable, PenetrationAnalysis

FloatArray = npt.NDArray[np.float64]
Json: TypeAlias = dict[str, Any]

_SAME_PERCENT: Final = 0.005
"""Rmse that differ by less are reported as the same."""


def model_rows(table: ModelTable | None) -> list[Json]:
    """The rows ``penetration.models``: the nine candidate models, without numbers where there are no data."""
    if table is None:
        return _no_models()
    return [_model(fit, table.intervals.get(fit.model)) for fit in table.fits]


def _model_head(model: Model) -> Json:
    return {"id": model.id, "hardness": model.hardness, "a": model.a, "b": model.b}


def _no_models() -> list[Json]:
    nothing = dict.fromkeys(("a0", "a1", "b0", "b1"))
    return [
        _model_head(model)
        | nothing
        | {"n": 0, "n_series": 0, "n_parameters": model.n_parameters}
        | {"rmse_N": None, "rmse_dof_N": None, "rmse_free_N": None, "at_bound": [], "intervals": dict(nothing)}
        for model in MODELS
    ]


def _model(fit: ModelFit, intervals: FloatArray | None) -> Json:
    """A row in the units of the table: A in mm², V in mm³, H in N/mm, N/mm² or N/mm³."""
    si = DEFINITIONS[fit.model.hardness].si
    factor_a, factor_b = si * MM2, si * MM3
    factors = {"a0": factor_a, "a1": factor_a, "b0": factor_b, "b1": factor_b}
    fitted = _fitted_coefficients(fit.model)
    pairs: dict[str, list[float] | None] = dict.fromkeys(factors)
    if intervals is not None:
        for index, (name, factor) in enumerate(factors.items()):
            pairs[name] = (intervals[index] * factor).tolist() if name in fitted else None
    return (
        _model_head(fit.model)
        | {name: getattr(fit, name) * factor for name, factor in factors.items()}
        | {
            "n": fit.n,
            "n_series": fit.n_series,
            "n_parameters": fit.n_parameters,
            "rmse_N": fit.rmse,
            "rmse_dof_N": fit.rmse_dof,
            "rmse_free_N": fit.rmse_free,
            "at_bound": list(fit.at_bound),
            "intervals": pairs,
        }
    )


def _fitted_coefficients(model: Model) -> set[str]:
    fitted = set()
    for name, term in (("a", model.a), ("b", model.b)):
        if term in ("constant", "linear"):
            fitted.add(f"{name}0")
        if term == "linear":
            fitted.add(f"{name}1")
    return fitted


def nested_row(row: NestedRows) -> Json:
    """A row of ``penetration.tests``: the F test of a model against one that it contains."""
    return {
        "full": row.full.id,
        "reduced": row.reduced.id,
        "F": row.F,
        "df": [row.df1, row.df2],
        "p": row.p,
        "rmse_change_percent": row.rmse_change_percent,
        "valid_classically": row.valid_classically,
    }


def selected_model(found: PenetrationAnalysis) -> Json | None:
    """``penetration.selected``: the id of the chosen model, and why it was chosen."""
    if found.selected is None or found.table is None:
        return None
    best = min(found.table.fits, key=lambda fit: fit.rmse)
    chosen = found.selected
    return {"id": chosen.model.id, "reason": _reason(chosen, best)}


def _reason(chosen: ModelFit, best: ModelFit) -> str:
    if chosen.model == best.model:
        return (
            f"The smallest rmse of the nine candidate models, {chosen.rmse:.4g} N; no model with fewer fitted "
            f"parameters ({chosen.n_parameters} here) comes within 5 % of it."
        )
    more = 100.0 * (chosen.rmse / best.rmse - 1.0) if best.rmse > 0 else 0.0
    return (
        f"The simplest of the nine candidate models whose rmse is within 5 % of the best: {chosen.rmse:.4g} N "
        f"with fitted parameters: {chosen.n_parameters}, against {best.rmse:.4g} N of "
        f"{best.model.id} with {best.n_parameters}, "
        f"{f'{more:.2g} % more' if more >= _SAME_PERCENT else 'which is the same'}."
    )
