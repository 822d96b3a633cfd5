"""Snows that publications name, by the name a user gives."""

from __future__ import annotations

from difflib import get_close_matches

from .._support.errors import ParameterError
from .properties import SnowProperties
from .published import federolf_2006, moessner_2013


def published_names() -> tuple[str, ...]:
    """Names that `published_snow` knows, publication by publication.

    Returns
    -------
    tuple of str
        What `published_snow` takes.

    See Also
    --------
    skisnow.published_snow : the snow of a name.

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
    return tuple(_by_name())


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
    skisnow.published_names : all names.
    skisnow.snow_from_results : the snow of an analysed campaign.

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
    known = _by_name()
    if name not in known:
        near = get_close_matches(str(name).strip().lower().replace("_", "-").replace(" ", "-"), known, n=1, cutoff=0.4)
        meant = f"; did you mean {near[0]!r}?" if near else "."
        raise ParameterError(f"no published snow is named {name!r}{meant} There are {', '.join(known)}")
    return known[name]


def _by_name() -> dict[str, SnowProperties]:
    return {**federolf_2006.named_snows(), **moessner_2013.named_snows()}
