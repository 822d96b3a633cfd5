"""The collector of reference cycles rests, and works afterwards as before."""

import gc
from collections.abc import Iterator

import pytest

from skisnow._support.environment import paused_collector


@pytest.fixture(autouse=True)
def _as_before() -> Iterator[None]:
    yield
    gc.enable()


def test_it_rests_and_works_again_even_after_an_error() -> None:
    with paused_collector():
        assert not gc.isenabled()
    assert gc.isenabled()

    def failed() -> None:
        with paused_collector():
            raise ValueError

    with pytest.raises(ValueError):
        failed()
    assert gc.isenabled()


def test_one_that_rested_before_goes_on_resting() -> None:
    gc.disable()
    with paused_collector():
        pass
    assert not gc.isenabled()
