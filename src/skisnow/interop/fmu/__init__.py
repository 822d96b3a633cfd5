"""Functional mock-up units (FMI 2.0 and 3.0) for co-simulation, without Python in them.

``write_contact_fmu``: rigid skis in the snow of a scenario, pose and motion in, force and moment out.
``write_sledge_fmu``: its whole sledge on flexible skis, a push in, motion and forces on the boots out.
"""

from __future__ import annotations

from .writing import write_contact_fmu, write_sledge_fmu

__all__ = ["write_contact_fmu", "write_sledge_fmu"]
