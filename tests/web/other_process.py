"""Work for another process: a module that is imported quickly there."""

import ctypes
import os

from skisnow._support.errors import FieldDataError


def other_process(word: str) -> tuple[str, int]:
    return word, os.getpid()


def refuse() -> None:
    raise FieldDataError(["a row is missing"])


def dies() -> None:
    ctypes.string_at(0)
