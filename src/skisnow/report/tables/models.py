"""The nine rival laws: their table, the tests between them, and the fit with errors in depth beside it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...snow.published.moessner_2013 import PRINTED_RMSE_N
from ..table import Column, Table

if TYPE_CHECKING:
    from ..material import Json, Material

COEFFICIENTS = ("a0", "a1", "b0", "b1")
_UNIT_NOTE = (
    "F in N, A in mm², V in mm³, ϑ in rad, H_e in N/mm, H_A in N/mm², H_V in N/mm³; so a_0 is in mm/mm², 1 or mm and "
    "b_0 in mm/mm³, 1/mm or 1 with H_e, H_A, H_V, the slopes a_1, b_1 the same per rad."
)


def law(model_id: str) -> str:
    """The law of a row in symbols.

    >>> law("H_V:a=none,b=linear"), law("H_V:a=none,b=one"), law("H_A:a=constant,b=constant")
    ('H_V (b_0 + b_1 ϑ) V', 'H_V V', 'H_A (a_0 A + b_0 V)')
    """
    hardness, _, terms = model_id.partition(":")
    forms = dict(part.split("=") for part in terms.split(","))
    parts = [part for part in (_term("a", forms["a"], "A"), _term("b", forms["b"], "V")) if part]
    return f"{hardness} {parts[0]}" if len(parts) == 1 else f"{hardness} ({' + '.join(parts)})"


def _term(letter: str, form: str, measure: str) -> str:
    terms = {"none": "", "one": measure, "constant": f"{letter}_0 {measure}"}
    return terms.get(form, f"({letter}_0 + {letter}_1 ϑ) {measure}")


def models_table(material: Material) -> Table:
    """The nine rows with the paper's printed rmse beside each."""
    found = material.results["penetration"]
    chosen = found["selected"]["id"] if found["selected"] else None
    columns = (
        Column("id", "Law F =", "words"),
        Column("selected", "selected", "yes"),
        *(Column(name, f"{name[0]}_{name[1]}", "estimate") for name in COEFFICIENTS),
        Column("at_bound", "on its bound", "codes"),
        Column("n_parameters", "fitted", "count"),
        Column("rmse_N", "rmse over n", unit="N", digits=4),
        Column("rmse_dof_N", "over n − p", unit="N", digits=4),
        Column("rmse_free_N", "over free points", unit="N", digits=4),
        Column("printed_rmse_N", "paper, printed", unit="N"),
    )
    rows = [
        (
            law(row["id"]),
            row["id"] == chosen,
            *_coefficients(row),
            row["at_bound"],
            row["n_parameters"],
            row["rmse_N"],
            row["rmse_dof_N"],
            row["rmse_free_N"],
            PRINTED_RMSE_N[row["id"]],
        )
        for row in found["models"]
        if row["n"]
    ]
    return Table(
        "models",
        "The nine rival laws of the penetration force (Eqn 6), with 95 % intervals from resampling whole experiments, "
        "beside the rmse printed by Mössner and others (2013).",
        columns,
        rows,
        note=_UNIT_NOTE + " A coefficient without an interval is fixed, not fitted. The paper's own data are not "
        "public: its rmse are for its snow and its loads, not a target for others.",
    )


def _coefficients(row: Json) -> list[tuple[float | None, Any]]:
    return [(row[name], row["intervals"][name]) for name in COEFFICIENTS]


def nested_table(material: Material) -> Table:
    """F tests between nested rows."""
    rows = [
        (
            law(row["full"]),
            law(row["reduced"]),
            row["F"],
            *row["df"],
            row["p"],
            row["rmse_change_percent"],
            row["valid_classically"],
        )
        for row in material.results["penetration"]["tests"]
    ]
    return Table(
        "model_tests",
        "F tests of each simpler law against the fuller one that contains it, and the effect size.",
        (
            Column("full", "Fuller law", "words"),
            Column("reduced", "Simpler law", "words"),
            Column("F", "F"),
            Column("df1", "df 1", "count"),
            Column("df2", "df 2", "count"),
            Column("p", "p", "p"),
            Column("rmse_change_percent", "rmse grows by", unit="%"),
            Column("valid_classically", "F distribution holds", "yes"),
        ),
        rows,
    )


def errors_in_depth_table(material: Material) -> Table:
    """Each law by both procedures, one below the other."""
    found = material.results["penetration"]
    rows = [
        (
            law(row["id"]),
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
            Column("id", "Law F =", "words"),
            Column("procedure", "procedure", "words"),
            *(Column(name, f"{name[0]}_{name[1]}", "estimate") for name in COEFFICIENTS),
            Column("at_bound", "on its bound", "codes"),
            Column("rmse_N", "rmse over n", unit="N", digits=4),
            Column("rmse_free_N", "over free points", unit="N", digits=4),
        ),
        rows,
        note="Both rmse are unweighted and in force. The second procedure minimises weighted squares, so a larger rmse "
        "there is no worse fit.",
    )


def fitted_hardness_table(material: Material) -> Table:
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
            material.penetration, material.results["penetration"]["errors_in_depth"]["experiments"], strict=True
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
