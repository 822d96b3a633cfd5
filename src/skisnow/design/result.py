"""A design: the ski before and after, its outputs, the local optima, goals that were not reached, files."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.messages import Message
from .._support.staging import prepare_folder, staged, write_file
from .._support.units import Facts, Shown
from ..carving.outputs import OUTPUTS
from ..ski import Ski
from ..ski.ski_file import keys_text, ski_of_keys
from .evaluation import PERCENT, REACHED, Search, carve_at, linear_constraints

_AT_BOUND: Final = 1e-6  # of the distance of the bounds
_SAME_RESULT: Final = 0.02  # relative, of squares, of two starts that reached the same optimum
_SAME_DESIGN: Final = 0.02  # of the bounds
_MISSED: Final = 1e-4  # relative deviation of a target that is reported
_CONTRADICTION: Final = Message(
    "No bound is active: the goals contradict each other, or the search ended at a local optimum."
)
CONFIRM: Final = Message(
    "Confirm the ski by simulated runs and on snow: a carve is a steady turn on one snow, without skier."
)


@dataclass(frozen=True, slots=True, eq=False)
class Start:
    """A search from one start: begin and end (variables from 0 to 1; None: failed), result, number of equilibria."""

    begin: FloatArray
    end: FloatArray | None
    result: float
    equilibria: int


@dataclass(frozen=True, slots=True)
class DesignRow:
    """An output at a condition, None where it does not exist.

    condition, output: number of the condition, from 1; name.
    before, after, rounded: of the ski to begin with, the design and the rounded design.
    change_percent: of the design against before.
    half_interval: half the 95 % interval that the snow's intervals give, to first order.
    """

    condition: int
    output: str
    before: float | None
    after: float | None
    rounded: float | None
    change_percent: float | None
    half_interval: float | None


@dataclass(frozen=True, slots=True)
class Optimum:
    """A local optimum: its result and the share of starts that reached it."""

    result: float
    share: float
    values: dict[str, float]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Design(Shown):
    """Result of a design.

    Attributes
    ----------
    before, ski
        The ski to begin with, and the design.
    keys, rounded_keys
        Keys of the design's ski file with all digits, and rounded to 0.1 mm and 1 N m².
    values
        Variables of the design, in the units of the ski file.
    rows
        Outputs at each condition.
    reached
        Whether all goals are reached and all constraints hold.
    remarks
        Goals that are not reached and constraints that are broken; the reason: bounds and constraints that are active.
        Conditions at which the edge slips.
    optima
        Local optima, the best first.
    equilibria
        Number of equilibria that the search computed.

    See Also
    --------
    skisnow.design_ski
    """

    before: Ski
    ski: Ski
    keys: dict[str, Any]
    rounded_keys: dict[str, Any]
    values: dict[str, float]
    rows: tuple[DesignRow, ...]
    reached: bool
    remarks: tuple[Message, ...]
    optima: tuple[Optimum, ...]
    equilibria: int

    def _repr_facts(self) -> Facts:
        """Title that says if all goals are reached, and a row with the design's values."""
        values = ", ".join(f"{name} {value:.6g}" for name, value in self.values.items())
        return Facts("all goals reached" if self.reached else "not all goals reached", (("design", values),))

    def as_dict(self) -> dict[str, Any]:
        """The result as JSON values."""
        return {
            "schema_version": 1,
            "reached": self.reached,
            "values": self.values,
            "keys": self.keys,
            "rounded_keys": self.rounded_keys,
            "rows": [asdict(row) for row in self.rows],
            "remarks": [str(remark) for remark in self.remarks],
            "optima": [asdict(optimum) for optimum in self.optima],
            "equilibria": self.equilibria,
        }

    def write(self, folder: str | Path) -> tuple[Path, ...]:
        """Write ``ski.toml`` (9 digits), ``ski-rounded.toml``, ``table.csv`` and ``design.json``; returns their paths.

        Raises OutputError: a file cannot be written.
        """
        text = io.StringIO()
        table = csv.DictWriter(text, DesignRow.__slots__, lineterminator="\n")
        table.writeheader()
        table.writerows({k: "" if v is None else v for k, v in asdict(row).items()} for row in self.rows)
        values = json.dumps(self.as_dict(), ensure_ascii=False, allow_nan=False, indent=1) + "\n"
        contents = {"ski.toml": keys_text(self.keys), "ski-rounded.toml": keys_text(self.rounded_keys)}
        return write_files(Path(folder), contents | {"table.csv": text.getvalue(), "design.json": values})


def write_files(folder: Path, contents: Mapping[str, str]) -> tuple[Path, ...]:
    """Write texts by their file names, the last one last, and return the paths.

    Raises OutputError: a file cannot be written.
    """
    prepare_folder(folder)
    with staged(folder, last=[*contents][-1]) as stage:
        for name, content in contents.items():
            write_file(stage.path / name, content)
    return tuple(folder / name for name in contents)


