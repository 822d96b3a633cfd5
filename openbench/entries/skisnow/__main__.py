"""``python -m openbench.entries.skisnow [--fast|--finest] CASE_FOLDER RESULT``."""

from __future__ import annotations

import sys

from ..files import main
from . import carve, glide, pressing, sand, turn
from .effort import DEFAULT, FAST, FINEST

EFFORT = FINEST if "--finest" in sys.argv else FAST if "--fast" in sys.argv else DEFAULT

main(
    EFFORT.name,
    {
        "01-plate": lambda case: pressing.plate(case, EFFORT),
        "02-edge": lambda case: pressing.edge(case, EFFORT),
        "03-cycles": lambda case: pressing.cycles(case, EFFORT),
        "04-glide": lambda case: glide.solve(case, EFFORT),
        "05-sand": sand.solve,
        "06-carve": lambda case: carve.solve(case, EFFORT),
        "07-turn": lambda case: turn.solve(case, EFFORT),
        "08-crossing": lambda case: pressing.crossing(case, EFFORT),
    },
    {},
)
