"""Reading of .c3d files that are packed by hand, whole and damaged."""

from __future__ import annotations

import random
import struct
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.interop.opensim import read_c3d
from tests.coded import Coded, coded, raises

from .c3d_files import BLOCK, DEC, INTEL, MIPS, c3d_bytes

POINTS = np.arange(18.0).reshape(2, 3, 3) - 4.0
TEXTS = {"LABELS": ("heel", "toe"), "UNITS": ("cm",)}


def read(folder: Path, content: bytes) -> object:
    (folder / "a.c3d").write_bytes(content)
    return read_c3d(folder / "a.c3d")


@pytest.mark.parametrize("processor", [INTEL, DEC, MIPS])
@pytest.mark.parametrize("scale", [-1.0, 0.5])
def test_places_are_metres_and_frames_seconds(tmp_path: Path, processor: int, scale: float) -> None:
    """Frames count from the first one's number; points beyond the names are not markers."""
    (tmp_path / "a.c3d").write_bytes(c3d_bytes(POINTS, TEXTS, first=6, processor=processor, scale=scale))
    found = read_c3d(tmp_path / "a.c3d")
    assert (found.names, found.rate, found.time.tolist()) == (("heel", "toe"), 50.0, [0.1, 0.12])
    assert found.place == pytest.approx(1e-2 * POINTS[:, :2])


def test_a_marker_that_was_not_seen_has_no_place(tmp_path: Path) -> None:
    residual = np.array([[0.0, -1.0, 0.0], [0.1, 0.2, 0.0]])
    (tmp_path / "a.c3d").write_bytes(c3d_bytes(POINTS, TEXTS, residual=residual))
    seen = np.isfinite(read_c3d(tmp_path / "a.c3d").place).all(axis=2)
    assert seen.tolist() == [[True, False], [True, True]]


@pytest.mark.parametrize(
    ("texts", "named"),
    [
        ({"LABELS": (), "UNITS": ("mm",)}, "out_of_range"),
        ({"LABELS": ("a",), "UNITS": ("inch",)}, coded("out_of_range", unit="inch")),
    ],
)
def test_no_markers_or_an_unknown_unit(tmp_path: Path, texts: dict[str, tuple[str, ...]], named: str | Coded) -> None:
    with raises(ParameterError, named):
        read(tmp_path, c3d_bytes(POINTS, texts))


def put(offset: int, content: bytes) -> bytes:
    sound = c3d_bytes(POINTS, TEXTS)
    return sound[:offset] + content + sound[offset + len(content) :]


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\x02",
        put(1, b"\x51"),
        put(0, b"\x00"),
        put(0, b"\xff"),
        put(2, struct.pack("<H", 65535)),  # points
        put(4, struct.pack("<H", 65535)),  # analogue values
        put(8, struct.pack("<H", 65534)),  # last frame
        put(6, struct.pack("<H", 9)),  # first frame behind the last
        put(16, struct.pack("<H", 0)),  # place of the frames
        put(16, struct.pack("<H", 65535)),
        put(BLOCK + 3, b"\x00"),  # processor
        put(BLOCK + 4 + 7, struct.pack("<h", -5)),  # distance to the next parameter
        put(BLOCK + 4 + 7, struct.pack("<h", 30000)),
        c3d_bytes(POINTS, TEXTS)[:-1],
    ],
)
def test_a_damaged_file_names_itself(tmp_path: Path, content: bytes) -> None:
    with raises(ParameterError, "cannot_read"):
        read(tmp_path, content)


def test_no_byte_of_the_head_does_more_than_spoil_the_file(tmp_path: Path) -> None:
    """Each byte in turn becomes 0, 255, 128 and a random one."""
    sound, rng = c3d_bytes(POINTS, TEXTS), random.Random(1)
    for at in (*range(24), *range(BLOCK, BLOCK + 70)):
        for value in (0, 255, 128, rng.randrange(256)):
            try:
                read(tmp_path, sound[:at] + bytes([value]) + sound[at + 1 :])
            except ParameterError as error:
                assert "a.c3d" in str(error)
