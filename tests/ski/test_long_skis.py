"""A ski that is too long to be tabulated is an error before memory is taken for it; so is a table without an end."""

from __future__ import annotations

import tracemalloc
from pathlib import Path

import pytest
from tests.coded import raises

from skisnow import read_ski
from skisnow._support.errors import ParameterError
from skisnow.ski.layout import LONGEST, layout_of_lengths

DESIGN = """{"board": {"name": "flat", "nose length": 20, "effective edge length": "%s", "tail length": 18.5,
"sidecut radius": "%s", "taper": "2mm", "waist width": "7.2cm", "edge shape": {"type": "Basic Arc"}}}"""
TOML = "mass_kg = 2.2\nEI_N_m2 = [100, 440, 100]\nGJ_N_m2 = [60, 175, 60]\n"


def most_bytes(path: Path) -> int:
    tracemalloc.start()
    try:
        with pytest.raises(ParameterError, match=path.parent.name):
            read_ski(path)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize(("edge", "radius"), [("900m", "900m"), ("120cm", "14m")])
def test_the_shape_of_another_program(tmp_path: Path, edge: str, radius: str) -> None:
    (tmp_path / "ski-def.json").write_text(
        (DESIGN % (edge, radius)).replace('"nose length": 20', '"nose length": "1e6m"')
    )
    path = tmp_path / "ski.toml"
    path.write_text('shape = "ski-def.json"\n' + TOML)
    assert most_bytes(path) < 10_000_000


def test_a_table_that_is_no_plain_file(tmp_path: Path) -> None:
    """/dev/zero has no end."""
    path = tmp_path / "ski.toml"
    path.write_text('table = "/dev/zero"\nrunning_length_mm = 1396\nsidecut_length_mm = 1458\n' + TOML)
    with raises(ParameterError, "cannot_read"):
        read_ski(path)


def test_the_longest_ski() -> None:
    assert layout_of_lengths(length=LONGEST, running_length=1.4, sidecut_length=1.46).running_length == 1.4
    with pytest.raises(ParameterError):
        layout_of_lengths(length=LONGEST + 0.01, running_length=1.4, sidecut_length=1.46)
