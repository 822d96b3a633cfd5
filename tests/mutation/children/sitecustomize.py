"""Loaded by every Python that a test starts while `tests.mutation.reach` looks: it writes down what is called there.

The file named by CURRENT holds the test that runs now: a server that tests share is asked by one after another.
"""

import os
import sys
import threading
import time

CURRENT, CALLS, SOURCE = (os.environ.get(f"SKISNOW_TESTS_REACH_{name}", "") for name in ("CURRENT", "CALLS", "SOURCE"))
LOOK_EACH_S = 0.01


class Calls:
    """Appends each function to the file of calls, once for each test."""

    def __init__(self) -> None:
        self.file = os.open(CALLS, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o600)
        self.test, self.looked = "", 0.0
        self.known: set[tuple[str, int]] = set()

    def seen(self, frame: object, _event: str, _told: object) -> None:
        """Of each call."""
        code = frame.f_code  # type: ignore[attr-defined]
        if not code.co_filename.startswith(SOURCE):
            return
        now = time.monotonic()
        if now - self.looked > LOOK_EACH_S:
            self._look(now)
        called = (code.co_filename, code.co_firstlineno)
        if called not in self.known:
            self.known.add(called)
            os.write(self.file, f"{self.test}\t{called[0]}\t{called[1]}\n".encode())

    def _look(self, now: float) -> None:
        self.looked = now
        with open(CURRENT, encoding="utf-8") as stream:  # noqa: PTH123 - every process waits for what is loaded here
            test = stream.read()
        if test != self.test:
            self.test, self.known = test, set()


if CALLS and "PYTEST_CURRENT_TEST" in os.environ:  # not in the process of the tests themselves
    calls = Calls()
    sys.settrace(calls.seen)
    threading.settrace(calls.seen)
