"""The registry lists every reader: a function that opens files and is in no reader fails here."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

import pytest

from skisnow._support.errors import SkisnowError

from .reader import Reader
from .registry import READERS
from .registry.openers import NO_READERS, openers

each_reader = pytest.mark.parametrize("reader", READERS, ids=lambda reader: reader.name)
COVERED = {name for reader in READERS for name in reader.covers}


def test_every_function_that_opens_files_is_in_the_registry() -> None:
    """Give a new one a reader in tests/fuzzing/registry, or, if its bytes are not a user's, a reason in NO_READERS."""
    found = openers()
    assert found - COVERED - NO_READERS.keys() == set()
    assert NO_READERS.keys() - found == set()
    assert {"track.read:_read_bytes", "ski.file_parts:file_values", "_support.sqlite_file:connect"} <= found


def test_a_function_has_a_reader_or_a_reason_and_not_both() -> None:
    assert COVERED & NO_READERS.keys() == set()
    assert len({reader.name for reader in READERS}) == len(READERS)


@contextmanager
def called(found: set[str]) -> Iterator[None]:
    """Collect the functions of skisnow that are called, in the form of `Reader.covers`."""

    def note(frame: FrameType, event: str, _: object) -> None:
        module = frame.f_globals.get("__name__", "")
        if event == "call" and module.startswith("skisnow."):
            found.add(f"{module.removeprefix('skisnow.')}:{frame.f_code.co_qualname.replace('<locals>.', '')}")

    sys.setprofile(note)
    try:
        yield
    finally:
        sys.setprofile(None)


@each_reader
def test_a_sound_file_is_read_by_the_functions_that_the_reader_covers(reader: Reader, tmp_path: Path) -> None:
    if not reader.is_ready:
        pytest.skip(f"it needs {', '.join(reader.needs)}")
    reader.lay(tmp_path)
    found: set[str] = set()
    with called(found):
        try:
            reader.read(tmp_path)
        except SkisnowError as error:
            pytest.fail(f"the sound file is rejected: {error}")
    assert set(reader.covers) - found == set()


@each_reader
def test_a_case_has_the_same_bytes_each_time_and_others_have_other_bytes(reader: Reader) -> None:
    if not reader.is_ready:
        pytest.skip(f"it needs {', '.join(reader.needs)}")
    cases = [reader.mutated(number) for number in range(6)]
    assert cases == [reader.mutated(number) for number in range(6)]
    assert len(set(cases)) > 3
    assert sum(case != reader.files()[reader.target] for case in cases) > 3