def design_of(search: Search, z: FloatArray, starts: tuple[Start, ...]) -> Design:
    """Result of a design from its variables z (0 to 1) and all starts of the search."""
    evaluator, task = search.evaluator, search.evaluator.task
    keys = evaluator.keys(z) | {
        "name": f"{task.ski.name}, designed",
        "source": f"designed by skisnow from the ski {task.ski.name}",
    }
    keys = {key: _rounded(value, lambda number: float(f"{number:.9g}")) for key, value in keys.items()}
    decimals = {key: 0 if key.endswith("N_m2") else 1 if key.endswith("_mm") else 3 for key in keys}  # as manufactured
    rounded = {key: _rounded(value, partial(round, ndigits=decimals[key])) for key, value in keys.items()}
    missed = [*_missed_goals(search, z), *_constraints_at(search, z, broken=True)]
    reasons = _active_bounds_and_constraints(search, z) or [_CONTRADICTION] * bool(missed)
    rows = _output_rows(search, keys, rounded)
    return Design(
        before=task.ski,
        ski=ski_of_keys(keys),
        keys=keys,
        rounded_keys=rounded,
        values=evaluator.named_values(z),
        rows=rows,
        reached=not missed,
        remarks=(*missed, *reasons, *_slips(rows), CONFIRM),
        optima=_optima(search, starts),
        equilibria=evaluator.equilibria,
    )


def _rounded(value: Any, rounding: Callable[[float], float]) -> Any:
    """The value of a ski's key with the rounding of each of its numbers; other values unchanged."""
    if isinstance(value, list):
        return [_rounded(item, rounding) for item in value]
    return rounding(value) if isinstance(value, float) else value


def _output_rows(search: Search, keys: dict[str, Any], rounded: dict[str, Any]) -> tuple[DesignRow, ...]:
    """Row of each output by condition: before, after, after rounding (None: no value), change (%), interval."""
    evaluator = search.evaluator
    skis = [search.evaluator.task.ski, ski_of_keys(keys), ski_of_keys(rounded)]
    rows = []
    for number, question in enumerate(evaluator.task.conditions):
        answers = [carve_at(ski, question, evaluator.snows[number]) for ski in skis]
        for output in OUTPUTS:
            before, after, after_rounding = (None if point is None else point.output(output) for point in answers)
            change = None if not before or after is None else 100.0 * (after / before - 1.0)
            snow = evaluator.snows[number]
            half = None if answers[1] is None or after is None else answers[1].half_interval(output, snow)
            rows.append(DesignRow(number + 1, output, before, after, after_rounding, change, half))
    return tuple(rows)


def _slips(rows: tuple[DesignRow, ...]) -> list[Message]:
    """Messages about the conditions at which the edge of the design slips."""
    return [
        Message(
            "Condition {condition}: the edge slips, as the grip utilisation is {grip:.3g}. Add a goal of at most 1.",
            condition=row.condition,
            grip=row.after,
        )
        for row in rows
        if row.output == "grip_utilisation" and row.after is not None and row.after > 1.0
    ]


def _missed_goals(search: Search, z: FloatArray) -> list[Message]:
    """Sentences about the goals that the design z misses, with its values and the deviation (%)."""
    out = []
    for goal in search.evaluator.task.goals:
        values = search.evaluator.goal_values(goal, z)
        misses = np.abs(goal.deviations(values)) if goal.target is not None else -search.values(goal, z)
        missed, values = float(np.max(misses)), values[[np.argmax(misses)]] if goal.places_m else values
        if missed > _MISSED:
            out.append(
                Message(
                    "{output}: the goal {wanted:g} is not reached. The design has {values}, {missed:.2g} % off.",
                    output=goal.output,
                    wanted=goal.wanted,
                    values=[float(f"{value:.6g}") for value in values],
                    missed=100.0 * missed,
                )
            )
    return out


def _active_bounds_and_constraints(search: Search, z: FloatArray) -> list[Message]:
    """Sentences about the variables at a bound and the constraints at their limit."""
    out = []
    for variable, share in zip(search.evaluator.task.variables, z, strict=True):
        for at, bound in ((share, variable.lowest), (1.0 - share, variable.highest)):
            if at <= _AT_BOUND:
                out.append(Message("{name} is at its bound {bound:g}.", name=variable.name, bound=bound))
    return out + _constraints_at(search, z, broken=False)


def _constraints_at(search: Search, z: FloatArray, *, broken: bool) -> list[Message]:
    """Messages about the constraints that a design breaks (`broken`), or whose limit it just reaches."""
    matrix, lowest = linear_constraints(search.evaluator)
    limits = [
        (number, limit)
        for number, constraint in enumerate(search.evaluator.task.constraints, start=1)
        for limit in (constraint.at_least, constraint.at_most)
        if np.isfinite(limit)
    ]
    rooms = list(zip(limits, (matrix @ z - lowest).tolist(), strict=True))
    if broken:
        return [
            Message(
                "Constraint {number} is broken: no start led to a ski that keeps {limit:g}.", number=number, limit=limit
            )
            for (number, limit), room in rooms
            if room < -REACHED
        ]
    return [
        Message("Constraint {number} is at its limit {limit:g}.", number=number, limit=limit)
        for (number, limit), room in rooms
        if abs(room) <= REACHED
    ]


def _optima(search: Search, starts: tuple[Start, ...]) -> tuple[Optimum, ...]:
    """Different optima of the starts, best first, each with the share of starts that found it."""
    optima: list[tuple[Start, int]] = []
    for start in sorted((start for start in starts if start.end is not None), key=lambda each: each.result):
        for n, (first, count) in enumerate(optima):
            near = abs(start.result - first.result) <= _SAME_RESULT * abs(first.result) + PERCENT * REACHED**2
            if near and np.max(np.abs(np.subtract(start.end, first.end))) <= _SAME_DESIGN:  # type: ignore[arg-type]
                optima[n] = (first, count + 1)
                break
        else:
            optima.append((start, 1))
    named = search.evaluator.named_values
    return tuple(
        Optimum(first.result, count / len(starts), named(first.end)) for first, count in optima if first.end is not None
    )
