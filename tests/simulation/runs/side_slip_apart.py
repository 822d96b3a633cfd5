"""Side-slip of a rigid sledge on its uphill edges, written apart from the core: a body in a plane, ground on a grid."""

import math

import numpy as np

from skisnow._support.arrays import FloatArray

GRAVITY = 9.81


def side_slip(
    *,
    mass: float,
    roll_inertia: float,
    slope: float,
    edge: float,
    hardness: float,
    strength: float,
    unloading_ratio: float,
    length: float,
    width: float,
    stance: float,
    duration: float,
) -> FloatArray:
    """Way (m) every 0.02 s from rest at the depth of balance; SI and radians.

    Each edge holds S_f e L from the start. Symplectic steps of 40 µs on places every 40 µm.
    """
    step, spacing, first = 4e-5, 4e-5, -stance - 0.1
    deepest = np.zeros(int(5.0 / spacing))
    grid = first + spacing * np.arange(len(deepest))
    balance = math.sqrt(mass * GRAVITY * math.cos(slope) * math.tan(edge) / (hardness * length))
    state = np.array([0.0, 0.5 * width * math.sin(edge) - balance, 0.0])  # way, height, roll
    rates, ways = np.zeros(3), []
    for number in range(round(duration / step)):
        if number % round(0.02 / step) == 0:
            ways.append(state[0])
        x, z, roll = state
        angle = edge + roll
        force = np.array([mass * GRAVITY * math.sin(slope), -mass * GRAVITY * math.cos(slope), 0.0])
        pressed = []
        for side in (-0.5 * stance, 0.5 * stance):
            depth = 0.5 * width * math.sin(angle) - z - side * math.sin(roll)
            at = x + side * math.cos(roll) - 0.5 * width * math.cos(angle)
            if depth <= 0.0:
                continue
            begin, end = (math.ceil((place - first) / spacing) for place in (at, at + depth / math.tan(angle)))
            places, under = grid[begin:end], slice(begin, end)
            reached = depth - (places - at) * math.tan(angle)
            lift = np.maximum(deepest[under] - reached, 0.0)
            pressure = np.maximum(hardness * (reached + lift) - unloading_ratio * hardness * lift, 0.0)
            share = pressure * length * spacing
            held = strength * depth * length
            force += [-held, share.sum(), float(share @ (places - x)) - (depth + z) * held]
            pressed.append((under, reached))
        for under, reached in pressed:
            deepest[under] = np.maximum(deepest[under], reached)
        rates += step * force / [mass, mass, roll_inertia]
        state = state + step * rates
    return np.array(ways)
