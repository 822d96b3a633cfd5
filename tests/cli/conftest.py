"""What tests of the command line need."""

from __future__ import annotations

import math

import pytest

from skisnow.cli.progress import Progress


@pytest.fixture(autouse=True)
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """No progress is told unless a test asks for it: on a busy machine what takes milliseconds may take a second."""
    assert Progress.__init__.__kwdefaults__ is not None
    monkeypatch.setitem(Progress.__init__.__kwdefaults__, "patience_s", math.inf)
