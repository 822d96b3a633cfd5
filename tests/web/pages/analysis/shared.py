"""What the tests of this room share."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skisnow.web.analysing import choosable_flags

if TYPE_CHECKING:
    from ..desk import Desk, Sheet

TOML = """name = "Desk"
[[tool]]
name = "ski piece"
shape = "ski"
length_mm = 200
width_mm = 62
[[plate]]
name = "blade"
length_mm = 100
"""
SERIES = {
    "1": ("A", "", (1.5, 2.1, 2.6)),
    "2": ("A", "", (1.5, 2.1, 2.6)),
    "3": ("B", "", (1.0, 1.4, 1.7)),
    "4": ("B", "", (1.0, 1.4)),  # fewer than three loads
    "5": ("A", "slipped", (1.5, 2.1, 2.6)),
}
PENETRATION = "experiment,site,tool,edge_angle_deg,load_N,depth_mm,status\n" + "".join(
    f"{name},{site},ski piece,30,{20 * number},{depth},{status}\n"
    for name, (site, status, depths) in SERIES.items()
    for number, depth in enumerate(depths, start=1)
)
SHEAR = "experiment,site,plate,edge_angle_deg,depth_mm,lever_arm_mm,moment_Nm\n" + "".join(
    f"{name},{site},blade,90,5,250,{moment}\n"
    for name, site, moment in (("a", "A", 20), ("1", "A", 21), ("c", "B", 30))
)
FILES = {"campaign.toml": TOML, "penetration.csv": PENETRATION, "shear.csv": SHEAR}
FLAGS = choosable_flags()
COUNTED = "5 penetration experiments, 3 used; 3 shear experiments, 3 used."


@dataclass
class Drawing:
    """What the other process would do is done in this one; figures wait for the gate."""

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
    folder.mkdir()
    for name, text in (files or FILES).items():
        (folder / name).write_text(text, encoding="utf-8")
    with (folder / "campaign.toml").open("a", encoding="utf-8") as file:
        file.write(f"# {folder}\n")
    return desk.lab.store.add(folder).id


def status(page: Sheet) -> str:
    return next(line for line in page.outline() if line.startswith("[status] "))[9:]


WRONG = {"campaign.toml": TOML, "penetration.csv": PENETRATION.replace("30,40,2.1", "30,-40,2.1", 1)}
