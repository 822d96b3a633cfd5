"""Progress: nothing for a second; then one line that is written over, or in a log a line every ten seconds."""

import re
import time

import pytest

from skisnow.cli.output import Progress, announced


@pytest.fixture(autouse=True)
def patient() -> None:
    """As its users have it."""


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    now = [100.0]
    monkeypatch.setattr("skisnow.cli.output.time.monotonic", lambda: now[0])
    return now


def said(clock: list[float], *moments: float) -> None:
    with Progress() as progress:
        for moment in moments:
            clock[0] = 100.0 + moment
            progress("x" * (10 - int(moment)))


def test_a_second_of_patience_and_ten_seconds_between(clock: list[float], capsys: pytest.CaptureFixture[str]) -> None:
    said(clock, 0.0, 0.99, 1.0, 5.0, 10.9, 9.0)
    assert capsys.readouterr().err == f"{'x' * 9}\n"
    clock[0] = 200.0
    with Progress() as progress:
        for moment in (0.0, 1.0, 10.9, 11.0, 20.9, 21.0):
            clock[0] = 200.0 + moment
            progress(f"{moment:g}")
    assert capsys.readouterr().err == "1\n11\n21\n"


def test_on_a_terminal_one_line_is_written_over(
    clock: list[float], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    said(clock, 0.9, 1.0, 1.4, 2.0, 3.0)
    assert capsys.readouterr().err == f"\r{'x' * 9}\r{'x' * 8} \r{'x' * 7} \r{' ' * 7}\r"
    said(clock, 0.5)
    assert capsys.readouterr().err == ""


def test_a_line_is_cut_to_the_terminal(
    clock: list[float], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A line of its whole width would wrap, and the next would leave it standing."""
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    monkeypatch.setenv("COLUMNS", "20")
    with Progress() as progress:
        clock[0] += 1.0
        progress("y" * 40)
    assert capsys.readouterr().err == f"\r{'y' * 18}…\r{' ' * 19}\r"


def test_what_is_counted_says_how_long_it_takes(
    clock: list[float], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two runs in four seconds: the eight that are left take sixteen."""
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    monkeypatch.setenv("COLUMNS", "80")
    with Progress() as progress:
        for moment, done in ((1.0, 0), (3.0, 1), (5.0, 2), (22.0, 11)):
            clock[0] = 100.0 + moment
            progress(f"run {done} of 10")
        clock[0] += 1.0
        progress("writing report.html")
    texts = [text.strip() for text in capsys.readouterr().err.split("\r") if text.strip()]
    numbers = [[int(number) for number in re.findall(r"\d+", text)] for text in texts]
    assert numbers == [[0, 10], [1, 10, 18], [2, 10, 16], [11, 10], []]


def test_what_tells_nothing_of_itself_is_announced(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    with announced("quick"):
        pass
    with announced("slow", patience_s=0.0, usual_s=10.0):
        time.sleep(0.05)
    assert capsys.readouterr().err == "slow … about 10 s\n"
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    with announced("slow", patience_s=0.0, usual_s=10.0):
        time.sleep(0.05)
    text = "slow … 0 s of about 10 s"
    assert capsys.readouterr().err == f"\r{text}\r{' ' * len(text)}\r"


def test_a_program_that_reads_the_lines_has_them_at_once(
    clock: list[float], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SKISNOW_PROGRESS_LINES", "1")
    said(clock, 1.0, 1.25, 1.5)
    assert len(capsys.readouterr().err.splitlines()) == 2
