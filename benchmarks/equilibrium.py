"""How long one equilibrium of a ski in snow takes, ten thousand of them, and the same statics in Exudyn."""

from __future__ import annotations

import itertools
import math
import statistics
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial

from skisnow._support.processes.batch import run_batch
from skisnow.carving.equilibrium import carve, rest
from skisnow.ski import Ski, read_ski
from skisnow.snow.properties import SnowProperties

from .timing import Measurement, in_turn, timed

SKIS = ("slalom", "giant-slalom", "carver")
HARDNESSES = (0.04e9, 0.2e9, 1e9, 10e9)
ANGLES_DEG = tuple(range(5, 75, 5))
LOADS = (400.0, 800.0, 1500.0, 3000.0)
UNLOADING_RATIOS = (1.0, 2.0, 10.0, 50.0)
MANY = 10_000
WORKERS = 2


@dataclass(frozen=True, slots=True)
class Point:
    """One point of a parametric study, in SI."""

    ski: str
    hardness: float
    edge_angle: float
    load: float
    unloading_ratio: float


class Answers:
    """From points to rows; reads each ski once."""

    def __init__(self) -> None:
        self._skis: dict[str, Ski] = {}

    def __call__(self, point: Point) -> dict[str, object]:
        if point.ski not in self._skis:
            self._skis[point.ski] = read_ski(point.ski)
        found = carve(
            self._skis[point.ski],
            SnowProperties(point.hardness, 0.35e6, source="benchmark"),
            edge_angle=point.edge_angle,
            load=point.load,
            unloading_ratio=point.unloading_ratio,
        )
        return {"outcome": found.outcome, "turn_radius_boot_m": found.turn_radius_boot}


def study_points() -> list[Point]:
    """Angles by loads by snows by unloading ratios by skis: 2,688 points."""
    grid = itertools.product(SKIS, HARDNESSES, ANGLES_DEG, LOADS, UNLOADING_RATIOS)
    return [Point(ski, hardness, math.radians(angle), load, ratio) for ski, hardness, angle, load, ratio in grid]


def measure() -> Iterator[Measurement]:
    points = study_points()
    answers = Answers()
    for name in SKIS:  # divide each ski into elements
        answers(next(point for point in points if point.ski == name))
    seconds = [timed(partial(answers, point)) for point in points]
    one = f"one equilibrium, median of {len(points):,} points of a study"
    yield Measurement(one, statistics.median(seconds), "< 1 ms")
    many = [points[k % len(points)] for k in range(MANY)]
    spent = timed(lambda: _in_threads(many, answers))
    yield Measurement(f"{MANY:,} equilibria, {WORKERS} threads", spent, "< 8 s")
    spent = timed(lambda: run_batch(many, Answers(), workers=WORKERS))
    yield Measurement(f"{MANY:,} equilibria, {WORKERS} processes, their start included", spent, "< 60 s")
    yield from _against_exudyn()


def _in_threads(points: list[Point], answers: Answers) -> None:
    with ThreadPoolExecutor(WORKERS) as pool:
        list(pool.map(lambda part: [answers(point) for point in part], [points[k::WORKERS] for k in range(WORKERS)]))


def _against_exudyn() -> Iterator[Measurement]:
    """A flat slalom ski under a point load on snow that does not pull; 160 elements and ready models on both sides."""
    try:
        from .exudyn_contact import on_snow
    except ImportError:
        yield Measurement("flat ski at rest in snow, 160 elements", _rest_seconds(), "", "Exudyn is not installed")
        return
    ski, snow = read_ski("slalom"), _snow()
    model = on_snow(ski, snow.snow_hardness, 800.0, elements=160)
    mine, theirs = in_turn(lambda: rest(ski, snow, edge_angle=0.0, load=800.0, clamp_length=0.0), model.depth)
    yield Measurement("flat ski at rest in snow, 160 elements", mine, "", "Exudyn", theirs / mine)


def _rest_seconds() -> float:
    ski, snow = read_ski("slalom"), _snow()
    return statistics.median(
        timed(lambda: rest(ski, snow, edge_angle=0.0, load=800.0, clamp_length=0.0)) for _ in range(7)
    )


def _snow() -> SnowProperties:
    return SnowProperties(0.2e9, None, source="benchmark")
