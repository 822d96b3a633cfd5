"""Lieu and Mote (1984, J. Glaciol. 30(104), 77-81; 1985, ASTM STP 860, 117-140): ice cut at negative rake angles.

They machined ice, gave an empirical formula for the force and proposed to scale it for snow. The scale is in
Mössner and others (2013), the ranges and the direction of the force in the abstract of 1984.

Notes
-----
The coefficients of the formula are not here: we have not seen them printed. A user brings them.
"""

from __future__ import annotations

from typing import Final

from ..._support.units import DEGREE, MM

SOURCE: Final = "Lieu and Mote 1984, 1985"
SNOW_OVER_ICE: Final = 0.02
"""Force on snow over force on ice, as proposed for snow."""
CUTTING_DEPTH_RANGE: Final = (0.0, 1.0 * MM)
"""Depth of the cuts in ice (m)."""
EDGE_ANGLE_RANGE: Final = (30.0 * DEGREE, 75.0 * DEGREE)
"""Rake angles -60° to -15° as edge angles, ϑ = 90° + rake angle (rad)."""
