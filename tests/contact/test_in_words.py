"""What a contact's results are in words: each number in its place and unit."""

from __future__ import annotations

from dataclasses import fields

import numpy as np

from skisnow.contact import ContactForces, Sections


def test_forces_and_moments_of_each_runner() -> None:
    assert repr(ContactForces(np.arange(1.0, 13.0).reshape(2, 6), ())).splitlines() == [
        "<ContactForces on 2 runners",
        "  runner 0  force (1, 2, 3) N, moment (4, 5, 6) N m",
        "  runner 1  force (7, 8, 9) N, moment (10, 11, 12) N m>",
    ]


def test_units_of_sections() -> None:
    """In the order of the fields, as their docstring has them; a sine, μ and a share have none."""
    units = (*"mmm", "", *"mmmm", *"NNNNNNN", "m/s", "m/s", "", "", "", "N", "N/m²", "", "")
    found = Sections(**{each.name: np.array([0.5, 2.0]) for each in fields(Sections)})._facts()
    assert [words for _, words in found.rows] == [f"2: 0.5 to 2 {unit}".rstrip() for unit in units]
