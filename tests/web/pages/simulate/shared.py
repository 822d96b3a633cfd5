"""What the tests of this room share."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..desk import Desk, Sheet

GIVEN = "as in the scenario"
NUMBERS = "the numbers below"
HARDNESS, STRESS = "Snow hardness H_V (N/mm³)", "Failure shear stress S_f (N/mm²)"
ENDS, WAY, SPEED = "Ends after (s)", "Ends after a way of (m)", "Speed at the start v (m/s)"
STEERS, MASS, STANCE = "Steers by", "Mass of the sledge m (kg)", "Stance width (m)"
CAMPAIGN = """name = "Desk"
[[tool]]
name = "ski piece"
shape = "ski"
length_mm = 200
width_mm = 62
[[plate]]
name = "blade"
length_mm = 100
"""
PENETRATION = "experiment,site,tool,edge_angle_deg,load_N,depth_mm\n" + "".join(
    f"{name},{site},ski piece,30,{load},{depth}\n"
    for name, site, depths in (("1", "A", (1.5, 2.1, 2.6)), ("2", "A", (1.5, 2.1, 2.6)), ("3", "B", (1.0, 1.4, 1.7)))
    for load, depth in zip((20, 40, 60), depths, strict=True)
)


def jobs(desk: Desk) -> list[dict[str, Any]]:
    """What the queue holds, the newest first."""
    found = [json.loads(place.read_text(encoding="utf-8")) for place in desk.lab.runs.glob("*/job.json")]
    return sorted(found, key=lambda job: str(job["asked_at"]), reverse=True)


def asked(desk: Desk, page: Sheet) -> dict[str, Any]:
    """Press the button; what stands in the queue then."""
    before = len(jobs(desk))
    page.press("Simulate")
    page.until(lambda: len(jobs(desk)) > before)
    job = jobs(desk)[0]
    page.shows(f"[status] {job['name']} is in the queue.")
    return job


def refused(page: Sheet) -> str:
    """Press the button; why nothing was begun."""
    page.press("Simulate")
    return page.shows("[status bad] ")


def campaign(desk: Desk, folder: Path, *, shear: str = "") -> str:
    """The id of a kept campaign with two sites."""
    folder.mkdir()
    (folder / "campaign.toml").write_text(CAMPAIGN, encoding="utf-8")
    (folder / "penetration.csv").write_text(PENETRATION, encoding="utf-8")
    if shear:
        (folder / "shear.csv").write_text(shear, encoding="utf-8")
    return desk.lab.store.add(folder).id
