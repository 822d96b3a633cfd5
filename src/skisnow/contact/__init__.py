"""Skis in history-dependent (plastic) snow: forces at a pose, and the snow after a step.

``SnowField`` is the snow, ``Runner`` the shape of a sliding body, ``SnowContact`` any number of runners in one snow,
each with its own pose. Friction, shear and penetration follow any law of `skisnow.forces`, also your own; ``Laws``
passes them to a simulated turn.
"""

from __future__ import annotations

from .c_library import c_header, c_library
from .contact_state import ContactState
from .laws import Laws
from .runner import Runner
from .snow_contact import ContactForces, Sections, SnowContact
from .snow_field import SnowField

__all__ = [
    "ContactForces",
    "ContactState",
    "Laws",
    "Runner",
    "Sections",
    "SnowContact",
    "SnowField",
    "c_header",
    "c_library",
]
