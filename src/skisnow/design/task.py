"""A design task, DESIGN.toml: the ski to begin with, variables with bounds, conditions, goals and constraints."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any, Final, Literal

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.units import N_PER_MM2, N_PER_MM3
from .._support.user_files.text_files import read_toml
from ..carving.answer import asked_snow
from ..carving.outputs import FORCE_ALONG_EDGE, OUTPUTS
from ..carving.question import CARVE_KEYS, SKI_FACTORS, CarveQuestion, carve_question
from ..parameters import Allowed, Quantity, build_declared, checked_table, suggest_and_list
from ..ski import Ski
from ..ski.editing import changed_keys, key_value, shape_parameters
from ..ski.file_keys import LISTS
from ..ski.ski_file import Sources

FEWEST_STARTS: Final = 8  # starts of the search: a worst case over contact with snow has several local optima
INTERVALS: Final = "intervals"  # key of a condition that also counts at the ends of its snow's intervals
_LISTED: Final = ("edge_angle_deg", "load_N", "published")
_KINDS: Final[dict[str, tuple[type[Any], type[Any]]]] = {
    "ski": (str, str), "variables": (dict, str), "conditions": (list, dict), "goals": (list, dict),
    "constraints": (list, dict), "monotone": (list, str),
}  # fmt: skip
"""By key without a number: the type of its value, and of the value's items."""
_WITHOUT: Final = ("ski", "groove", "footprint_stiffness_N_per_mm2", "at_rest", *SKI_FACTORS)


@dataclass(frozen=True, slots=True, kw_only=True)
class Goal:
    """A goal for one output at some conditions, or the force at some places: a target, or a limit on one side."""

    output: Annotated[str, Quantity("output", "name of an output, such as turn_radius_boot_m")]
    target: Annotated[float | None, Quantity("target", "value to reach"), Allowed(0.0, above=True)] = None
    at_most: Annotated[float | None, Quantity("at_most", "upper limit"), Allowed(0.0, above=True)] = None
    at_least: Annotated[float | None, Quantity("at_least", "lower limit"), Allowed(0.0, above=True)] = None
    over: Annotated[
        Literal["mean", "worst"],
        Quantity("over", "what of a target's relative deviations is smallest: the mean square, or the worst one"),
    ] = "mean"
    weight: Annotated[float, Quantity("weight", "factor of the deviations"), Allowed(0.0, above=True)] = 1.0
    conditions: Annotated[
        tuple[float, ...] | None, Quantity("conditions", "numbers of the conditions, from 1", origin="all")
    ] = None
    places_m: Annotated[
        tuple[float, ...] | None,
        Quantity("places_m", "places of the force along the edge, from the boot", origin="none"),
    ] = None
    curve: Annotated[
        tuple[float, ...] | None,
        Quantity("curve", "factors of the target or limit at these places"),
        Allowed(0.0, origin="1 everywhere"),
    ] = None
    ratio: Annotated[bool, Quantity("ratio", "the output at the first of two conditions over that at the second")] = (
        False
    )

    @property
    def wanted(self) -> float:
        """The value of the target or limit."""
        return self.target or self.at_most or self.at_least or 1.0

    @property
    def factors(self) -> FloatArray:
        """Factors of the target or limit at the places; a single 1 without places."""
        return np.array(self.curve or (1.0,) * len(self.places_m or (0.0,)))

    @property
    def scale(self) -> float:
        """The value against which deviations are relative: the target or limit, the largest of a curve."""
        return self.wanted * float(np.max(np.abs(self.factors)))

    @property
    def merit_factor(self) -> float:
        """Factor of deviations: the root of a target's weight; 1 or -1 for a limit, so that more is better."""
        return float(np.sqrt(self.weight)) if self.target is not None else 1.0 if self.at_most is None else -1.0

    def deviations(self, values: FloatArray) -> FloatArray:
        """Relative deviations (n,) of values from the target or limit; at several places, condition by condition."""
        wanted = self.wanted * np.resize(self.factors, len(values))
        return np.asarray((values - wanted) / self.scale)


