"""Key results of a campaign as sentences in HTML: hardness, shear stress, law, relations."""

from __future__ import annotations

from typing import Final, NamedTuple

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
    """One sentence for each available result."""
    builders = (
        _hardness_sentence, _stress_sentence, _unloading_sentence, _displacement_sentence, _sentence_by_relation,
        _law_sentence, _relations_sentence
    )  # fmt: skip
    sentences = (build(data) for build in builders)
    return [sentence for sentence in sentences if sentence is not None]


def headline(data: ReportData) -> Markup:
    """Mean H_V with its interval, or S_f in a campaign without H_V; empty without either, and with several sites."""
    for key, sentence, unit in (
        ("H_V_N_per_mm3", template("Snow hardness H_V {value}, {ends}, over {sites}."), "N/mm³"),
        ("S_f_N_per_mm2", template("Failure shear stress S_f {value}, {ends}, over {sites}."), "N/mm²"),
    ):
        row = own_value(data, key)
        if row is not None and len(_sites(data, key)) > 1:
            break
        if row is not None:
            ends = row["own_interval"]
            return prose(
                sentence,
                value=Markup("<strong>{} {}</strong>").format(significant(row["own"]), unit),
                ends=Message("without an interval")
                if ends is None
                else Message("95 % interval {ends} {unit}", ends=interval(ends), unit=unit),
                sites=counted(len(_sites(data, key)), "{count} site", "{count} sites"),
            )
    return Markup("")


def _sites(data: ReportData, key: str) -> set[str]:
    return {row["site"] for row in data.results["site_means"] if row["quantity"] == key}


def own_value(data: ReportData, quantity: str) -> Json | None:
    """Mean, interval and range of a quantity in this campaign, None without a value."""
    for row in data.results["comparisons"]:
        if row["quantity"] == quantity and row["own"] is not None:
            return row
    return None


def _hardness_sentence(data: ReportData) -> Markup | None:
    n = counted(len(data.penetration), "{count} penetration experiment", "{count} penetration experiments")
    quantity = Quantity(Message("Snow hardness H_V: geometric mean"), "H_V", "H_V_N_per_mm3", "N/mm³", n, data.pressed)
    return _mean_sentence(data, quantity) if data.penetration else None


def _stress_sentence(data: ReportData) -> Markup | None:
    n = counted(len(data.shear), "{count} shear experiment", "{count} shear experiments")
    quantity = Quantity(Message("Failure shear stress S_f: mean"), "S_f", "S_f_N_per_mm2", "N/mm²", n, data.sheared)
    return _mean_sentence(data, quantity) if data.shear else None


def _unloading_sentence(data: ReportData) -> Markup | None:
    """Unloading ratio over all sites."""
    rows = data.results["penetration"]["unloading"]
    if not rows:
        return None
    row = rows[-1]
    if row["unloading_ratio_interval"] is None:
        upper_rebound = row["rebound_ratio_interval"] and row["rebound_ratio_interval"][1]
        bound = (
            prose("above {lower}", lower=significant(1.0 / upper_rebound))
            if upper_rebound and upper_rebound > 0
            else prose("not resolved")
        )
        return prose("Unloading ratio k_u / H_V: {bound}, from {n} series.", bound=bound, n=whole(row["n"]))
    return prose(
        "Unloading ratio k_u / H_V {value} (95 % interval {ends}), from {n} series that were unloaded step by step.",
        value=_strong(row["unloading_ratio"]),
        ends=interval(row["unloading_ratio_interval"]),
        n=whole(row["n"]),
    )


def _displacement_sentence(data: ReportData) -> Markup | None:
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
    """Density, hardness and S_f of each site by published relations, in a campaign without plate tests."""
    rows = data.results.get("published_relations")
    if not rows:
        return None
    outside = Message("outside of its range at each site")
    return prose(
        "By published relations, not by plate tests: hardness {hardness}; shear strength S_f {stresses}. Density: "
        "{densities}. No relation gives H_V.",
        hardness=Markup("; ").join(map(_hardness_by_relation, rows)),
        densities=_of_sites(rows, "snow_density_kg_per_m3", "kg/m³"),
        stresses=_of_sites(rows, "S_f_N_per_mm2", "N/mm²") or outside,
    )


def _hardness_by_relation(row: Json) -> Markup:
    """Penetration resistance where it was recorded, and hand hardness with the name of its relation."""
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


def _of_sites(rows: list[Json], key: str, unit: str) -> Markup:
    values = [Markup("{} {} {}").format(row["site"], _strong(row[key]), unit) for row in rows if row[key] is not None]
    return Markup("; ").join(values)


class Quantity(NamedTuple):
    """A measured quantity: name of its mean, symbol, key, unit, number of its experiments in words, the used ones."""

    mean_name: str
    symbol: str
    key: str
    unit: str
    experiments: str
    tests: UsedTests

    @property
    def used(self) -> str:
        """Number of the used experiments among all, in words."""
        return Message("{used} of {n} used", used=whole(len(self.tests)), n=self.experiments)


