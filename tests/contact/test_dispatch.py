"""What a contact says of itself; the widest instruction set of this processor is used, whatever compiler built it."""

from __future__ import annotations

import platform
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from skisnow.compiled import core
from skisnow.contact import ContactForces, Sections, SnowContact, SnowField

from .conftest import straight

CPUINFO = Path("/proc/cpuinfo")


@pytest.mark.skipif(
    platform.machine() != "x86_64" or not CPUINFO.exists(),
    reason="the processor's flags are read where Linux lists them",
)
def test_every_instruction_set_of_this_processor_is_found() -> None:
    flags = next(line for line in CPUINFO.read_text().splitlines() if line.startswith("flags")).split()
    expected = ["baseline"]
    expected += ["avx2"] if "avx2" in flags else []
    expected += ["avx512"] if {"avx512f", "avx512dq", "avx512vl"} <= set(flags) else []
    assert core.instruction_sets() == expected


def test_a_contact_tells_which_it_uses() -> None:
    """The one that is asked for; the last, widest one where none is."""
    found = core.instruction_sets()
    for asked in (None, *found):
        contact = SnowContact(SnowField(2e8, 5e5, 10.0), [straight()], instruction_set=asked)
        assert contact.instruction_set == (asked or found[-1])


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
