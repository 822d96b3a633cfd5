"""Errors and warnings of skisnow, one class for each kind, and suggestions for misspelt words.

Each message names the place, the problem, what is allowed and how to fix it. Programs and tests use `code` and `fields`
instead of the wording.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Self

from .messages import ENGLISH, Message, count_message, joined, languages, template, translated


def as_template(message: str, fields: Mapping[str, Any]) -> str:
    """`Message` of a text with fields; a `Message`, or a text with braces but without fields, is returned unchanged."""
    is_template = not isinstance(message, Message) and (fields or not {*"{}"} & {*message})
    return Message(message, **fields) if is_template else message


class _Coded(Exception):  # noqa: N818 -- of errors and warnings
    """Base of errors: a message, or a template with fields, and a code that does not change with the wording.

    >>> print(ParameterError("{name} is {value:g}; it must be above 0").tag("out_of_range", name="load", value=-1.0))
    load is -1; it must be above 0
    """

    def __init__(self, message: str = "", /, *, code: str = "") -> None:
        super().__init__(message)
        self.code = code

    def tag(self, code: str, /, **fields: Any) -> Self:
        """Set the code of the error and the fields of its template; returns the same error."""
        self.args = (as_template(self.message, fields),)
        self.code = code
        return self

    @property
    def message(self) -> str:
        """English text; a `Message` if it has a translation."""
        return self.args[0]

    @property
    def fields(self) -> Mapping[str, Any]:
        """Named values of the message; empty if it is plain text."""
        return self.message.fields if isinstance(self.message, Message) else {}

    def text(self, language: str = ENGLISH) -> str:
        """Message of the error in a language, by default English."""
        return translated(self.message, language)

    def at(self, place: object) -> Self:
        """New error with a place, such as a file or key, before the message of this one."""
        fields = {name: value for name, value in self.fields.items() if name not in ("place", "problem")}
        return type(self)(Message("{place}: {problem}", place=place, problem=self.message, **fields)).tag(self.code)


class SkisnowError(_Coded):
    """Base class of all errors of skisnow.

    Attributes
    ----------
    code
        Identifier that does not change with the wording, such as ``contradiction``; empty without one.
    """


class ParameterError(SkisnowError, ValueError):
    """An argument is outside the range that the called function accepts."""


class FieldDataError(SkisnowError):
    """A campaign cannot be used as it is.

    Parameters
    ----------
    problems
        Every problem found, errors and others, each printable as one sentence. The message holds the first of them.
        A `sentence` of a problem is its text without its code.
    """

    SHOWN = 20

    def __init__(self, problems: Sequence[object], *, code: str = "") -> None:
        self.problems = tuple(problems)
        super().__init__(joined(self._shown_problems(self.problems), "\n"), code=code)

    @property
    def sentences(self) -> list[Any]:
        """Sentences of the first problems without their codes, and the number of others."""
        return self._shown_problems([getattr(problem, "sentence", problem) for problem in self.problems])

    def _shown_problems(self, problems: Sequence[object]) -> list[object]:
        """The first problems up to the limit, then a line with the number of the others."""
        more = len(problems) - self.SHOWN
        rest = [count_message("… and {count} more problem", "… and {count} more problems", count=more)]
        return [*problems[: self.SHOWN], *(rest if more > 0 else [])]

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.problems,), self.__dict__


class FitError(SkisnowError):
    """A fit has no answer: too few data, or data that do not determine it."""


class SolverError(SkisnowError):
    """A simulation cannot begin: nothing was computed."""


class StoreError(SkisnowError):
    """An operation on the store of campaigns failed; nothing in the store was changed."""


class OutputError(SkisnowError):
    """A file could not be written; nothing half-written was left behind."""


class SkisnowWarning(_Coded, UserWarning):
    """Base class of all warnings of skisnow; `code` and `fields` as those of errors."""


class RangeWarning(SkisnowWarning):
    """A relation is used outside the range in which it was measured: the number is computed all the same."""


class ModelLimitWarning(SkisnowWarning):
    """The model is known to be wrong for an input; `skisnow.scenario.plausibility` lists the codes."""


class FitWarning(SkisnowWarning):
    """A fit succeeded, but fewer digits of its answer are certain than a reader would expect."""


def suggest_and_list(word: str, words_allowed: Iterable[str]) -> Message:
    """Question with the known word most similar to a misspelt one, and the list of all known words."""
    words = list(words_allowed)
    like = most_similar(word, words)
    if like is None:
        return Message("Allowed: {allowed}.", allowed=words)
    return Message("Did you mean {similar}? Allowed: {allowed}.", similar=like, allowed=words)


def suggest(word: str, words_allowed: Iterable[str]) -> str:
    """Question with the known word most similar to a misspelt one, followed by a space; empty without a similar one.

    >>> suggest("angel", ["angle", "mass"])
    'Did you mean angle? '
    """
    like = most_similar(word, words_allowed)
    return f"Did you mean {like}? " if like else ""


def most_similar(word: str, words_allowed: Iterable[str]) -> str | None:
    """The known word most similar to a misspelt one; None without a similar one."""
    by_small = {name.lower(): name for name in words_allowed}
    like = difflib.get_close_matches(word.lower(), by_small, n=1, cutoff=0.5)
    return by_small[like[0]] if like else None


_RANGES = {
    (False, False): template("{name} is {value:g}. Allowed: from {low:g} to {high:g}."),
    (True, False): template("{name} is {value:g}. Allowed: above {low:g}, at most {high:g}."),
    (False, True): template("{name} is {value:g}. Allowed: at least {low:g}, below {high:g}."),
    (True, True): template("{name} is {value:g}. Allowed: above {low:g} and below {high:g}."),
}
_HALF_RANGES = {
    False: template("{name} is {value:g}. Allowed: {low:g} or more."),
    True: template("{name} is {value:g}. Allowed: above {low:g}."),
}


def require_range(
    name: str, value: float, low: float, high: float = math.inf, *, above: bool = False, below: bool = False
) -> None:
    """Reject an argument outside its range; `above` and `below`: the ends themselves are outside, too."""
    if (low < value if above else low <= value) and (value < high if below else value <= high):
        return
    problem = _HALF_RANGES[above] if high == math.inf else _RANGES[above, below]
    raise ParameterError(problem).tag("out_of_range", name=name, value=value, low=low, high=high)


def require_choice(name: str, value: object, choices: Iterable[str]) -> None:
    """Reject a value that is not one of a parameter's choices."""
    words = list(choices)
    if value not in words:
        raise ParameterError("{name} is {value!r}. {allowed}").tag(
            "unknown_choice", name=name, value=value, allowed=suggest_and_list(str(value), words)
        )


def require_language(code: str) -> None:
    """Reject a language without translations, before long work is done for it."""
    if code not in languages():
        message = Message(
            "The language {language!r} is unknown. Allowed: {codes}.", language=code, codes=[*languages()]
        )
        raise ParameterError(message).tag("unknown_language")
