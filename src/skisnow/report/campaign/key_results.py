"""Key results of a campaign as sentences in HTML: hardness, shear stress, law, relations."""

from __future__ import annotations

from operator import itemgetter
from typing import Any, Final

from markupsafe import Markup

from ..._support.messages import Message, template
from ...estimation.comparisons import FEWEST_SITES
from ...estimation.regressions import FEWEST_VALUES
from ..formatting import counted, html, interval, p_equals, prose, significant, whole
from .data import Json, ReportData, UsedTests
from .model_tables import formula, model_name
from .tables import QUANTITY

SIGNIFICANT: Final = 0.05
LISTED: Final = 12


def key_results(data: ReportData) -> list[Markup]:
    """Key results of a campaign: one sentence in HTML for each available result."""
    sentences: list[Markup | None] = []
    if data.penetration:
        n = counted(len(data.penetration), "{count} penetration experiment", "{count} penetration experiments")
        name = Message("Snow hardness H_V: geometric mean")
        sentences.append(_mean_sentence(data, data.pressed, "H_V_N_per_mm3", n, name=name))
    if data.shear:
        n = counted(len(data.shear), "{count} shear experiment", "{count} shear experiments")
        name = Message("Failure shear stress S_f: mean")
        sentences.append(_mean_sentence(data, data.sheared, "S_f_N_per_mm2", n, name=name))
    others = (_unloading_sentence, _displacement_sentence, _sentence_by_relation, _law_sentence, _relations_sentence)
    sentences += [build(data) for build in others]
    return [sentence for sentence in sentences if sentence is not None]


def headline(data: ReportData) -> Markup:
    """Sentence with mean H_V, or S_f without H_V, and its interval; empty without either, or with several sites."""
    for key, sentence in (
        ("H_V_N_per_mm3", template("Snow hardness H_V {value}, {ends}, over {sites}.")),
        ("S_f_N_per_mm2", template("Failure shear stress S_f {value}, {ends}, over {sites}.")),
    ):
        row, unit = own_value(data, key), QUANTITY[key][1]
        sites = {mean["site"] for mean in data.results["site_means"] if mean["quantity"] == key}
        if row is not None and len(sites) <= 1:
            ends: str = Message("without an interval")
            if row["own_interval"] is not None:
                ends = Message("95 % interval {ends} {unit}", ends=interval(row["own_interval"]), unit=unit)
            value = Markup("<strong>{} {}</strong>").format(significant(row["own"]), unit)
            return prose(sentence, value=value, ends=ends, sites=counted(len(sites), "{count} site", "{count} sites"))
        if row is not None:
            break
    return Markup("")


def own_value(data: ReportData, quantity: str) -> Json | None:
    """Entry of the results with mean, interval and range of a quantity in this campaign; None without a value."""
    rows = (row for row in data.results["comparisons"] if row["quantity"] == quantity and row["own"] is not None)
    return next(rows, None)


def _unloading_sentence(data: ReportData) -> Markup | None:
    """Sentence with the unloading ratio over all sites; None without unloaded series."""
    rows = data.results["penetration"]["unloading"]
    if not rows:
        return None
    row = rows[-1]
    if row["unloading_ratio_interval"] is None:
        upper_rebound, bound = (row["rebound_ratio_interval"] or (0.0, 0.0))[1], prose("not resolved")
        if upper_rebound > 0:
            bound = prose("above {lower}", lower=significant(1.0 / upper_rebound))
        return prose("Unloading ratio k_u / H_V: {bound}, from {n} series.", bound=bound, n=whole(row["n"]))
    return prose(
        "Unloading ratio k_u / H_V {value} (95 % interval {ends}), from {n} series that were unloaded step by step.",
        value=_strong(row["unloading_ratio"]),
        ends=interval(row["unloading_ratio_interval"]),
        n=whole(row["n"]),
    )


def _displacement_sentence(data: ReportData) -> Markup | None:
    """Sentence with the mean shear displacement u_y (mm) of the last group; None if none was measured."""
    rows = data.results["shear"]["displacement"]
    if not rows:
        return None
    row = rows[-1]
    ends = row["shear_displacement_interval_mm"]
    return prose(
        "Shear displacement u_y: geometric mean {value} mm{ends}, from {n} with turning angles.",
        value=_strong(row["shear_displacement_mm"]),
        ends="" if ends is None else prose(" (95 % interval {pair} mm)", pair=interval(ends)),
        n=counted(row["n"], "{count} shear experiment", "{count} shear experiments"),
    )


