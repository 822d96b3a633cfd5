"""The rigid part of a sledge, its frames, and its mass matrix with two flexible skis."""

from .inertia import RigidSledge

__all__ = ["RigidSledge"]
