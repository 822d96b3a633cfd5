"""Rows as text: whose they are, where they end, who writes them."""

from __future__ import annotations

from pathlib import Path

import pytest

from skisnow.errors import OutputError
from skisnow.parallel.former_rows import HEAD, fingerprint_of_text, rows_of_text


@pytest.mark.parametrize(
    ("content", "fingerprint"),
    [
        (HEAD + b"abc \n1 {}\n", "abc"),
        (HEAD + b"abc", ""),
        (HEAD[:7], ""),
        (b"", ""),
        (b"skisnow batch 2 abc\n", None),
        (b"other", None),
        (b"other\n", None),
        (HEAD + 300 * b"a" + b"\n", ""),
    ],
)
def test_whose_rows_a_text_has(content: bytes, fingerprint: str | None, tmp_path: Path) -> None:
    place = tmp_path / "rows"
    place.write_bytes(content)
    assert fingerprint_of_text(place) == fingerprint


@pytest.mark.parametrize("torn", [b'3{"c": 3}\n', b'x {"c": 3}\n', b'3 {"c": 3\n'])
def test_rows_of_a_text_end_at_the_first_that_is_torn(torn: bytes, tmp_path: Path) -> None:
    place = tmp_path / "rows"
    place.write_bytes(HEAD + b'abc\n1 {"a": 1}\n2 {"b": 2}\n' + torn + b'4 {"d": 4}\n5 {"e"')
    with rows_of_text(place) as rows:
        assert list(rows) == [(1, '{"a": 1}'), (2, '{"b": 2}')]


def test_rows_that_another_writes_are_left_to_it(tmp_path: Path) -> None:
    fcntl = pytest.importorskip("fcntl")
    place = tmp_path / "rows"
    place.write_bytes(HEAD + b"abc\n")
    with place.open("rb") as other:
        fcntl.flock(other.fileno(), fcntl.LOCK_EX)
        with pytest.raises(OutputError, match="being written by another run"), rows_of_text(place):
            pass
    with rows_of_text(place) as rows:
        assert list(rows) == []
    for read in (fingerprint_of_text, lambda path: rows_of_text(path).__enter__()):
        with pytest.raises(OutputError):
            read(tmp_path / "none")


def test_a_last_row_without_its_end_is_torn(tmp_path: Path) -> None:
    place = tmp_path / "rows"
    place.write_bytes(HEAD + b'abc\n1 {"a": 1}\n2 {"b": 2}')
    with rows_of_text(place) as rows:
        assert list(rows) == [(1, '{"a": 1}')]
