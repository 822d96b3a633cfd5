"""What a ski file and its table declare."""

from __future__ import annotations

import pytest

from skisnow._support.errors import ParameterError
from skisnow.ski.base_profile import BaseShape
from skisnow.ski.file_keys import BASE, COLUMNS, SKI_KEYS, SkiFile


def test_what_is_usual_is_allowed() -> None:
    for key in (*SKI_KEYS.values(), *COLUMNS.values()):
        if key.kind in ("number", "numbers"):
            assert key.usual is not None
            assert key.lowest <= key.usual[0] < key.usual[1] <= key.highest, key.name


def test_a_file_says_shape_stiffness_mass_and_where_the_rest_stands() -> None:
    assert len(SKI_KEYS) == 30
    assert {key.kind for key in SKI_KEYS.values()} == {"text", "number", "numbers", "switch"}
    assert all(SKI_KEYS[name].factor == 1e-3 for name in BASE)


def test_a_base_in_python_is_held_to_the_ranges_of_files() -> None:
    with pytest.raises(ParameterError, match=r"camber_mm is 60\.0; allowed is from -50 to 50 mm"):
        BaseShape(camber=0.06)


def test_defaults_in_si() -> None:
    empty = SkiFile()
    assert (empty.tail_overhang, empty.boot_position, empty.base_bevel, empty.edge_width) == (0.02, 0.0, 0.0, 0.002)
