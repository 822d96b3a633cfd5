"""Variables of an FMU in the order of their references: time, parameters, inputs, outputs; as the core counts them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

Causality: TypeAlias = Literal["independent", "parameter", "input", "output"]

UNITS: Final[dict[str, dict[str, int]]] = {
    "s": {"s": 1},
    "m": {"m": 1},
    "m/s": {"m": 1, "s": -1},
    "rad/s": {"rad": 1, "s": -1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "N/m2": {"kg": 1, "m": -1, "s": -2},
    "N/m3": {"kg": 1, "m": -2, "s": -2},
    "1": {},
}
"""Units of the variables, by exponents of the base units."""


@dataclass(frozen=True, slots=True)
class Variable:
    """One number that goes in or out.

    Attributes
    ----------
    name
        By the standards' structured convention: ``left.force[1]``.
    causality
        Whether it is the time, a parameter, an input or an output.
    unit
        A key of `UNITS`.
    about
        Description.
    start
        Its value before anything is set.
    offered
        Whether the model description names it; its reference is taken in either case.
    """

    name: str
    causality: Causality
    unit: str
    about: str
    start: float = 0.0
    offered: bool = True


def vector(name: str, causality: Causality, unit: str, about: str, start: Iterable[float]) -> Iterator[Variable]:
    """A variable for each number of a vector, counted from 1."""
    for number, value in enumerate(start, start=1):
        yield Variable(f"{name}[{number}]", causality, unit, about, float(value))


TIME: Final = Variable("time", "independent", "s", "time")
