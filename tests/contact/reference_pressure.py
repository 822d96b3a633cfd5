"""Pressure of the snow across one line, integrated between all places where it may bend, for `reference_contact`."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

import numpy as np

from skisnow._support.arrays import FloatArray
from skisnow.contact import SnowField

if TYPE_CHECKING:
    from .reference_contact import Line, Touch

_POINT, _WEIGHT = np.polynomial.legendre.leggauss(3)


def pressure(
    line: Line, touch: Touch, ways: list[tuple[float, float, float, float]], snow: SnowField
) -> tuple[float, float]:
    """∫p dy and ∫p (y - grip) dy of p = max(0, H_V ε_max - k_u (ε_max - ε)), ε_max the deepest ever.

    ``ways``: of the edges since the last accepted pose; they cut ground, too.
    """
    hardness = snow.snow_hardness
    assert isinstance(hardness, float)
    stiff = snow.unloading_ratio * hardness
    segments = [(a, ga, b, gb) if a < b else (b, gb, a, ga) for a, ga, b, gb in [*line.pressed, *ways]]
    places = {touch.low, touch.high, *(s[0] for s in segments), *(s[2] for s in segments)}
    straight = [*segments, (touch.low, float(touch.base(touch.low)), touch.high, float(touch.base(touch.high)))]
    for one, other in itertools.combinations([s for s in straight if s[2] > s[0]], 2):
        places.update(_meet(one, other))
    ordered = sorted(p for p in places if touch.low <= p <= touch.high)
    force = moment = 0.0
    for a, b in itertools.pairwise(ordered):
        if b - a < 1e-15:
            continue
        middle = 0.5 * (a + b)
        over = [s for s in segments if s[0] <= middle <= s[2] and s[2] > s[0]]
        deepest = max(over, key=lambda s: _at(s, middle), default=None)
        for low, high in _bearing(a, b, deepest, touch, hardness, stiff):
            at = 0.5 * (low + high) + 0.5 * (high - low) * _POINT
            base = np.asarray(touch.base(at))
            ground = base if deepest is None else np.maximum(base, _at(deepest, at))
            p = hardness * ground - stiff * (ground - base)
            force += float(0.5 * (high - low) * _WEIGHT @ p)
            moment += float(0.5 * (high - low) * _WEIGHT @ (p * (at - touch.place)))
    return force, moment


def _at(segment: tuple[float, float, float, float], y: FloatArray | float) -> FloatArray | float:
    a, ga, b, gb = segment
    return ga + (gb - ga) * (y - a) / (b - a)


def _meet(one: tuple[float, float, float, float], other: tuple[float, float, float, float]) -> list[float]:
    slope = (one[3] - one[1]) / (one[2] - one[0]), (other[3] - other[1]) / (other[2] - other[0])
    if slope[0] == slope[1]:
        return []
    return [(other[1] - slope[1] * other[0] - one[1] + slope[0] * one[0]) / (slope[0] - slope[1])]


def _bearing(
    a: float, b: float, ground: tuple[float, float, float, float] | None, touch: Touch, hardness: float, stiff: float
) -> list[tuple[float, float]]:
    """The part of [a, b] in which the snow pushes: on it the pressure is straight."""
    if ground is None:
        return [(a, b)]

    def push(y: float) -> float:
        base = float(touch.base(y))
        return float(hardness * max(base, float(_at(ground, y))) - stiff * max(0.0, float(_at(ground, y)) - base))

    at_a, at_b = push(a), push(b)
    if at_a <= 0.0 and at_b <= 0.0:
        return []
    if at_a > 0.0 and at_b > 0.0:
        return [(a, b)]
    zero = a + (b - a) * at_a / (at_a - at_b)
    return [(a, zero)] if at_a > 0.0 else [(zero, b)]
