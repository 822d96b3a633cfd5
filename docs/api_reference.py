"""Python reference from the names that packages publish, written when the pages are built."""

from __future__ import annotations

import importlib
import inspect
from collections.abc import Iterator
from pathlib import Path

FILE = Path(__file__).resolve().parent / "_generated" / "api.rst"
PACKAGES = {
    "skisnow": "The package",
    "skisnow.campaign": "Campaigns",
    "skisnow.campaign.records": "Records of a campaign",
    "skisnow.campaign.store": "Store",
    "skisnow.estimation": "Estimation",
    "skisnow.statistics": "Statistics",
    "skisnow.snow": "Snow",
    "skisnow.geometry.tools": "Tools",
    "skisnow.forces.penetration": "Penetration laws",
    "skisnow.forces.shear": "Shear laws",
    "skisnow.forces.friction": "Friction laws",
    "skisnow.forces.drag": "Drag",
    "skisnow.design": "Design",
    "skisnow.studies": "Studies",
    "skisnow.scenario": "Scenarios",
    "skisnow.simulation.run": "Runs",
    "skisnow.skier": "Skier",
    "skisnow.contact": "Contact",
    "skisnow.dynamics": "Dynamics",
    "skisnow.racing": "Races",
    "skisnow.track.course": "Courses",
    "skisnow.comparison": "Comparison of tracks",
    "skisnow.identification": "Identification",
    "skisnow.replay": "Replay",
    "skisnow.interop": "Other programs",
    "skisnow.campaign.caaml": "Snow profiles",
}
"""Packages and modules in the order of the page, with their headings."""


def reference() -> str:
    """Headings and autodoc directives; each object is under the first name that publishes it."""
    seen: set[int] = set()
    return "\n".join(line for name, title in PACKAGES.items() for line in _section(name, title, seen))


def _section(package: str, title: str, seen: set[int]) -> Iterator[str]:
    module = importlib.import_module(package)
    yield from (title, "-" * len(title), "")
    for name in _names(module):
        value = getattr(module, name)
        if id(value) in seen or not callable(value):
            continue
        seen.add(id(value))
        kind = "function"
        if inspect.isclass(value):
            kind = "exception" if issubclass(value, Exception) else "class"
        yield f".. auto{kind}:: {package}.{name}"
        yield from ("   :members:", "") if kind == "class" else ("",)


def _names(module: object) -> list[str]:
    """Published names, or the public objects that a module defines."""
    own = [name for name, value in vars(module).items() if getattr(value, "__module__", "") == module.__name__]
    return list(getattr(module, "__all__", [name for name in own if not name.startswith("_")]))


def write_reference(file: Path = FILE) -> None:
    """Write the reference, which the page includes."""
    file.parent.mkdir(exist_ok=True)
    file.write_text(reference(), encoding="utf-8")
