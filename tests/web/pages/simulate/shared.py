"""Helpers that the tests of this folder share."""

import json
from pathlib import Path
from typing import Any

from ...campaign_texts import HARD, SHEARED, SOFT, pressed
from ..desk import Desk, Sheet

GIVEN = "as in the scenario"
NUMBERS = "the numbers below"
HARDNESS, STRESS = "Snow hardness H_V (N/mm³)", "Failure shear stress S_f (N/mm²)"
ENDS, WAY, SPEED = "Ends after (s)", "Ends after a way of (m)", "Speed at the start v (m/s)"
STEERS, MASS, STANCE = "Steers by", "Mass of the sledge m (kg)", "Stance width (m)"
PENETRATION = pressed({"1": ("A", SOFT), "2": ("A", SOFT), "3": ("B", HARD)})


def jobs(desk: Desk) -> list[dict[str, Any]]:
    """Contents of the queue, the newest first."""
    found = [json.loads(place.read_text(encoding="utf-8")) for place in desk.lab.runs.glob("*/job.json")]
    return sorted(found, key=lambda job: str(job["asked_at"]), reverse=True)


def asked(desk: Desk, page: Sheet) -> dict[str, Any]:
    """Press the button; the queue after that."""
    before = len(jobs(desk))
    page.press("Simulate")
    page.until(lambda: len(jobs(desk)) > before)
    job = jobs(desk)[0]
    page.shows(f"[status good] {job['title']} is in the queue.")
    return job


def refused(desk: Desk, page: Sheet) -> str:
    """Press the button; code of the error why nothing was begun."""
    page.press("Simulate")
    page.shows("[status bad] ")
    return desk.code


def campaign(desk: Desk, folder: Path, *, shear: str = "") -> str:
    """The id of a kept campaign with two sites."""
    files = {"campaign.toml": SHEARED, "penetration.csv": PENETRATION} | ({"shear.csv": shear} if shear else {})
    return desk.kept(folder, files)
