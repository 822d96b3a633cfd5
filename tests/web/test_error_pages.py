"""What a person is told about an error, and what the log keeps."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

pytest.importorskip("nicegui", reason="the web lab is not installed")

from starlette.requests import Request

from skisnow._support.errors import StoreError
from skisnow.web.layout import LOG, _notify, error_sentence, log_to, plain_page


@pytest.fixture
def log(tmp_path: Path) -> Iterator[Path]:
    """The lab's log file."""
    log_to(tmp_path / "lab.log")
    yield tmp_path / "lab.log"
    LOG.handlers[-1].close()
    LOG.handlers.pop()


def test_an_unforeseen_error_is_a_reference_that_the_log_knows(log: Path) -> None:
    try:
        raise KeyError("inner secret")
    except KeyError as error:
        said = error_sentence(error)
    assert "secret" not in said
    found = re.search(r"Reference: ([0-9a-f]{8})\.", said)
    assert found is not None
    written = log.read_text(encoding="utf-8")
    assert f"ERROR reference {found[1]}\n" in written
    assert "Traceback" in written


def test_what_no_page_can_show_stands_in_the_log(log: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """NiceGUI raises where a task belongs to no page."""

    def without_page(*_: object, **__: object) -> None:
        raise RuntimeError("the slot stack for this task is empty")

    monkeypatch.setattr("nicegui.ui.notify", without_page)
    _notify(StoreError("the disk is full"))
    assert log.read_text(encoding="utf-8").endswith(" INFO not shown on a page: the disk is full\n")


def test_our_own_errors_say_what_to_do() -> None:
    assert error_sentence(StoreError("The disk is full; free some space.")) == "The disk is full; free some space."


def test_what_users_wrote_is_escaped() -> None:
    request = Request({"type": "http", "headers": []})
    body = bytes(plain_page("<script>", "<img src=x onerror=alert(1)>", 400, request).body).decode()
    assert "<script" not in body
    assert "<img" not in body
