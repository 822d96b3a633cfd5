"""MuJoCo: the snow as a passive force of a model, and skis as MJCF."""

from __future__ import annotations

from .mjcf import rigid_ski_geoms, ski_mjcf, write_ski_mjcf
from .snow_forces import SnowForces

__all__ = ["SnowForces", "rigid_ski_geoms", "ski_mjcf", "write_ski_mjcf"]
