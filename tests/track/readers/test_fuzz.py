"""Files of every format, changed by seeded mutations that keep their form: a track or a refusal in our own words.

What grows with the square of a file's size shows here as a test that does not end: pieces are repeated by the thousand.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Final

import numpy as np
import pytest

from .receivers import fit_checksum, sentence
from .test_damage import FILES, require_track_or_our_error

Mutation = Callable[[np.random.Generator, bytes], bytes]
FRAGMENTS: Final = [
    b"9" * 400, b"1e400", b"-1e308", b"nan", b"-inf", b"0", b"", b",", b";", b"\t", b" ", b"\r", b"\n", b'"', b"%",
    b"$", b"*", b"\xb5\x62", b"\x00", b"\xff\xff\xff\xff", b"<", b"</", b"<a>", b"&#0;", b"0001/01/01 00:00:00",
    b"9999/12/31 23:59:60.9", b"0001-01-01T00:00:00+14:00", "\u00e4\u2212\u0660".encode(),
]  # fmt: skip


def _piece(rng: np.random.Generator, data: bytes) -> tuple[int, int]:
    begin, end = sorted(rng.integers(0, len(data) + 1, 2).tolist())
    return begin, min(end, begin + int(rng.integers(1, 60)))


def _bits(rng: np.random.Generator, data: bytes) -> bytes:
    changed = np.frombuffer(data, np.uint8).copy()
    for place in rng.integers(0, max(len(data), 1), int(rng.integers(1, 6))) if data else ():
        changed[place] ^= 1 << int(rng.integers(8))
    return changed.tobytes()


def _fragment(rng: np.random.Generator, data: bytes) -> bytes:
    begin, end = _piece(rng, data)
    return data[:begin] + FRAGMENTS[int(rng.integers(len(FRAGMENTS)))] + data[end if rng.integers(2) else begin :]


def _repeated(rng: np.random.Generator, data: bytes) -> bytes:
    begin, end = _piece(rng, data)
    return data[:begin] + data[begin:end] * int(rng.choice([2, 5, 2000])) + data[end:]


def _moved(rng: np.random.Generator, data: bytes) -> bytes:
    begin, end = _piece(rng, data)
    rest = data[:begin] + data[end:]
    place = int(rng.integers(len(rest) + 1))
    return rest[:place] + data[begin:end] + rest[place:]


def _spliced(rng: np.random.Generator, data: bytes) -> bytes:
    other = list(FILES.values())[int(rng.integers(len(FILES)))]
    return data[: int(rng.integers(len(data) + 1))] + other[int(rng.integers(len(other))) :]


def _cell(rng: np.random.Generator, data: bytes) -> bytes:
    """Another cell in place of one between separators."""
    for separator in rng.permutation([b",", b" ", b";", b"\n", b'"', b">"]).tolist():
        cells = data.split(separator)
        if len(cells) > 1:
            cells[int(rng.integers(len(cells)))] = FRAGMENTS[int(rng.integers(len(FRAGMENTS)))]
            return bytes(separator.join(cells))
    return data


MUTATIONS: Final[tuple[Mutation, ...]] = (_bits, _fragment, _repeated, _moved, _spliced, _cell)


def _sealed(name: str, data: bytes) -> bytes:
    """The file with right checksums again, so that what is behind them is reached."""
    if name.endswith(".fit") and len(data) > 16:
        body = data[14:-2]
        head = data[:4] + len(body).to_bytes(4, "little") + b".FIT"
        whole = head + fit_checksum(head).to_bytes(2, "little") + body
        return whole + fit_checksum(whole).to_bytes(2, "little")
    if name.endswith(".nmea"):
        lines = [line.strip().lstrip(b"$").split(b"*")[0] for line in data.split(b"\n")]
        return b"".join(sentence(line.decode("ascii")) if line.isascii() else line for line in lines)
    return data


def mutated(rng: np.random.Generator, name: str) -> bytes:
    data = FILES[name]
    for _ in range(int(rng.integers(1, 4))):
        data = MUTATIONS[int(rng.integers(len(MUTATIONS)))](rng, data)
    return _sealed(name, data) if rng.integers(2) else data


def fuzz(folder: Path, name: str, seeds: range) -> int:
    """How many of the changed files are tracks still; the others are refused."""
    path = folder / name
    tracks = 0
    for seed in seeds:
        path.write_bytes(mutated(np.random.default_rng([seed, len(name)]), name))
        try:
            tracks += require_track_or_our_error(path)
        except BaseException as error:
            error.add_note(f"{name}, seed {seed}")
            raise
    return tracks


@pytest.mark.parametrize("name", FILES)
def test_mutated_files(tmp_path: Path, name: str) -> None:
    assert fuzz(tmp_path, name, range(25)) < 25


@pytest.mark.slow
@pytest.mark.parametrize("name", FILES)
def test_mutated_files_by_the_thousand(tmp_path: Path, name: str) -> None:
    assert 0 < fuzz(tmp_path, name, range(25, 10_000)) < 9975