def _sentence_by_relation(data: ReportData) -> Markup | None:
    """Sentence with each site's density, and its hardness and S_f by relations; None if there are plate tests."""
    rows = data.results.get("published_relations")
    if not rows:
        return None
    outside = Message("outside of its range at each site")
    return prose(
        "By published relations, not by plate tests: hardness {hardness}; shear strength S_f {stresses}. Density: "
        "{densities}. No relation gives H_V.",
        hardness=Markup("; ").join(map(_hardness_by_relation, rows)),
        densities=_values_at_sites(rows, "snow_density_kg_per_m3", "kg/m³"),
        stresses=_values_at_sites(rows, "S_f_N_per_mm2", "N/mm²") or outside,
    )


def _hardness_by_relation(row: Json) -> Markup:
    """Part of a sentence: a site's penetration resistance if recorded, hand hardness, and name of its relation."""
    resistance, index = row["penetration_resistance_kPa"], row["hand_hardness_index"]
    if resistance is None and index is None:
        sentence = template("{site} outside of its range ({relation})")
    elif resistance is None:
        sentence = template("{site} hand hardness {code}, index {index} ({relation})")
    elif index is None:
        sentence = template("{site} {resistance} kPa of the SnowMicroPen, no hand hardness for it ({relation})")
    else:
        sentence = template(
            "{site} {resistance} kPa of the SnowMicroPen, hand hardness {code}, index {index} ({relation})"
        )
    return prose(
        sentence,
        site=row["site"],
        resistance="" if resistance is None else _strong(resistance),
        code=Markup("<strong>{}</strong>").format(row["hand_hardness"]),
        index="" if index is None else significant(index),
        relation=row["hardness_relation"],
    )


def _values_at_sites(rows: list[Json], key: str, unit: str) -> Markup:
    """Sites with their values of a key in `unit`; sites without a value are left out."""
    values = [Markup("{} {} {}").format(row["site"], _strong(row[key]), unit) for row in rows if row[key] is not None]
    return Markup("; ").join(values)


def _mean_sentence(data: ReportData, tests: UsedTests, key: str, experiments: str, *, name: str) -> Markup:
    """Sentence with mean H_V or S_f: at the only site, at each of few sites, or at the softest and hardest of many."""
    row, (symbol, unit) = own_value(data, key), QUANTITY[key]
    if row is None:
        return prose("None of the {n} can be used, so there is no {symbol}.", n=experiments, symbol=html(symbol))
    means = [mean for mean in data.results["site_means"] if mean["quantity"] == key and mean["mean"] is not None]
    low, high = map(significant, row["own_range"])
    fields: dict[str, Any] = {"mean_name": html(name), "unit": unit, "low": low, "high": high}
    fields["sites"] = counted(len(means), "{count} site", "{count} sites")
    fields["used"] = Message("{used} of {n} used", used=whole(len(tests)), n=experiments)
    if len(means) <= 1:
        return prose(
            "{mean_name} {value} {unit}{ends}, single experiments {low} to {high} {unit}; {used}, at {sites}.",
            value=_strong(row["own"]), ends=_interval_text(row["own_interval"], unit, 1), **fields,
        )  # fmt: skip
    fields["value"] = significant(row["own"])
    if len(means) < FEWEST_SITES:
        words = (
            prose(
                "{site} {value} {unit}{ends}, n = {n}",
                site=mean["site"], value=_strong(mean["mean"]), unit=unit, n=whole(mean["n"]),
                ends=_interval_text(mean["interval"], unit, 1),
            )
            for mean in means
        )  # fmt: skip
        return prose(
            "{mean_name} of each site: {site_means}; {used}. Over the {sites} together {value} {unit}, without an "
            "interval: fewer than {fewest} sites do not show how sites scatter. Single experiments {low} to {high} "
            "{unit}.",
            site_means=html("; ").join(words), fewest=FEWEST_SITES, **fields,
        )  # fmt: skip
    softest, hardest = (choose(means, key=itemgetter("mean")) for choose in (min, max))
    fields |= {"low": _strong(softest["mean"]), "high": _strong(hardest["mean"])}
    return prose(
        "{mean_name} of each site: from {low} {unit} ({softest}) to {high} {unit} ({hardest}), at {sites}; {used}. "
        "Over all sites {value} {unit}{ends}.",
        softest=softest["site"], hardest=hardest["site"],
        ends=_interval_text(row["own_interval"], unit, len(means)), **fields,
    )  # fmt: skip


