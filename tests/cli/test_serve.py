"""`skisnow serve` where the web lab is not installed. What it serves is tested with the pages."""

from __future__ import annotations

import builtins
from typing import Any

import pytest

from skisnow.cli import main


@pytest.fixture
def missing(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Importing the server fails without this module."""
    imported = builtins.__import__

    def put(name: str | None) -> None:
        def importing(module: str, *others: Any, **named: Any) -> Any:
            if module == "web.server":
                raise ModuleNotFoundError("gone", name=name)
            return imported(module, *others, **named)

        monkeypatch.setattr(builtins, "__import__", importing)

    return put


def test_it_says_what_to_install(missing: Any, capsys: pytest.CaptureFixture[str]) -> None:
    missing("nicegui")
    assert main(["serve"]) == 1
    told = capsys.readouterr()
    assert "pip install 'skisnow[web]'" in told.err
    assert told.out == ""


@pytest.mark.parametrize("name", ["skisnow.web.server", "skisnow", None])
def test_a_part_of_our_own_is_not_to_be_installed(
    name: str | None, missing: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    missing(name)
    assert main(["serve"]) != 0
    assert "pip install" not in capsys.readouterr().err
