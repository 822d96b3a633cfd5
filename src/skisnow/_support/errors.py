"""Errors and warnings of skisnow, one class for each kind.

Each message names the place, the problem, what is allowed and how to fix it. Programs and tests use `code` instead of
the wording.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence


class SkisnowError(Exception):
    """Base class of all errors of skisnow.

    Attributes
    ----------
    code
        Identifier that does not change with the wording, such as ``contradiction``; empty without one.
    """

    def __init__(self, message: str = "", *, code: str = "") -> None:
        super().__init__(message)
        self.code = code


class ParameterError(SkisnowError, ValueError):
    """An argument is outside what the called function can work with."""


class FieldDataError(SkisnowError):
    """A campaign cannot be used as it is.

    Parameters
    ----------
    problems
        Every problem found, errors and others, each printable as one sentence. The message holds the first of them.
    """

    SHOWN = 20

    def __init__(self, problems: Sequence[object]) -> None:
        self.problems = tuple(problems)
        shown = [str(problem) for problem in self.problems[: self.SHOWN]]
        more = len(self.problems) - len(shown)
        super().__init__("\n".join([*shown, f"… and {more} more problems"] if more else shown))


class FitError(SkisnowError):
    """A fit has no answer: too few data, or data that do not determine it."""


class SolverError(SkisnowError):
    """A simulation cannot begin: nothing was computed."""


class StoreError(SkisnowError):
    """The store of campaigns cannot do what was asked; nothing in it was changed."""


class OutputError(SkisnowError):
    """A file could not be written; nothing half-written was left behind."""


class RangeWarning(UserWarning):
    """A relation is used outside the range in which it was measured: the number is computed all the same."""


class ModelLimitWarning(UserWarning):
    """The model is known to be wrong for an input; `code` says for which.

    Parameters
    ----------
    text
        The reason, and what to do.
    code
        One of the codes of `skisnow.scenario.plausibility`.
    """

    def __init__(self, text: str, code: str) -> None:
        super().__init__(text, code)
        self.code = code

    def __str__(self) -> str:
        return str(self.args[0])


class FitWarning(UserWarning):
    """A fit has an answer of which fewer digits are known than a reader would take for granted."""
