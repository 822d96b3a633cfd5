"""The snow of a campaign for a carve or a simulation: its results, and in words what they say and how well."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .._support.errors import ParameterError
from .._support.units import MM, N_PER_MM2, N_PER_MM3
from ..estimation.results import results_json
from ..report.campaign.page import RESULTS
from .analysing import Choice, Refusal, numbers_of
from .transfer import entry_files, kept_files
from .words import estimate_words

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from ..estimation import Analysis
    from ..scenario.reading import ScenarioFile
    from ..ski.sources import Sources
    from ..snow import SnowProperties
    from .settings import Lab


def require_scenario(scenario: str, changes: Mapping[str, str], sources: Sources | None = None) -> ScenarioFile:
    """Read a scenario with changes as the command line would.

    Parameters
    ----------
    scenario, changes
        As on the command line.
    sources
        Of skis and snows that are at hand.

    Raises
    ------
    ParameterError
        A value cannot be read or is not allowed.
    """
    from ..scenario.keys import parse_change
    from ..scenario.reading import build_input, load_input

    given = load_input(scenario).changed(dict(parse_change(f"{name}={text}") for name, text in changes.items()))
    return build_input(given, sources=sources)


def campaign_snow(lab: Lab, key: str) -> Analysis:
    """The analysis of a campaign of the lab.

    Parameters
    ----------
    lab
        Whose store has the campaign.
    key
        entry or kept, and the id, with - between.

    Raises
    ------
    ParameterError
        The campaign gives no snow.
    """
    kind, id_ = key.split("-", 1)
    found = numbers_of((kept_files if kind == "kept" else entry_files)(lab, id_), Choice())
    if isinstance(found, Refusal):
        raise ParameterError(f"this campaign gives no snow yet. {found.said}")
    return found.analysis


def sites_of(analysis: Analysis) -> list[str]:
    """Sites that H_V was measured at."""
    return list(dict.fromkeys(row.site for row in analysis.site_means if row.quantity.startswith("H_V")))


def results_with(analysis: Analysis, scenario: str, changes: Mapping[str, str]) -> tuple[bytes, str]:
    """The text of results.json of a campaign, and in words the snow that the run then has.

    Parameters
    ----------
    analysis
        Of the campaign.
    scenario, changes
        What is to be simulated on its snow; ``snow.site`` names the site.

    Raises
    ------
    ParameterError
        A value cannot be read or is not allowed.
    """
    from ..ski.sources import Sources

    sources, site = Sources(), changes.get("snow.site") or None
    sources.take_snow(analysis.snow(site), results=RESULTS, site=site)
    asked = require_scenario(scenario, {**changes, "snow.results": RESULTS}, sources).scenario
    return results_json(analysis.results), snow_words(asked.contact.snow)


def snow_words(snow: SnowProperties) -> str:
    """H_V, S_f, k_u/H_V and u_y of a snow in words, with their intervals where these are known."""
    return "; ".join(_in_words(snow))


def _in_words(snow: SnowProperties) -> Iterator[str]:
    known = (
        ("H_V", snow.snow_hardness, snow.snow_hardness_interval, N_PER_MM3, "N/mm³"),
        ("S_f", snow.failure_shear_stress, snow.failure_shear_stress_interval, N_PER_MM2, "N/mm²"),
        ("k_u/H_V", snow.unloading_ratio, snow.unloading_ratio_interval, 1.0, ""),
        ("u_y", snow.shear_displacement, snow.shear_displacement_interval, MM, "mm"),
    )
    for name, value, ends, unit, word in known:
        if value is not None:
            yield f"{name} = {estimate_words(value / unit, ends and [end / unit for end in ends], word)}"
