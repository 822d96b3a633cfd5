"""What tests of several rooms need."""

from __future__ import annotations

import os
import signal
from itertools import count

import pytest

# read when NumPy is loaded: small matrices in several threads wait for each other longer than they compute, and two
# processes test at once
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from skisnow.report.figures.drawing import Drawing, Picture

# what is started in the background is told to ignore Ctrl-C, which tests of an interrupt would wait for
signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what drives a browser."""
    for item in items:
        if "chromium" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.browser)


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """An empty picture, each another, in place of every figure: a figure takes a second, and these tests read words."""
    number = count()

    def empty(drawing: Drawing) -> Picture:
        svg = f'<svg xmlns="http://www.w3.org/2000/svg"><!-- {next(number)} --></svg>'
        return Picture(drawing.name, drawing.whole_caption, drawing.alt, drawing.wide, svg, svg.encode())

    for place in ("figures", "pictures"):
        monkeypatch.setattr(f"skisnow.report.{place}.pictured", empty)
