"""Progress: nothing for a second, then at most twice a second; one line on a terminal, a line each elsewhere."""

from __future__ import annotations

import pytest

from skisnow.cli.progress import Progress


@pytest.fixture(autouse=True)
def patient() -> None:
    """As its users have it."""


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    now = [100.0]
    monkeypatch.setattr("skisnow.cli.progress.time.monotonic", lambda: now[0])
    return now


def said(clock: list[float], *moments: float) -> None:
    with Progress() as progress:
        for moment in moments:
            clock[0] = 100.0 + moment
            progress("x" * (10 - int(moment)))


def test_a_second_of_patience_and_half_a_second_between(clock: list[float], capsys: pytest.CaptureFixture[str]) -> None:
    said(clock, 0.0, 0.99, 1.0, 1.49, 2.0, 2.25, 2.5)
    assert capsys.readouterr().err == f"{'x' * 9}\n{'x' * 8}\n{'x' * 8}\n"


def test_on_a_terminal_one_line_is_written_over(
    clock: list[float], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    said(clock, 1.0, 2.0, 3.0)
    assert capsys.readouterr().err == f"\r{'x' * 9}\r{'x' * 8} \r{'x' * 7} \n"
    said(clock, 0.5)
    assert capsys.readouterr().err == ""