@dataclass(frozen=True, slots=True, kw_only=True)
class Constraint:
    """Limits of a sum of keys of the ski file, each times a factor."""

    terms: Mapping[str, float]
    at_least: float = -math.inf
    at_most: float = math.inf


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class DesignTask:
    """A checked task.

    variables: variables in the order of the file.
    conditions: questions of a carve, one for each combination of the listed edge angles, loads and snows.
    starts, seed: number of starts of the search, the first at the ski itself; seed of the others.
    """

    ski: Ski
    variables: tuple[Variable, ...]
    conditions: tuple[CarveQuestion, ...]
    goals: tuple[Goal, ...]
    constraints: tuple[Constraint, ...] = ()
    starts: Annotated[int, Quantity("starts", "number of searches"), Allowed(1.0)] = FEWEST_STARTS
    seed: Annotated[int, Quantity("seed", "seed of the searches but the first"), Allowed(0.0)] = 1
    sources: Sources = field(default_factory=Sources)


def read_design(path: str | Path) -> DesignTask:
    """Read a DESIGN.toml; paths in it start at its folder.

    Raises
    ------
    ParameterError
        A key is unknown or missing, or a value is not allowed; file and place are named.
    """
    path = Path(path)
    try:
        return design_task(read_toml(path), sources=Sources(folder=path.parent))
    except ParameterError as error:
        raise (error if str(error).startswith(str(path)) else error.at(path)) from error


def design_task(values: Mapping[str, Any], *, sources: Sources | None = None) -> DesignTask:
    """Check the keys of DESIGN.toml and build the task; `sources`: cache that reads its skis and snows."""
    numbers = checked_table(DesignTask, values, "task", further=_KINDS)
    for name, (kind, item) in _KINDS.items():
        value: Any = values.get(name)
        if not value and name not in ("constraints", "monotone"):
            raise ParameterError("{name} is missing. Add it, as on the page docs/files/ski.md.").tag(
                "missing", name=name
            )
        if value and not (isinstance(value, kind) and all(isinstance(each, item) for each in value)):
            raise ParameterError("{name} is {value}. Write it as on the page docs/files/ski.md.").tag(
                "wrong_kind", name=name, value=value
            )
    sources = sources or Sources()
    ski, _ = sources.ski(values["ski"])
    if ski.keys is None:
        raise ParameterError(
            "the ski {ski} has a table or a shape file. A design changes keys of a ski file: give lengths, widths "
            "and lists of stiffness as keys."
        ).tag("no_keys", ski=ski.name)
    tables = enumerate(values["conditions"], start=1)
    conditions = tuple(
        itertools.chain.from_iterable(_read_conditions(n, table, ski.name, sources) for n, table in tables)
    )
    goals = tuple(_read_goal(n, table, len(conditions)) for n, table in enumerate(values["goals"], start=1))
    constraints = [_read_constraint(n, table, ski) for n, table in enumerate(values.get("constraints", ()), start=1)]
    for key in values.get("monotone", ()):
        constraints += _monotone(ski, str(key))
    return DesignTask(
        ski=ski,
        variables=tuple(_read_variable(ski, name, bounds) for name, bounds in values["variables"].items()),
        conditions=conditions,
        goals=goals,
        constraints=tuple(constraints),
        sources=sources,
        **numbers,
    )


def _require_variable(place: str, ski: Ski, name: str) -> None:
    """Reject a name that is no variable of the ski."""
    of_file = (parameter.removeprefix("ski.") for parameter in shape_parameters(ski) if parameter.startswith("ski."))
    allowed = (*of_file, *COMBINED)
    if name not in allowed:
        raise ParameterError("{place}: unknown variable {name}. {allowed}").tag(
            "unknown_name", place=place, name=name, allowed=suggest_and_list(name, allowed)
        )