def _strong(value: float) -> Markup:
    """Rounded number in bold."""
    return Markup("<strong>{}</strong>").format(significant(value))


def _interval_text(pair: list[float] | None, unit: str, sites: int) -> Markup:
    """95 % interval in parentheses with the kind of its scatter; without one, that the scatter is not known."""
    if pair is None:
        return prose(" (no interval: the scatter is not known)")
    if sites > 1:
        return prose(" (95 % interval {pair} {unit}, from the scatter between sites)", pair=interval(pair), unit=unit)
    return prose(" (95 % interval {pair} {unit}, from the scatter between experiments)", pair=interval(pair), unit=unit)


def _law_sentence(data: ReportData) -> Markup | None:
    """Sentences with the selected law of the penetration force and its reason; None without a choice."""
    selected = data.results["penetration"]["selected"]
    if selected is None:
        return None
    law = Markup("<strong>F = {}</strong>").format(html(formula(selected["id"])))
    models = {row["id"] for row in data.results["penetration"]["models"]}
    reason: Message = selected["reason"]
    fields = {
        key: Message("the row {name}", name=model_name(value)) if value in models else value
        for key, value in reason.fields.items()
    }
    sentences = [
        prose("Selected law of the penetration force: {law}.", law=law),
        html(Message(reason.template, **fields)),
    ]
    if selected["id"] == "H_V:a=none,b=one":
        sentences.append(prose("This is the law that the paper proposes (its Eqn 12)."))
    return Markup(" ").join(sentences)


def _relations_sentence(data: ReportData) -> Markup | None:
    """Sentences listing significant, not significant and withheld regressions; None without any."""
    judged = [row for row in data.results["regressions"] if row["p"] is not None]
    withheld = [row for row in data.results["regressions"] if row["withheld"]]
    if not judged and not withheld:
        return None
    words = template("Relations: significant at 5 %: {yes}; not significant: {no}.")
    if withheld:
        words = template(
            "Relations: significant at 5 %: {yes}; not significant: {no}; not judged, as the predictor takes fewer "
            "than {few} different values: {rows}."
        )
    sentence = prose(
        words,
        yes=_regression_list([row for row in judged if row["p"] < SIGNIFICANT]),
        no=_regression_list([row for row in judged if row["p"] >= SIGNIFICANT]),
        few=FEWEST_VALUES,
        rows=_regression_list(withheld),
    )
    return prose("{relations} How large each slope could still be is listed with the regressions.", relations=sentence)


def _significance(row: Json) -> str:
    """The p value in brackets, with a remark on the interval with sites as clusters; empty without a test."""
    if row["p"] is None:
        return ""
    p = p_equals(row["p"])
    if row["group"] != "all" or row["p"] >= SIGNIFICANT or row["interval_by_site"] is None:
        return f" ({p})"
    pair = row["interval_by_site"][1]
    if pair is None:
        return Message(" ({p}; the sites are too few or too similar to decide)", p=p)
    return f" ({p})" if pair[0] > 0 or pair[1] < 0 else Message(" ({p}; not with sites as clusters)", p=p)


def _regression_list(rows: list[Json]) -> Markup:
    """Regressions in words with their p values, the first ones only; "none" for an empty list."""
    named = [
        prose(
            "{response} on {predictor}{group}{p}",
            response=html(QUANTITY[row["response"]][0]),
            predictor=html(QUANTITY[row["terms"][1]][0]),
            group="" if row["group"] == "all" else Message(" at {site}", site=row["group"]),
            p=_significance(row),
        )
        for row in rows[:LISTED]
    ]
    if len(rows) > LISTED:
        named.append(prose("{n_rows} more", n_rows=whole(len(rows) - LISTED)))
    return html(", ").join(named) if named else html(Message("none"))
