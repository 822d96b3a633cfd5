"""The snow of an analysed campaign from its results.json, and snow as a dictionary for JSON."""

from __future__ import annotations

import math
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.units import MM, N_PER_MM2, N_PER_MM3
from .._support.user_files.json_text import read_json
from .._support.user_files.text_files import ContentError
from .mean_snow import (
    mean_snow,
    no_used_experiment,
    site_in_words,
    site_named,
    with_measured_displacement,
    with_measured_unloading,
)
from .properties import Interval, SnowProperties
from .published import federolf_2006, moessner_2013


def snow_from_results(path: str | Path, *, site: str | None = None) -> SnowProperties:
    """Read the snow of an analysed campaign from its results.json.

    H_V is the geometric mean over the used penetration experiments, S_f the mean over the used shear experiments, of
    one site or of all. With two experiments or more each mean has its 95 % interval by Student's t on logarithms; for
    the mean m of S_f with the half-width h that is m exp(± h/m), as in site_means.

    Parameters
    ----------
    path
        results.json as `skisnow analyse` writes it.
    site
        One site of the file, "C" is also its "site C"; default: all sites together.

    Returns
    -------
    SnowProperties
        With intervals if there are two experiments or more, and with k_u/H_V if the unloading readings determine both
        ends of its interval.

    Raises
    ------
    ParameterError
        The file cannot be read or is not a results file, or it contains no used penetration experiment of that site;
        the message lists its sites.

    See Also
    --------
    skisnow.Analysis.snow : the same without a file.
    skisnow.load_snow : the snow of a publication.

    Notes
    -----
    The interval takes the experiments for independent draws from one snow. Over several sites that is optimistic:
    experiments of one site resemble each other.

    References
    ----------
    * Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
      snow for simulation of skiing", J. Glaciol.
    * The page docs/files/results.md.
    """
    results = _read_results(Path(path))
    site = site_named(site, _sites(results))
    hardness = _used(results, "penetration", "H_V_N_per_mm3", site, path)
    stress = _used(results, "shear", "S_f_N_per_mm2", site, path)
    if not hardness.size:
        sites = sorted({str(row["site"]) for row in results["penetration"]["experiments"] if row["used"]})
        raise no_used_experiment(path, site, sites)
    source = f"{path}, {site_in_words(site)}: {hardness.size} penetration and {stress.size} shear experiments"
    snow = mean_snow(hardness, stress, source=source, where=str(path))
    ratio, interval = _of_site(
        results, ("penetration", "unloading"), ("unloading_ratio", "unloading_ratio_interval"), site, path
    )
    snow = snow if ratio is None or interval is None else with_measured_unloading(snow, ratio, interval)
    way, ends = _of_site(
        results, ("shear", "displacement"), ("shear_displacement_mm", "shear_displacement_interval_mm"), site, path
    )
    return snow if way is None else with_measured_displacement(snow, way, ends or (math.nan, math.nan))


def _of_site(
    results: dict[str, Any], place: tuple[str, str], keys: tuple[str, str], site: str | None, path: str | Path
) -> tuple[float | None, Interval | None]:
    """Mean of a site (None: all sites) and its interval, by `keys`, from the list at `place`; None if missing."""
    try:
        rows = [row for row in results[place[0]].get(place[1], ()) if row["site"] == site]
        value, interval = (rows[0][key] for key in keys) if rows else (None, None)
        ends = None if interval is None else (float(interval[0]), float(interval[1]))
        return None if value is None else float(value), ends
    except (AttributeError, KeyError, TypeError, ValueError, IndexError) as error:
        raise ParameterError(
            "{path}: {place} is not a list with {keys} ({error!r}); give the results.json that `skisnow analyse` wrote"
        ).tag("wrong_kind", path=path, place=".".join(place), keys=["site", *keys], error=error) from error


def _read_results(path: Path) -> dict[str, Any]:
    """Contents of a results.json of `skisnow analyse`; rejects any other file."""
    try:
        results = read_json(path)
    except ContentError as error:
        raise ParameterError("{problem} Needed is the results.json that `skisnow analyse` wrote").tag(
            "wrong_kind", problem=error
        ) from error
    if not isinstance(results, dict) or not {"penetration", "shear"} <= results.keys():
        raise ParameterError(
            "{path} has no entries 'penetration' and 'shear'; give the results.json that `skisnow analyse` wrote"
        ).tag("missing", path=path)
    return results


