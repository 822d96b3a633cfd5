"""Tables of the nine candidate models: coefficients, F tests between them, and the fit with errors in depth."""

from __future__ import annotations

from typing import Final

from ..._support.messages import Message, joined
from ...estimation.models import MODELS
from ...snow.published.moessner_2013 import PRINTED_RMSE_N
from ..table import ROWS_IN_HTML, Column, Table, record_table
from .data import Json, ReportData
from .series_tables import EXPERIMENT, SITE, USED

COEFFICIENTS: Final = ("a0", "a1", "b0", "b1")
_COEFFICIENT_COLUMNS: Final = tuple(
    Column(name, f"{name[0]}_{name[1]}", "estimate", interval=f"{name}_interval") for name in COEFFICIENTS
)
_MODEL: Final = Column("row", Message("Model"), "words")
_RMSE: Final = Column("rmse_N", Message("RMSE with 1/n"), unit="N", digits=4)
_RMSE_FREE: Final = Column("rmse_free_N", Message("RMSE without the defining reading"), unit="N", digits=4)
_AT_BOUND: Final = Column("at_bound", Message("on its bound"), "codes")
_UNIT_NOTE: Final = Message(
    "a = a_0 + a_1 ϑ and b = b_0 + b_1 ϑ with F in N, A in mm², V in mm³, ϑ in rad, H_e in N/mm, H_A in N/mm², H_V in "
    "N/mm³: with H_e, H_A, H_V in this order a_0 is in 1/mm, 1, mm and b_0 in 1/mm², 1/mm, 1."
)


def formula(model_id: str) -> str:
    """Right-hand side of a candidate model in symbols.

    >>> formula("H_V:a=none,b=linear"), formula("H_V:a=none,b=one"), formula("H_A:a=constant,b=constant")
    ('H_V (b_0 + b_1 ϑ) V', 'H_V V', 'H_A (a_0 A + b_0 V)')
    """
    hardness, _, terms = model_id.partition(":")
    forms = dict(term.split("=") for term in terms.split(","))
    parts = [part for part in (_term_text("a", forms["a"], "A"), _term_text("b", forms["b"], "V")) if part]
    return f"{hardness} {parts[0]}" if len(parts) == 1 else f"{hardness} ({' + '.join(parts)})"


def _term_text(letter: str, form: str, measure: str) -> str:
    """Term of a model's formula: `letter` is its coefficient, `measure` what this multiplies; "" for none."""
    terms = {"none": "", "one": measure, "constant": f"{letter}_0 {measure}"}
    return terms.get(form, f"({letter}_0 + {letter}_1 ϑ) {measure}")


def model_name(model_id: str) -> str:
    """Words for the candidate model with this id; StopIteration if it is unknown."""
    return next(model.words for model in MODELS if model.id == model_id)


def models_table(data: ReportData) -> Table:
    """Table of the nine candidate models with their rmse, next to that of the paper."""
    penetration = data.results["penetration"]
    selected_id = penetration["selected"]["id"] if penetration["selected"] else None
    columns = (
        _MODEL,
        Column("selected", Message("sel."), "tick"),
        *_COEFFICIENT_COLUMNS,
        _AT_BOUND,
        Column("n_parameters", Message("fitted"), "count"),
        _RMSE,
        Column("rmse_dof_N", Message("RMSE with 1/(n − p)"), unit="N", digits=4),
        _RMSE_FREE,
        Column("printed_rmse_N", Message("paper, printed"), unit="N"),
    )
    note = Message(
        "b = 1 is fixed, not fitted. The paper's own data are not public: its rmse are for its snow and its loads, not "
        "a target for others."
    )
    records = [
        _model_record(row) | {"selected": row["id"] == selected_id, "printed_rmse_N": PRINTED_RMSE_N.get(row["id"])}
        for row in penetration["models"]
        if row["n"]
    ]
    return record_table(
        "models",
        Message(
            "The nine candidate models F = H (a(ϑ) A + b(ϑ) V) of the penetration force (Eqn 6), with 95 % intervals "
            "from resampling whole experiments, and the rmse printed by Mössner and others (2013)."
        ),
        columns,
        records,
        note=joined([_UNIT_NOTE, note]),
        rows_in_html=_rows_in_html(data),
    )


