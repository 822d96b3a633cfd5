"""Loads that glide friction may act on, and its direction."""

from __future__ import annotations

import abc
from typing import Final, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError
from ..parameter_checks import GLIDE_FRICTION, CheckedParameters

ActsOn: TypeAlias = Literal["snow-normal", "base-normal"]
"""The load along the snow's normal, or that square on the base, side force included: docs/methods/snow-options.md."""

Direction: TypeAlias = Literal["vector", "along-ski"]
"""Against the sliding velocity, or along the ski at any slip angle: docs/methods/snow-options.md."""


COMPARISON_SPEED: Final = 10.0
"""Speed (m/s) at which a new law is compared with the measured range (modelling assumption: an ordinary
speed on skis)."""


class FrictionLaw(CheckedParameters, abc.ABC):
    """Friction of a ski that glides along its length: μ(v) times the normal force, against the sliding.

    A rival law is one frozen dataclass in a separate file, entered in ``LAWS``; it gives ``_coefficient``.
    Measured on skis: 0.023-0.139 over more than 200 runs (Wolfsperger and others 2021). When a law is made, its μ at
    10 m/s is compared with that; μ = 0 is friction switched off and not warned of.
    """

    __slots__ = ()

    def coefficient(self, speed: npt.ArrayLike) -> FloatArray:
        """Coefficient of friction μ (≥ 0) at a sliding speed v (m/s, ≥ 0), any shape.

        Raises ParameterError: a speed is negative, or the law gives a negative coefficient at one of the speeds.
        """
        v = np.asarray(speed, float)
        if np.any(v < 0):
            raise ParameterError("speed is {speed!r} m/s; a sliding speed is at least 0").tag(
                "out_of_range", speed=float(v.min())
            )
        mu = self._coefficient(v)
        if np.any(mu < 0):
            fastest = float(v.flat[int(np.argmin(mu))])
            raise ParameterError(
                "{kind}: the coefficient of friction is negative at {fastest:g} m/s: {law!r} would push the ski; use "
                "other parameters or lower speeds"
            ).tag("negative_friction", kind=type(self).__name__, fastest=fastest, law=self)
        return mu

    def friction_force(self, normal_force: npt.ArrayLike, sliding_velocity: npt.ArrayLike) -> FloatArray:
        """Force (N) of the snow on the ski, -μ(v) F_n v/v, against the sliding velocity.

        normal_force: F_n (N), shape (...). Below 0 the ski is off the snow and the friction is 0.
        sliding_velocity: Velocity (m/s) of the ski over the snow, shape (..., d) with d components.
        Returns: Shape (..., d).

        Notes
        -----
        At rest the force is 0: its direction is not determined, and up to μ(0) F_n it is static friction. A simulation
        that stops or starts must treat rest itself, for example by a smooth step over a small speed.
        """
        velocity = np.asarray(sliding_velocity, float)
        speed = np.hypot.reduce(velocity, axis=-1)  # also where squares underflow
        size = self.coefficient(speed) * np.maximum(np.asarray(normal_force, float), 0.0)
        direction = np.divide(velocity, speed[..., None], out=np.zeros(velocity.shape), where=speed[..., None] > 0)
        result: FloatArray = -size[..., None] * direction
        return result

    def _check_further(self) -> None:
        """Compare μ at the comparison speed with the measured range."""
        mu = self._coefficient(np.asarray(COMPARISON_SPEED))
        if np.any(mu != 0):
            GLIDE_FRICTION.warn_outside(mu, f"{type(self).__name__} at {COMPARISON_SPEED:g} m/s", stacklevel=4)

    @abc.abstractmethod
    def _coefficient(self, speed: FloatArray) -> FloatArray:
        """μ at speeds of at least 0."""