def _read_variable(ski: Ski, name: str, bounds: Any) -> Variable:
    """Variable of the design with its bounds; rejects a lower bound that is not below the upper one."""
    _require_variable("variables", ski, name)
    is_pair = isinstance(bounds, list | tuple) and len(bounds) == 2 and all(map(_is_number, bounds))
    if not is_pair or bounds[0] >= bounds[1]:
        raise ParameterError(
            "variables: {name} is {value}. Allowed: a lower and a higher bound, such as [64, 72]."
        ).tag("out_of_range", name=name, value=bounds)
    return Variable(name, float(bounds[0]), float(bounds[1]))


def _is_number(value: object) -> bool:
    """True for a finite number; False for True, False and other values."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _read_conditions(number: int, table: Mapping[str, Any], ski: str, sources: Sources) -> list[CarveQuestion]:
    """Carves of an entry of [[conditions]]; errors name its number."""
    try:
        questions = _read_questions(table, ski, sources)
        for question in questions:
            asked_snow(question, sources)
    except ParameterError as error:
        raise error.at(f"conditions, {number}") from error
    return questions


def _read_questions(table: Mapping[str, Any], ski: str, sources: Sources) -> list[CarveQuestion]:
    """Carves of a table: all combinations of its lists, and the ends of intervals if it asks for them."""
    table = dict(table)
    over_intervals = table.pop(INTERVALS, False)
    if not isinstance(over_intervals, bool):
        raise ParameterError("{name} is true or false.").tag("wrong_kind", name=INTERVALS)
    for name in table:
        if name not in CARVE_KEYS or name in _WITHOUT:
            allowed = [INTERVALS, *(key for key in CARVE_KEYS if key not in _WITHOUT)]
            raise ParameterError("unknown key {name}. {allowed}").tag(
                "unknown_name", name=name, allowed=suggest_and_list(name, allowed)
            )
    lists = {name: table[name] for name in _LISTED if isinstance(table.get(name), list)}
    questions = [
        carve_question({**table, "ski": ski, **dict(zip(lists, combination, strict=True))})
        for combination in itertools.product(*lists.values())
    ]
    return (
        [each for question in questions for each in _over_intervals(question, sources)] if over_intervals else questions
    )


def _over_intervals(question: CarveQuestion, sources: Sources) -> list[CarveQuestion]:
    """The question, and those at the ends of the 95 % intervals of H_V and S_f, one after the other."""
    snow = asked_snow(question, sources)
    ends = [(end, snow.failure_shear_stress) for end in snow.snow_hardness_interval or ()]
    ends += [(snow.snow_hardness, end) for end in snow.failure_shear_stress_interval or ()]
    if not ends:
        raise ParameterError("the snow has no intervals. Give results of a campaign, or leave {name} out.").tag(
            "no_intervals", name=INTERVALS
        )
    own = replace(question, published=None, results=None, site=None)
    stresses = [None if stress is None else stress / N_PER_MM2 for _, stress in ends]
    hardnesses = [hardness / N_PER_MM3 for hardness, _ in ends]
    pairs = zip(hardnesses, stresses, strict=True)
    return [question, *(replace(own, H_V_N_per_mm3=hardness, S_f_N_per_mm2=stress) for hardness, stress in pairs)]


def _read_goal(number: int, table: Mapping[str, Any], conditions: int) -> Goal:
    """Goal of an entry: an output with one of target, at_most and at_least, in the chosen conditions."""
    place = f"goals, {number}"
    goal: Goal = build_declared(Goal, checked_table(Goal, table, place))
    if goal.output not in (*OUTPUTS, FORCE_ALONG_EDGE):
        raise ParameterError("{place}: unknown output {name}. {allowed}").tag(
            "unknown_name",
            place=place,
            name=goal.output,
            allowed=suggest_and_list(goal.output, (*OUTPUTS, FORCE_ALONG_EDGE)),
        )
    along, places = goal.output == FORCE_ALONG_EDGE, goal.places_m or ()
    if along != bool(places) or len(goal.curve or places) != len(places) or (along and goal.ratio):
        raise ParameterError(
            "{place}: places_m and curve are for {name}, which needs places. Give a factor for each place, or no "
            "curve, and no ratio."
        ).tag("contradiction", place=place, name=FORCE_ALONG_EDGE)
    if sum(limit is not None for limit in (goal.target, goal.at_most, goal.at_least)) != 1:
        raise ParameterError("{place}: give one of target, at_most and at_least.").tag("contradiction", place=place)
    chosen = goal.conditions or tuple(range(1, conditions + 1))
    if any(not 1 <= number <= conditions or number != int(number) for number in chosen) or (
        goal.ratio and len(chosen) != 2
    ):
        raise ParameterError(
            "{place}: conditions is {chosen}. Allowed: numbers from 1 to {count}, two of them for a ratio."
        ).tag("out_of_range", place=place, chosen=list(chosen), count=conditions)
    return goal


def _read_constraint(number: int, table: Mapping[str, Any], ski: Ski) -> Constraint:
    """Linear constraint: a sum of variables with factors, and at_least or at_most."""
    place = f"constraints, {number}"
    limits = dict(table)
    terms = limits.pop("terms", None)
    numbers = [*terms.values(), *limits.values()] if isinstance(terms, dict) and terms else [None]
    if not limits or limits.keys() - {"at_least", "at_most"} or not all(map(_is_number, numbers)):
        raise ParameterError(
            "{place}: {table} is not allowed. Write terms = {{tip_width_mm = 1, waist_width_mm = -1}} and at_least or "
            "at_most."
        ).tag("out_of_range", place=place, table=dict(table))
    for name in terms:
        _require_variable(place, ski, name)
    return Constraint(terms=terms, **limits)


def _monotone(ski: Ski, key: str) -> list[Constraint]:
    """Constraints that make a stiffness rise from the tip to the initial ski's largest row and fall behind it."""
    values = (ski.keys or {}).get(key)
    if key not in LISTS or not isinstance(values, list):
        raise ParameterError("monotone: {key} is not a list of stiffness of this ski.").tag("unknown_name", key=key)
    top = values.index(max(values))
    pairs = ((row, row + 1) if row < top else (row + 1, row) for row in range(len(values) - 1))
    return [
        Constraint(terms={f"{key}[{high + 1}]": 1.0, f"{key}[{low + 1}]": -1.0}, at_least=0.0) for low, high in pairs
    ]


