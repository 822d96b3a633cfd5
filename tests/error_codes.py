"""Errors of skisnow as tests check them: by class and code."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from skisnow._support.errors import SkisnowError


@contextmanager
def raises_code(kind: type[SkisnowError], code: str) -> Iterator[pytest.ExceptionInfo[SkisnowError]]:
    """Check that the block raises an error of this class with this code."""
    with pytest.raises(kind) as caught:
        yield caught
    assert caught.value.code == code, caught.value
