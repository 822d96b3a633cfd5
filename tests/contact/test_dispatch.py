"""The widest instruction set of this processor is used, whatever compiler built the core."""

from __future__ import annotations

import platform
from pathlib import Path

import pytest

from skisnow.compiled import core
from skisnow.contact import SnowContact, SnowField

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