def _sites(results: dict[str, Any]) -> set[str]:
    """Sites with a used experiment; empty if the entry is not a list, which `_used` rejects."""
    try:
        rows = [row for part in ("penetration", "shear") for row in results[part]["experiments"]]
        return {str(row["site"]) for row in rows if row["used"]}
    except (KeyError, TypeError):
        return set()


def _used(results: dict[str, Any], part: str, key: str, site: str | None, path: str | Path) -> FloatArray:
    """Values (n,) of `key` in the used experiments of a site (None: all sites); experiments with null are omitted."""
    try:
        rows = [row for row in results[part]["experiments"] if row["used"] and site in (None, row["site"])]
        return np.array([float(row[key]) for row in rows if row[key] is not None])
    except (KeyError, TypeError, ValueError) as error:
        raise ParameterError(
            "{path}: {part}.experiments is not a list of experiments with used, site and {key} ({error!r}); give the "
            "results.json that `skisnow analyse` wrote"
        ).tag("wrong_kind", path=path, part=part, key=key, error=error) from error


def snow_dict(snow: SnowProperties) -> dict[str, Any]:
    """JSON values of a snow: source, 95 % intervals of H_V and S_f, and those of k_u/H_V and u_y if measured."""

    def interval(ends: tuple[float, float] | None, unit: float) -> list[float] | None:
        return None if ends is None else [end / unit for end in ends]

    entries = {
        "source": snow.source,
        "H_V_interval_N_per_mm3": interval(snow.snow_hardness_interval, N_PER_MM3),
        "S_f_interval_N_per_mm2": interval(snow.failure_shear_stress_interval, N_PER_MM2),
    }
    if snow.unloading_ratio_interval is not None:
        entries["unloading_ratio_interval"] = list(snow.unloading_ratio_interval)
    if snow.shear_displacement_interval is not None:
        entries["shear_displacement_interval_mm"] = interval(snow.shear_displacement_interval, MM)
    return entries


def published_names() -> tuple[str, ...]:
    """Names of the published snows, by publication.

    Returns
    -------
    tuple of str
        Names that `published_snow` accepts.

    See Also
    --------
    skisnow.load_snow : the snow of a name.

    References
    ----------
    * Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
      snow for simulation of skiing", J. Glaciol.
    * Federolf and others (2006), "Deformation of snow during a carved ski turn", Cold Reg. Sci. Technol. 46, 69-77,
      doi 10.1016/j.coldregions.2006.06.006.

    Examples
    --------
    >>> published_names()
    ('race-piste', 'recreational-piste', 'spring-snow', 'fresh-snow', 'glacier')
    """
    return (*federolf_2006.NAMES, *moessner_2013.NAMED_SNOWS)


def published_snow(name: str) -> SnowProperties:
    """H_V and S_f of a snow that a publication names, with the publication as source.

    Parameters
    ----------
    name
        One of `published_names`.

    Returns
    -------
    SnowProperties
        With both numbers, and no unloading ratio: none is published.

    Raises
    ------
    ParameterError
        No such name; the message gives the nearest one and all.

    See Also
    --------
    skisnow.snow_names : all names.
    skisnow.read_snow : the snow of an analysed campaign.

    References
    ----------
    * Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
      snow for simulation of skiing", J. Glaciol.
    * Federolf and others (2006), "Deformation of snow during a carved ski turn", Cold Reg. Sci. Technol. 46, 69-77,
      doi 10.1016/j.coldregions.2006.06.006.

    Examples
    --------
    >>> snow = published_snow("race-piste")
    >>> round(snow.snow_hardness / 1e9, 2), round(snow.failure_shear_stress / 1e6, 2)  # N/mm³ and N/mm²
    (0.21, 0.52)
    """
    snows = {**federolf_2006.named_snows(), **moessner_2013.named_snows()}
    if name not in snows:
        near = get_close_matches(str(name).strip().lower().replace("_", "-").replace(" ", "-"), snows, n=1, cutoff=0.4)
        problem = (
            Message("no published snow is named {name!r}; did you mean {similar!r}?", name=name, similar=near[0])
            if near
            else Message("no published snow is named {name!r}.", name=name)
        )
        raise ParameterError("{problem} There are {names}").tag("unknown_name", problem=problem, names=list(snows))
    return snows[name]
