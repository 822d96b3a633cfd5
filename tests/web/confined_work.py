"""Work for a process of its own: a module that is imported quickly there."""

import ctypes
import os
import time

from skisnow._support.errors import FieldDataError


def other_process(word: str) -> tuple[str, int]:
    return word, os.getpid()


def refuse() -> None:
    raise FieldDataError(["a row is missing"])


def dies() -> None:
    ctypes.string_at(0)


def is_wrong() -> None:
    raise ZeroDivisionError


def takes_memory() -> int:
    return len(bytearray(400_000_000))


def takes_time() -> None:
    while True:
        time.sleep(0.01)
