"""The interpreter's lock is released while a carve is looked for: threads share nothing but the ski."""

from __future__ import annotations

import itertools
import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from skisnow.carving.equilibrium import carve
from skisnow.carving.result import Equilibrium
from skisnow.ski import read_ski

from .synthetic import snow

POINTS = list(itertools.product((0.04, 0.2, 5.0), (10.0, 45.0), (1.0, 20.0)))


def found(point: tuple[float, float, float]) -> Equilibrium:
    hardness, angle, ratio = point
    return carve(read_ski("slalom"), snow(hardness), edge_angle=math.radians(angle), load=800.0, unloading_ratio=ratio)


def test_bits_are_the_same_in_threads() -> None:
    alone = [found(point) for point in POINTS]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(found, POINTS * 2))
    for one, other in zip(alone * 2, together, strict=True):
        assert one.iterations == other.iterations
        assert np.array_equal(np.asarray(one.edge_depth), np.asarray(other.edge_depth))
        assert np.array_equal(np.asarray(one.force_per_length), np.asarray(other.force_per_length))
