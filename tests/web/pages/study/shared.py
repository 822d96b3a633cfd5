"""Helpers that the tests of this folder share."""

import json
import tomllib
from typing import Any

from ..desk import Desk, Sheet

OF, FIRST, SECOND = "What is studied", "First input", "Second input"
FROM, TO, VALUES, LOG = (f"{FIRST}: {each}" for each in ("from", "to", "number of values", "even in the logarithm"))
FROM_2, TO_2, VALUES_2 = (f"{SECOND}: {each}" for each in ("from", "to", "number of values"))
ANGLE, LOAD, RATIO = "Edge angle ϑ (°)", "Load (N)", "Unloading ratio k_u/H_V"
HARDNESS, STRESS = "Snow hardness H_V (N/mm³)", "Failure shear stress S_f (N/mm²)"
ENDS, WAY, SPEED = "Ends after (s)", "Ends after a way of (m)", "Speed at the start v (m/s)"
BUTTON = "button[main] Start the study"
TURN = {"ski": "carver", "load_N": 800.0, "H_V_N_per_mm3": 0.2, "S_f_N_per_mm2": 0.5, "unloading_ratio": 10.0}


def jobs(desk: Desk) -> list[dict[str, Any]]:
    """Contents of the queue, the newest first."""
    found = [json.loads(place.read_text(encoding="utf-8")) for place in desk.lab.runs.glob("studies/*/job.json")]
    return sorted(found, key=lambda job: str(job["asked_at"]), reverse=True)


def asked(desk: Desk, page: Sheet) -> tuple[dict[str, Any], dict[str, Any]]:
    """Press the button; the job and the file of the study."""
    before = len(jobs(desk))
    page.press("Start the study")
    page.until(lambda: len(jobs(desk)) > before)
    job = jobs(desk)[0]
    page.shows(f"[status good] {job['name']} is in the queue.")
    return job, tomllib.loads((desk.lab.runs / "studies" / job["name"] / "study.toml").read_text(encoding="utf-8"))


def refused(desk: Desk, page: Sheet) -> str:
    """Press the button; code of the error why nothing was begun."""
    page.press("Start the study")
    page.shows("[status bad] ")
    assert jobs(desk) == []
    return desk.code


def number_of_points(page: Sheet) -> str:
    """The text behind the button; empty without one."""
    lines = page.outline()
    line = lines[lines.index(BUTTON) + 1]
    return line.removeprefix("[quiet] ") if line.startswith("[quiet] ") else ""


def scenario(desk: Desk, name: str = "carved-46m") -> Sheet:
    page = desk.open("/study")
    page.fill(OF, name)
    return page
