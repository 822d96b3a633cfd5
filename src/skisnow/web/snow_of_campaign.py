"""The snow of a campaign for a simulation: its results, and in words what they say and how well it is known."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..errors import ParameterError
from ..estimate.results_text import results_json
from ..report.write import RESULTS
from ..units import MM
from .analysing import Choice, Refusal, numbers_of
from .transfer import entry_files, kept_files
from .words import estimate_words, hardness_words, stress_words

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from ..scenario.reading import ScenarioFile
    from ..snow import SnowProperties
    from ..sources import Sources
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
    from ..scenario.given import change_of, given_scenario
    from ..scenario.reading import resolved

    given = given_scenario(scenario).changed(dict(change_of(f"{name}={text}") for name, text in changes.items()))
    return resolved(given, sources=sources)


def snow_of_campaign(lab: Lab, key: str, scenario: str, changes: Mapping[str, str]) -> tuple[bytes, str]:
    """Results of a campaign, for the key snow.results, and what it says of the snow with intervals in words.

    Parameters
    ----------
    lab
        Whose store has the campaign.
    key
        entry or kept, and the id, with - between.
    scenario, changes
        What is to be simulated with it.

    Raises
    ------
    ParameterError
        The campaign gives no snow, or the scenario cannot be read.
    """
    from ..scenario import scenario_values
    from ..snow.snow_dict import snow_dict
    from ..sources import Sources

    kind, id_ = key.split("-", 1)
    found = numbers_of((kept_files if kind == "kept" else entry_files)(lab, id_), Choice())
    if isinstance(found, Refusal):
        raise ParameterError(f"this campaign gives no snow yet. {found.said}")
    sources, site = Sources(), changes.get("snow.site") or None
    sources.take_snow(found.analysis.snow(site), results=RESULTS, site=site)
    asked = require_scenario(scenario, {**changes, "snow.results": RESULTS}, sources).scenario
    values, snow = scenario_values(asked), snow_dict(asked.contact.snow)
    hardness = {"H_V_N_per_mm3": values["snow.H_V_N_per_mm3"], **snow}
    stress = {"S_f_N_per_mm2": values["snow.S_f_N_per_mm2"], **snow}
    words = f"H_V = {hardness_words(hardness)}; S_f = {stress_words(stress)}"
    return results_json(found.results), "; ".join((words, *_measured_too(asked.contact.snow)))


def _measured_too(snow: SnowProperties) -> Iterator[str]:
    """k_u/H_V and u_y in words, where the run takes the measured ones."""
    known = (
        ("k_u/H_V", snow.unloading_ratio, snow.unloading_ratio_interval, 1.0, ""),
        ("u_y", snow.shear_displacement, snow.shear_displacement_interval, MM, "mm"),
    )
    for name, value, ends, unit, word in known:
        if value is not None:
            yield f"{name} = {estimate_words(value / unit, ends and [end / unit for end in ends], word)}"
