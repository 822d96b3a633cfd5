"""CAAML out and in: what is written is read again, and what the standard cannot hold is refused."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.campaign.caaml import read_caaml
from skisnow.campaign.snow_pit import DepthTemperature, SnowLayer, SnowPit
from skisnow.interop.caaml import caaml_text, write_caaml
from tests.coded import Coded, coded, raises

from .pits import full_pit


def same(first: SnowPit, second: SnowPit) -> bool:
    forces = zip(first.forces, second.forces, strict=True)
    together = all(
        a.method == b.method and np.allclose(a.depth, b.depth, atol=1e-15) and np.array_equal(a.force, b.force)
        for a, b in forces
    )
    return together and replace(first, forces=()) == replace(second, forces=())


def test_a_pit_comes_back_as_it_was_and_a_bare_pit_comes_back_as_it_was(tmp_path: Path) -> None:
    assert same(read_caaml(write_caaml(full_pit(), tmp_path / "pit.caaml")), full_pit())
    bare = SnowPit(name="x", time="2026-02-03", observer="B")
    assert same(read_caaml(write_caaml(bare, tmp_path / "pit.xml")), bare)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"time": ""}, "missing"),
        ({"time": "yesterday"}, coded("missing", time="yesterday")),
        (
            {"layers": (SnowLayer(0.0, hardness="very hard"),)},
            coded("cannot_write", field="hand hardness", value="very hard"),
        ),
        ({"layers": (SnowLayer(0.0, grain_form="piste"),)}, coded("cannot_write", field="grain form", value="piste")),
        ({"temperatures": (DepthTemperature(0.0, 1.5),)}, "cannot_write"),
    ],
)
def test_what_the_standard_cannot_hold_is_rejected(changes: dict[str, object], words: str | Coded) -> None:
    with raises(ParameterError, words):
        caaml_text(replace(full_pit(), **changes))  # type: ignore[arg-type]


def test_control_characters_do_not_spoil_the_file(tmp_path: Path) -> None:
    pit = replace(full_pit(), comment="a\x00b\x1bc")
    assert read_caaml(write_caaml(pit, tmp_path / "pit.xml")).comment == "a b c"
