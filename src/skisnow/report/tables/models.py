"""The nine candidate models: their table, the tests between them, and the fit with errors in depth beside it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...estimate.models import MODELS
from ...snow.published.moessner_2013 import PRINTED_RMSE_N
from ..table import ROWS_IN_HTML, Column, Table

if TYPE_CHECKING:
    from ..report_data import Json, ReportData

COEFFICIENTS = ("a0", "a1", "b0", "b1")
_UNIT_NOTE = (
    "a = a_0 + a_1 ϑ and b = b_0 + b_1 ϑ with F in N, A in mm², V in mm³, ϑ in rad, H_e in N/mm, H_A in N/mm², H_V in "
    "N/mm³: with H_e, H_A, H_V in this order a_0 is in 1/mm, 1, mm and b_0 in 1/mm², 1/mm, 1."
)


def law(model_id: str) -> str:
    """The law of a row in symbols.

    >>> law("H_V:a=none,b=linear"), law("H_V:a=none,b=one"), law("H_A:a=constant,b=constant")
    ('H_V (b_0 + b_1 ϑ) V', 'H_V V', 'H_A (a_0 A + b_0 V)')
    """
    hardness, forms = _forms(model_id)
    parts = [part for part in (_term("a", forms["a"], "A"), _term("b", forms["b"], "V")) if part]
    return f"{hardness} {parts[0]}" if len(parts) == 1 else f"{hardness} ({' + '.join(parts)})"


def _term(letter: str, form: str, measure: str) -> str:
    terms = {"none": "", "one": measure, "constant": f"{letter}_0 {measure}"}
    return terms.get(form, f"({letter}_0 + {letter}_1 ϑ) {measure}")


def row_name(model_id: str) -> str:
    """A row in a few words, for tables and sentences."""
    return next(model.words for model in MODELS if model.id == model_id)


def _forms(model_id: str) -> tuple[str, dict[str, str]]:
    hardness, _, terms = model_id.partition(":")
    return hardness, dict(part.split("=") for part in terms.split(","))


def models_table(data: ReportData) -> Table:
    """The nine candidate models with the paper's printed rmse beside each."""
    found = data.results["penetration"]
    chosen = found["selected"]["id"] if found["selected"] else None
    columns = (
        Column("row", "Model", "words"),
        Column("selected", "sel.", "tick"),
        *(Column(name, f"{name[0]}_{name[1]}", "estimate") for name in COEFFICIENTS),
        Column("at_bound", "on its bound", "codes"),
        Column("n_parameters", "fitted", "count"),
        Column("rmse_N", "RMSE with 1/n", unit="N", digits=4),
        Column("rmse_dof_N", "RMSE with 1/(n − p)", unit="N", digits=4),
        Column("rmse_free_N", "RMSE without the defining reading", unit="N", digits=4),
        Column("printed_rmse_N", "paper, printed", unit="N"),
    )
    rows = [
        (
            row_name(row["id"]),
            row["id"] == chosen,
            *_coefficients(row),
            row["at_bound"],
            row["n_parameters"],
            row["rmse_N"],
            row["rmse_dof_N"],
            row["rmse_free_N"],
            PRINTED_RMSE_N.get(row["id"]),
        )
        for row in found["models"]
        if row["n"]
    ]
    return Table(
        "models",
        "The nine candidate models F = H (a(ϑ) A + b(ϑ) V) of the penetration force (Eqn 6), with 95 % intervals from "
        "resampling whole experiments, and the rmse printed by Mössner and others (2013).",
        columns,
        rows,
        note=_UNIT_NOTE + " b = 1 is fixed, not fitted. The paper's own data are not "
        "public: its rmse are for its snow and its loads, not a target for others.",
        rows_in_html=_rows_in_html(data),
    )


def _rows_in_html(data: ReportData) -> int:
    """None where no law is selected: the rows are in the table's file, and say nothing to a reader."""
    return ROWS_IN_HTML if data.results["penetration"]["selected"] else 0


