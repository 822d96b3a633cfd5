"""The snow of an analysed campaign, from its results.json."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ..constants import CONFIDENCE
from ..errors import ParameterError
from ..given import GivenError, read_json
from ..units import N_PER_MM2, N_PER_MM3
from .properties import Interval, SnowProperties

_LARGEST = 1e9


def snow_from_results(path: str | Path, *, site: str | None = None) -> SnowProperties:
    """Read the snow of an analysed campaign from its results.json.

    H_V is the geometric mean over the used penetration experiments, S_f the mean over the used shear experiments, of
    one site or of all. With two experiments or more each mean has its 95 % interval by Student's t: that of H_V on
    logarithms, that of S_f on the values themselves (its lower end may lie below 0 with few experiments).

    Parameters
    ----------
    path
        results.json as `skisnow analyse` writes it.
    site
        One site of the file; left out: all sites together.

    Raises
    ------
    ParameterError
        The file cannot be read or is no results file; or it holds no used penetration experiment of that site: the
        message names the sites it has.

    Notes
    -----
    The interval takes the experiments for independent draws from one snow. Over several sites that is optimistic:
    experiments of one site resemble each other.
    """
    results = _results(Path(path))
    hardness = _used(results, "penetration", "H_V_N_per_mm3", site, path)
    stress = _used(results, "shear", "S_f_N_per_mm2", site, path)
    if not hardness.size:
        sites = sorted({str(row["site"]) for row in results["penetration"]["experiments"] if row["used"]})
        asked = "" if site is None else f" of site {site!r}"
        known = f"it has some of {', '.join(map(repr, sites))}" if sites else "it has none at any site"
        raise ParameterError(f"{path} has no used penetration experiment{asked}; {known}")
    if not (np.all(hardness > 0) and np.all(stress >= 0) and (stress.size == 0 or np.any(stress > 0))):
        raise ParameterError(f"{path}: H_V of a used experiment must be above 0, and S_f of one at least")
    if not (np.all(hardness >= 1.0 / _LARGEST) and np.all(hardness <= _LARGEST) and np.all(stress <= _LARGEST)):
        raise ParameterError(f"{path}: H_V and S_f of a used experiment must lie from 1e-9 to 1e9 N/mm³ and N/mm²")
    H_V, H_V_interval = _mean(np.log(hardness))
    S_f, S_f_interval = _mean(stress) if stress.size else (None, None)
    return SnowProperties(
        snow_hardness=math.exp(H_V) * N_PER_MM3,
        failure_shear_stress=None if S_f is None else S_f * N_PER_MM2,
        source=f"{path}, {_site_in_words(site)}: {hardness.size} penetration and {stress.size} shear experiments",
        snow_hardness_interval=_scaled(
            H_V_interval and (math.exp(H_V_interval[0]), math.exp(H_V_interval[1])), N_PER_MM3
        ),
        failure_shear_stress_interval=_scaled(S_f_interval, N_PER_MM2),
    )


def _site_in_words(site: str | None) -> str:
    """A site that is called "site A" is not called "site site A"."""
    if site is None:
        return "all sites"
    return site if site.casefold().startswith("site") else f"site {site}"


def _scaled(interval: Interval | None, unit: float) -> Interval | None:
    return interval and (interval[0] * unit, interval[1] * unit)


def _mean(values: npt.NDArray[np.float64]) -> tuple[float, Interval | None]:
    """The mean and its interval by Student's t; no interval for a single value."""
    mean = math.fsum(values.tolist()) / values.size
    if values.size < 2:
        return mean, None
    from scipy.special import stdtrit  # slow to load, and asked for with a campaign at hand only

    quantile = float(stdtrit(values.size - 1, 0.5 + CONFIDENCE / 2.0))
    half = quantile * float(np.std(values, ddof=1)) / math.sqrt(values.size)
    return mean, (mean - half, mean + half)


def _results(path: Path) -> dict[str, Any]:
    advice = "give the results.json that `skisnow analyse` wrote"
    try:
        results = read_json(path)
    except GivenError as error:
        raise ParameterError(f"{error} Needed is the results.json that `skisnow analyse` wrote") from error
    if not isinstance(results, dict) or not {"penetration", "shear"} <= results.keys():
        raise ParameterError(f"{path} has no entries 'penetration' and 'shear'; {advice}")
    return results


def _used(results: dict[str, Any], part: str, key: str, site: str | None, path: str | Path) -> npt.NDArray[np.float64]:
    """The values of the used experiments; 0 N/mm² of a test without moment is a value, null is not."""
    try:
        rows = [row for row in results[part]["experiments"] if row["used"] and site in (None, row["site"])]
        return np.array([float(row[key]) for row in rows if row[key] is not None])
    except (KeyError, TypeError, ValueError) as error:
        raise ParameterError(
            f"{path}: {part}.experiments is not a list of experiments with used, site and {key} ({error!r}); "
            "give the results.json that `skisnow analyse` wrote"
        ) from error