COMBINED: Final = {
    "sidecut_mm": ("tip_width_mm", "tail_width_mm"),
    "EI_factor": ("EI_N_m2",),
    "GJ_factor": ("GJ_N_m2",),
}
"""Added to tip and tail width (mm); factors of a whole list of stiffness."""


@dataclass(frozen=True, slots=True)
class Variable:
    """A variable by its name, with bounds in the unit of the ski file."""

    name: str
    lowest: float
    highest: float

    @property
    def width(self) -> float:
        """Upper minus lower bound, in the unit of the ski file."""
        return self.highest - self.lowest


def combined_names(name: str) -> tuple[str, ...]:
    """Names of the ski parameters that a variable changes, for its derivative."""
    if name == "sidecut_mm":
        return tuple(f"ski.{key}" for key in COMBINED[name])
    if name in COMBINED:
        return (f"edit.{COMBINED[name][0]}",)
    return (f"ski.{name}",)


def start_value(keys: Mapping[str, Any], name: str) -> float:
    """Value of a variable at the ski to begin with."""
    if name in COMBINED:
        return 0.0 if name == "sidecut_mm" else 1.0
    return key_value(keys, name)


def designed_keys(keys: Mapping[str, Any], variables: Sequence[Variable], values: Sequence[float]) -> dict[str, Any]:
    """Keys of the ski file with the values of the variables; combined variables change the resulting keys."""
    named = {variable.name: float(value) for variable, value in zip(variables, values, strict=True)}
    out = changed_keys(keys, {name: value for name, value in named.items() if name not in COMBINED})
    for name, value in named.items():
        if name == "sidecut_mm":
            out |= {key: out[key] + value for key in COMBINED[name]}
        elif name in COMBINED:
            key = COMBINED[name][0]
            out[key] = [value * number for number in out[key]]
    return out
