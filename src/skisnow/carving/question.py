"""One question about a ski in snow, in the words and units of users, checked."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from .._support.errors import ParameterError
from .._support.messages import Message
from ..parameters import nearest
from .keys import CARVE_KEYS, CarveQuestion


def carve_question(values: Mapping[str, object]) -> CarveQuestion:
    """Check the inputs of one question and fill in the defaults.

    Parameters
    ----------
    values
        By the names of `CARVE_KEYS`, in the units that the names say.

    Raises
    ------
    ParameterError
        A key is unknown (the nearest is named), missing or outside its range, or the snow is not given in exactly one
        way.

    Examples
    --------
    >>> asked = {"ski": "slalom", "edge_angle_deg": 45, "load_N": 800, "published": "race-piste", "unloading_ratio": 10}
    >>> carve_question(asked).moment_Nm
    0.0
    """
    require_known(values)
    require_complete(values)
    given: dict[str, Any] = {name: CARVE_KEYS[name].in_range(value) for name, value in values.items()}
    return CarveQuestion(**given)


def require_known(names: Iterable[str]) -> None:
    """Reject an unknown name, and suggest the nearest one."""
    for name in names:
        if name not in CARVE_KEYS:
            raise ParameterError(
                "{name} is no input of a carved turn. {allowed}",
                code="unknown_name",
                name=name,
                allowed=nearest(name, CARVE_KEYS),
            )


def require_complete(values: Mapping[str, object]) -> None:
    """Refuse inputs that lack one without a default, or name the snow in no way or in two.

    A study asks with all its names at once, before it has a point.
    """
    rests = values.get("at_rest") is True
    for name in ("ski", "edge_angle_deg", "load_N", *(() if rests else ("unloading_ratio",))):
        if name not in values:
            example = CARVE_KEYS[name].example
            meaning = CARVE_KEYS[name].meaning
            problem = (
                Message(
                    "{name} is missing: {meaning}. It has no default. Give one, e.g. {example}",
                    name=name,
                    meaning=meaning,
                    example=example,
                )
                if example
                else Message("{name} is missing: {meaning}. It has no default", name=name, meaning=meaning)
            )
            raise ParameterError(problem, code="missing")
    _require_one_snow(set(values), rests)


def _require_one_snow(names: set[str], rests: bool) -> None:
    ways = [name for name in ("H_V_N_per_mm3", "results", "published") if name in names]
    choices = Message("Give H_V_N_per_mm3 and S_f_N_per_mm2, or results, or published")
    if not ways:
        raise ParameterError("no snow is given: H_V has no default. {choices}", code="missing", choices=choices)
    if len(ways) > 1:
        raise ParameterError(
            "the snow is given in two ways, {first} and {second}. {choices}",
            code="contradiction",
            first=ways[0],
            second=ways[1],
            choices=choices,
        )
    if ways == ["H_V_N_per_mm3"] and "S_f_N_per_mm2" not in names and not rests:
        raise ParameterError(
            "S_f_N_per_mm2 is missing: a carved turn needs the failure shear stress S_f, which has no default. Give "
            "it, or ask for the ski at rest",
            code="missing",
        )
    if "site" in names and ways != ["results"]:
        raise ParameterError(
            "site goes with results: it names one site of an analysed campaign. Leave it out", code="contradiction"
        )
