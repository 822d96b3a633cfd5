"""What a person is told about an error, and what the log keeps."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

pytest.importorskip("nicegui", reason="the web lab is not installed")

from skisnow.errors import StoreError
from skisnow.web.trouble import LOG, log_to, plain_page, told


def test_an_unforeseen_error_is_a_reference_that_the_log_knows(tmp_path: Path) -> None:
    log_to(tmp_path / "lab.log")
    try:
        raise KeyError("inner secret")
    except KeyError as error:
        said = told(error)
    finally:
        LOG.handlers[-1].close()
        LOG.handlers.pop()
    assert "secret" not in said
    found = re.search(r"Reference: ([0-9a-f]{8})\.", said)
    assert found is not None
    log = (tmp_path / "lab.log").read_text(encoding="utf-8")
    assert found[1] in log
    assert "Traceback" in log


def test_our_own_errors_say_what_to_do() -> None:
    assert told(StoreError("The disk is full; free some space.")) == "The disk is full; free some space."


def test_what_users_wrote_is_escaped() -> None:
    body = bytes(plain_page("<script>", "<img src=x onerror=alert(1)>", 400).body).decode()
    assert "<script" not in body
    assert "<img" not in body