def _mean_sentence(data: ReportData, quantity: Quantity) -> Markup:
    row, sites = own_value(data, quantity.key), len(set(quantity.tests.site.tolist()))
    if row is None:
        return prose(
            "None of the {n} can be used, so there is no {symbol}.",
            n=quantity.experiments, symbol=html(quantity.symbol),
        )  # fmt: skip
    if 1 < sites < FEWEST_SITES:
        return _few_sites(data, quantity, row)
    if sites > 1:
        return _many_sites(data, quantity, row)
    return prose(
        "{mean_name} {value} {unit}{ends}, single experiments {low} to {high} {unit}; {used}, at {sites}.",
        mean_name=html(quantity.mean_name),
        value=_strong(row["own"]),
        unit=quantity.unit,
        ends=_interval_text(row["own_interval"], quantity.unit, sites),
        low=significant(row["own_range"][0]),
        high=significant(row["own_range"][1]),
        used=quantity.used,
        sites=counted(sites, "{count} site", "{count} sites"),
    )


def _many_sites(data: ReportData, quantity: Quantity, pooled: Json) -> Markup:
    """Means of the sites from the smallest to the largest, then the mean over all sites."""
    rows = [row for row in data.results["site_means"] if row["quantity"] == quantity.key and row["mean"] is not None]
    rows.sort(key=lambda row: row["mean"])
    return prose(
        "{mean_name} of each site: from {low} {unit} ({softest}) to {high} {unit} ({hardest}), at {sites}; {used}. "
        "Over all sites {value} {unit}{ends}.",
        mean_name=html(quantity.mean_name),
        low=_strong(rows[0]["mean"]),
        softest=rows[0]["site"],
        high=_strong(rows[-1]["mean"]),
        hardest=rows[-1]["site"],
        unit=quantity.unit,
        sites=counted(len(rows), "{count} site", "{count} sites"),
        used=quantity.used,
        value=significant(pooled["own"]),
        ends=_interval_text(pooled["own_interval"], quantity.unit, len(rows)),
    )


def _few_sites(data: ReportData, quantity: Quantity, pooled: Json) -> Markup:
    """Means of the sites, and the mean over all sites without an interval."""
    sites = [row for row in data.results["site_means"] if row["quantity"] == quantity.key]
    site_means = [
        prose(
            "{site} {value} {unit}{ends}, n = {n}",
            site=row["site"],
            value=_strong(row["mean"]),
            unit=quantity.unit,
            ends=_interval_text(row["interval"], quantity.unit, 1),
            n=whole(row["n"]),
        )
        for row in sites
    ]
    return prose(
        "{mean_name} of each site: {site_means}; {used}. Over the {sites} together {value} {unit}, without an "
        "interval: fewer than {fewest} sites do not show how sites scatter. Single experiments {low} to {high} {unit}.",
        mean_name=html(quantity.mean_name),
        site_means=html("; ").join(site_means),
        used=quantity.used,
        sites=counted(len(sites), "{count} site", "{count} sites"),
        value=significant(pooled["own"]),
        unit=quantity.unit,
        fewest=FEWEST_SITES,
        low=significant(pooled["own_range"][0]),
        high=significant(pooled["own_range"][1]),
    )


def _strong(value: float) -> Markup:
    return Markup("<strong>{}</strong>").format(significant(value))


def _interval_text(pair: list[float] | None, unit: str, sites: int) -> Markup:
    if pair is None:
        return prose(" (no interval: the scatter is not known)")
    if sites > 1:
        return prose(" (95 % interval {pair} {unit}, from the scatter between sites)", pair=interval(pair), unit=unit)
    return prose(" (95 % interval {pair} {unit}, from the scatter between experiments)", pair=interval(pair), unit=unit)


def _law_sentence(data: ReportData) -> Markup | None:
    selected = data.results["penetration"]["selected"]
    if selected is None:
        return None
    law = Markup("<strong>F = {}</strong>").format(html(formula(selected["id"])))
    names = {row["id"]: Message("the row {name}", name=model_name(row["id"]))
             for row in data.results["penetration"]["models"]}  # fmt: skip
    reason: Message = selected["reason"]
    fields = {key: names.get(value, value) for key, value in reason.fields.items()}
    reason_words = html(Message(reason.template, **fields))
    sentences = [prose("Selected law of the penetration force: {law}.", law=law), reason_words]
    if selected["id"] == "H_V:a=none,b=one":
        sentences.append(prose("This is the law that the paper proposes (its Eqn 12)."))
    return Markup(" ").join(sentences)


def _relations_sentence(data: ReportData) -> Markup | None:
    judged = [row for row in data.results["regressions"] if row["p"] is not None]
    withheld = [row for row in data.results["regressions"] if row["withheld"]]
    if not judged and not withheld:
        return None
    lists = {
        "yes": _regression_list([row for row in judged if row["p"] < SIGNIFICANT]),
        "no": _regression_list([row for row in judged if row["p"] >= SIGNIFICANT]),
    }
    if withheld:
        sentence = prose(
            "Relations: significant at 5 %: {yes}; not significant: {no}; not judged, as the predictor takes fewer "
            "than {few} different values: {rows}.",
            few=FEWEST_VALUES, rows=_regression_list(withheld), **lists,
        )  # fmt: skip
    else:
        sentence = prose("Relations: significant at 5 %: {yes}; not significant: {no}.", **lists)
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
