"""A body that glides down a plane with constant friction and drag, in closed form; ℓ = m/(ρ C_dA).

v = v∞ tanh(φ), φ = φ₀ + t v∞/(2ℓ), s = 2ℓ ln(cosh φ / cosh φ₀), so t = (2ℓ/v∞) (arcosh(cosh φ₀ e^{s/2ℓ}) - φ₀).
"""

import math
from typing import Any

import numpy as np

GRAVITY, DENSITY = 9.81, 1.2


def passage_times(station: Any, *, mu: Any, drag_area: Any, speed: Any, mass: float, angle: float) -> Any:
    """t(s) for a start below the terminal speed; complex numbers pass through, for derivatives by complex steps."""
    length = mass / (DENSITY * drag_area)
    terminal = np.sqrt(2.0 * GRAVITY * length * (math.sin(angle) - mu * math.cos(angle)))
    phase = np.arctanh(speed / terminal)
    return 2.0 * length / terminal * (np.arccosh(np.cosh(phase) * np.exp(station / (2.0 * length))) - phase)


def derivatives(station: Any, *, mass: float, angle: float, mu: float, drag_area: float, speed: float) -> Any:
    """dt/dmu, dt/dC_dA, dt/dv₀, (n, 3), exact to rounding: complex steps."""
    tiny = 1e-30
    columns = []
    for moved in ({"mu": mu + 1j * tiny}, {"drag_area": drag_area + 1j * tiny}, {"speed": speed + 1j * tiny}):
        own: dict[str, Any] = {"mu": mu, "drag_area": drag_area, "speed": speed}
        own |= moved
        columns.append(np.imag(passage_times(station, mass=mass, angle=angle, **own)) / tiny)
    return np.column_stack(columns)
