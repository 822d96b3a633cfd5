"""Helpers for tests of the command line."""

import math

import pytest

from skisnow.cli.output import Progress


@pytest.fixture(autouse=True)
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """No progress is shown by default: on a busy machine milliseconds may become a second."""
    assert Progress.__init__.__kwdefaults__ is not None
    monkeypatch.setitem(Progress.__init__.__kwdefaults__, "patience_s", math.inf)
