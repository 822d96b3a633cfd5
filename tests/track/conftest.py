"""Helpers for tests of tracks."""

import pytest


@pytest.fixture
def pathless(monkeypatch: pytest.MonkeyPatch) -> None:
    """No estimate of the path, which takes most of the time of a track and gives only its speed and length."""
    monkeypatch.setattr("skisnow.track.curvature.estimate_path", lambda *_: None)
