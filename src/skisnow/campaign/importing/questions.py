"""Open questions of an import: skisnow's proposal, and the option that answers it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..._support.messages import Message
from ..problems import error

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ..problems import Problem
    from .sheets import Section


@dataclass(frozen=True, slots=True)
class Question:
    """A question that no heading, row of units or note answers.

    Attributes
    ----------
    option, key
        Option of the command, and the name before its equals sign.
    choices
        Possible answers; () for any text.
    proposed
        Answer that skisnow infers, or "".
    problem
        Error if it is not answered.
    """

    option: str
    key: str
    choices: tuple[str, ...]
    proposed: str
    problem: Problem


WORDS = {
    "table": Message("a stated table"),
    "column": Message("a stated column"),
    "unit": Message("a stated unit"),
    "site": Message("a stated site"),
    "tool": Message("a stated tool with its lengths and their unit"),
    "plate": Message("a stated length of the blade with its unit"),
    "cells": Message("a stated way of writing"),
    "ignore": Message("rows and notes without a doubt"),
}
"""Required statement of each option."""


def ask(
    option: str,
    key: str,
    section: Section | str,
    *,
    value: str | None = None,
    choices: tuple[str, ...] = (),
    proposed: str = "",
    row: int | None = None,
) -> Question:
    """Question with its error, which names the option."""
    answer = key if option == "ignore" else f"{key}={proposed or 'ANSWER'}" if key else proposed or "ANSWER"
    text = f'--{option} "{answer}"'
    action = (
        Message("State it in the file or by {option}. Choices: {choices}.", option=text, choices=list(choices))
        if choices
        else Message("State it in the file or by {option}.", option=text)
    )
    place = section if isinstance(section, str) else section.key
    problem = error("not_stated", place, row=row, column=key or None, value=value, allowed=WORDS[option], action=action)
    return Question(option, key, choices, proposed, problem)


def is_asked(questions: Iterable[Question | Problem], option: str, key: str) -> bool:
    """True if one of the questions has this option and key."""
    return any(isinstance(item, Question) and (item.option, item.key) == (option, key) for item in questions)
