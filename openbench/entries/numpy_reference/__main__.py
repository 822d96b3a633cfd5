"""``python -m openbench.entries.numpy_reference [--finest] CASE_FOLDER RESULT``."""

from __future__ import annotations

import sys

from ..files import main
from ..sand_fits import linear_in_depth
from . import carve, pressing, turn

FINEST = "--finest" in sys.argv
FINENESS = turn.Fineness(2.5e-4, 0.01, 1e-4) if FINEST else turn.Fineness(5e-4, 0.02, 2e-4)
KNOTS, ACROSS = (20, 120) if FINEST else (12, 100)

main(
    "numpy-finest" if FINEST else "numpy-reference",
    {
        "01-plate": pressing.plate,
        "02-edge": pressing.edge,
        "03-cycles": pressing.cycles,
        "04-glide": pressing.glide,
        "05-sand": linear_in_depth,
        "06-carve": lambda case: carve.solve(case, knots=KNOTS, across=ACROSS),
        "07-turn": lambda case: turn.solve(case, FINENESS),
        "08-crossing": pressing.crossing,
    },
    {},
)