def _rows_in_html(data: ReportData) -> int:
    """Maximum number of rows of a model table in HTML: 0 without a selected model, so that only its file has them."""
    return ROWS_IN_HTML if data.results["penetration"]["selected"] else 0


def _model_record(row: Json) -> Json:
    """Row of the results with the model in words and intervals by coefficient; None for one that it does not have."""
    forms = {"0": ("one", "constant", "linear"), "1": ("linear",)}
    values = {name: row[name] if row[name[0]] in forms[name[1]] else None for name in COEFFICIENTS}
    intervals = {f"{name}_interval": row["intervals"][name] for name in COEFFICIENTS}
    return row | {"row": model_name(row["id"])} | values | intervals


def nested_table(data: ReportData) -> Table:
    """Table of the F tests between nested models: fuller and simpler one, F, degrees of freedom, p."""
    records = [
        row
        | {"full": model_name(row["full"]), "reduced": model_name(row["reduced"])}
        | {"df1": row["df"][0], "df2": row["df"][1]}
        for row in data.results["penetration"]["tests"]
    ]
    columns = (
        Column("full", Message("Fuller model"), "words"),
        Column("reduced", Message("Simpler model"), "words"),
        Column("F", "F"),
        Column("df1", Message("df 1"), "count"),
        Column("df2", Message("df 2"), "count"),
        Column("p", "p", "p"),
        Column("rmse_change_percent", Message("rmse grows by"), unit="%"),
        Column("valid_classically", Message("F distribution valid"), "yes"),
    )
    caption = Message("F tests of each simpler law against the fuller one that contains it, and the effect size.")
    return record_table("model_tests", caption, columns, records, rows_in_html=_rows_in_html(data))


def errors_in_depth_table(data: ReportData) -> Table:
    """Table of each model fitted by both procedures, one below the other."""
    penetration = data.results["penetration"]
    procedure_column = Column("procedure", Message("procedure"), "words")
    procedures = Message("the paper's"), Message("errors in depth")
    records = [
        _model_record(row) | {"procedure": procedure}
        for fits in zip(penetration["models"], penetration["errors_in_depth"]["models"], strict=True)
        for procedure, row in zip(procedures, fits, strict=True)
        if row["n"]
    ]
    return record_table(
        "errors_in_depth",
        Message(
            "The nine laws by two procedures: the paper's, with H from each series' largest load and all error in the "
            "load; and with errors in depth and load, H estimated from all readings of a series."
        ),
        (_MODEL, procedure_column, *_COEFFICIENT_COLUMNS, _AT_BOUND, _RMSE, _RMSE_FREE),
        records,
        note=Message(
            "No intervals with errors in depth: H of each series comes from the same readings, so a bootstrap of whole "
            "experiments says too little of b; in simulated campaigns it covered b in 7 to 90 %. Both rmse are "
            "unweighted and in force. The second procedure minimises weighted squares and does not pass through each "
            "series' last reading: the two columns of rmse do not rank the procedures."
        ),
        rows_in_html=_rows_in_html(data),
    )


def fitted_hardness_table(data: ReportData) -> Table:
    """Table of H_V of each experiment by both procedures."""
    fits = data.results["penetration"]["errors_in_depth"]["experiments"]
    records = [
        row
        | {
            "H_V_fitted_N_per_mm3": fit["H_V_N_per_mm3"],
            "fitted_interval": fit["H_V_interval_N_per_mm3"],
            "relative_scatter": fit["relative_scatter"],
        }
        for row, fit in zip(data.penetration, fits, strict=True)
    ]
    columns = (
        EXPERIMENT,
        SITE,
        USED,
        Column("H_V_N_per_mm3", Message("H_V, largest load"), "estimate", "N/mm³", interval="H_V_interval_N_per_mm3"),
        Column("H_V_fitted_N_per_mm3", Message("H_V, all readings"), "estimate", "N/mm³", interval="fitted_interval"),
        Column("relative_scatter", Message("relative scatter s")),
    )
    caption = Message(
        "H_V of each experiment from its largest load (Eqn 1) and from all its readings with errors in depth and load."
    )
    return record_table("hardness_by_procedure", caption, columns, records, rows_in_html=0)
