"""Helpers that the tests of this folder share."""

import asyncio
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from skisnow.web.campaign_analysis import choosable_flags

from ...campaign_texts import HARD, SHEARED, SOFT, pressed, sheared
from ..desk import Desk, Sheet

TOML = SHEARED
PENETRATION = pressed(
    {"1": ("A", SOFT), "2": ("A", SOFT), "3": ("B", HARD), "4": ("B", HARD[:2]), "5": ("A", SOFT)}, {"5": "slipped"}
)  # 4 has fewer than three loads
SHEAR = sheared({"a": ("A", 20), "1": ("A", 21), "c": ("B", 30)})
FILES = {"campaign.toml": TOML, "penetration.csv": PENETRATION, "shear.csv": SHEAR}
FLAGS = choosable_flags()
COUNTED = "5 penetration experiments (3 used), 3 shear experiments (3 used), 2 sites."


@dataclass
class Drawing:
    """Do the work of the other process in this one; figures wait for the gate."""

    gate: asyncio.Event = field(default_factory=asyncio.Event)
    asked: list[Any] = field(default_factory=list)
    reports: list[Any] = field(default_factory=list)
    done: int = 0
    """Figures that are there."""
    held: int = 0
    """Only figures of so many points wait; 0: all."""


def points(analysis: Any) -> int:
    return sum(row["used"] for row in analysis.results["penetration"]["experiments"])


def kept(desk: Desk, folder: Path, files: dict[str, str] | None = None) -> str:
    """The id of a kept campaign that no other test has: what was analysed stays in memory."""
    texts = files or FILES
    return desk.kept(folder, texts | {"campaign.toml": f"{texts['campaign.toml']}# {folder}\n"})


def status(page: Sheet) -> str:
    return next(line for line in page.outline() if line.startswith("[status] "))[9:]


WRONG = {"campaign.toml": TOML, "penetration.csv": PENETRATION.replace("30,40,2.1", "30,-40,2.1", 1)}
