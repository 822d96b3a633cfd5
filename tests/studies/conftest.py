"""A study of the test's own text."""

from pathlib import Path

import pytest


@pytest.fixture
def study_file(tmp_path: Path, request: pytest.FixtureRequest) -> Path:
    """The file of the module's TEXT."""
    path = tmp_path / "study.toml"
    path.write_text(request.module.TEXT, encoding="utf-8")
    return path
