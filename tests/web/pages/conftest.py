"""A lab at a desk: its pages, in this process."""

from collections.abc import Iterator

import pytest

from skisnow._support.errors import SkisnowError

from . import desk as desks
from .desk import Desk


@pytest.fixture(scope="session")
def kept_desk(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Desk]:
    """The framework holds pages per process: one lab in each."""
    with desks.desk(tmp_path_factory.mktemp("desk")) as made:
        yield made


@pytest.fixture
def desk(kept_desk: Desk, noted_errors: list[SkisnowError]) -> Iterator[Desk]:
    """An empty lab; no handler may fail unless the test removes the failure."""
    kept_desk.empty()
    kept_desk.errors = noted_errors
    yield kept_desk
    assert kept_desk.failures == []
