"""Errors and warnings by code and fields, whatever their wording."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any, NamedTuple, TypeVar

import pytest

from skisnow._support.errors import SkisnowError, SkisnowWarning

E = TypeVar("E", bound=SkisnowError | SkisnowWarning)


class Coded(NamedTuple):
    """Code and some of the fields of an expected error."""

    code: str
    fields: dict[str, Any]


def coded(code: str, **fields: Any) -> Coded:
    """Expected code and fields, for tables of tests."""
    return Coded(code, fields)


@contextmanager
def raises(kind: type[E], expected: str | Coded, /, **fields: Any) -> Iterator[pytest.ExceptionInfo[E]]:
    """Require an error with this code and these fields; those of messages inside the message count as well."""
    with pytest.raises(kind) as caught:
        yield caught
    _require(caught.value, expected, fields)


@contextmanager
def warns(kind: type[SkisnowWarning], expected: str | Coded, /, **fields: Any) -> Iterator[pytest.WarningsRecorder]:
    """Require a warning with this code and these fields."""
    with pytest.warns(kind) as caught:
        yield caught
    every = [warning.message for warning in caught if isinstance(warning.message, kind)]
    code = expected if isinstance(expected, str) else expected.code
    _require(next((warning for warning in every if warning.code == code), every[0]), expected, fields)


def all_fields(message: object) -> dict[str, Any]:
    """Fields of a message or an error, with those of the messages in its fields; the outer ones first."""
    own: Mapping[str, Any] = getattr(message, "fields", {})
    inner = {name: value for field in own.values() for name, value in all_fields(field).items()}
    return {**inner, **own}


def _require(error: SkisnowError | SkisnowWarning, expected: str | Coded, fields: Mapping[str, Any]) -> None:
    code, wanted = (expected, fields) if isinstance(expected, str) else expected
    found = all_fields(error)
    assert (error.code, {name: found.get(name) for name in wanted}) == (code, dict(wanted)), str(error)