def _coefficients(row: Json) -> list[tuple[float | None, Any]]:
    """Value and interval; nothing for a term that the row does not have, 1 without interval for b = 1."""
    return [(row[name] if _has(row, name) else None, row["intervals"][name]) for name in COEFFICIENTS]


def _has(row: Json, coefficient: str) -> bool:
    form = row[coefficient[0]]
    return form == "linear" if coefficient.endswith("1") else form != "none"


def nested_table(data: ReportData) -> Table:
    """F tests between nested rows."""
    rows = [
        (
            row_name(row["full"]),
            row_name(row["reduced"]),
            row["F"],
            *row["df"],
            row["p"],
            row["rmse_change_percent"],
            row["valid_classically"],
        )
        for row in data.results["penetration"]["tests"]
    ]
    return Table(
        "model_tests",
        "F tests of each simpler law against the fuller one that contains it, and the effect size.",
        (
            Column("full", "Fuller model", "words"),
            Column("reduced", "Simpler model", "words"),
            Column("F", "F"),
            Column("df1", "df 1", "count"),
            Column("df2", "df 2", "count"),
            Column("p", "p", "p"),
            Column("rmse_change_percent", "rmse grows by", unit="%"),
            Column("valid_classically", "F distribution valid", "yes"),
        ),
        rows,
        rows_in_html=_rows_in_html(data),
    )


def errors_in_depth_table(data: ReportData) -> Table:
    """Each law by both procedures, one below the other."""
    found = data.results["penetration"]
    rows = [
        (
            row_name(row["id"]),
            procedure,
            *_coefficients(row),
            row["at_bound"],
            row["rmse_N"],
            row["rmse_free_N"],
        )
        for both in zip(found["models"], found["errors_in_depth"]["models"], strict=True)
        for procedure, row in zip(("the paper's", "errors in depth"), both, strict=True)
        if row["n"]
    ]
    return Table(
        "errors_in_depth",
        "The nine laws by two procedures: the paper's, with H from each series' largest load and all error in the "
        "load; and with errors in depth and load, H estimated from all readings of a series.",
        (
            Column("row", "Model", "words"),
            Column("procedure", "procedure", "words"),
            *(Column(name, f"{name[0]}_{name[1]}", "estimate") for name in COEFFICIENTS),
            Column("at_bound", "on its bound", "codes"),
            Column("rmse_N", "RMSE with 1/n", unit="N", digits=4),
            Column("rmse_free_N", "RMSE without the defining reading", unit="N", digits=4),
        ),
        rows,
        note="No intervals with errors in depth: H of each series comes from the same readings, so a bootstrap of "
        "whole experiments says too little of b; in simulated campaigns it covered b in 7 to 90 %. Both rmse are "
        "unweighted and in force. The second procedure minimises weighted squares and does "
        "not pass through each series' last reading: the two columns of rmse are no race between procedures.",
        rows_in_html=_rows_in_html(data),
    )


def fitted_hardness_table(data: ReportData) -> Table:
    """H_V of each experiment by both procedures."""
    rows = [
        (
            own["experiment"],
            own["site"],
            own["used"],
            (own["H_V_N_per_mm3"], own["H_V_interval_N_per_mm3"]),
            (fitted["H_V_N_per_mm3"], fitted["H_V_interval_N_per_mm3"]),
            fitted["relative_scatter"],
        )
        for own, fitted in zip(
            data.penetration, data.results["penetration"]["errors_in_depth"]["experiments"], strict=True
        )
    ]
    return Table(
        "hardness_by_procedure",
        "H_V of each experiment from its largest load (Eqn 1) and from all its readings with errors in depth and load.",
        (
            Column("experiment", "Experiment", "text"),
            Column("site", "Site", "text"),
            Column("used", "used", "yes"),
            Column("H_V_N_per_mm3", "H_V, largest load", "estimate", "N/mm³"),
            Column("H_V_fitted_N_per_mm3", "H_V, all readings", "estimate", "N/mm³"),
            Column("relative_scatter", "relative scatter s"),
        ),
        rows,
        rows_in_html=0,
    )
