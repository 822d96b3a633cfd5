"""Messages in two languages: numbers, dates and nested messages; every template has its translation."""

from __future__ import annotations

import copy
import pickle
from datetime import date, datetime
from pathlib import Path

import pytest
from build_backend.messages import faults, languages

from skisnow._support.errors import FieldDataError, ModelLimitWarning, ParameterError
from skisnow._support.messages import Message, count_message, joined, translated, translations

NESTED = Message("{first} and {second}", first=Message("Low"), second="Low")
"""A message of the sources inside another; the same word as text of a user."""


@pytest.mark.parametrize("language", languages())
def test_every_template_has_its_translation(language: str) -> None:
    assert faults(language) == []


@pytest.mark.parametrize(
    ("value", "english", "german"),
    [
        (1.5, "1.5", "1,5"),
        (10.0, "10", "10"),
        (-0.25, "-0.25", "-0,25"),
        (1e-9, "1e-09", "1e-09"),
        (12, "12", "12"),
        (True, "True", "True"),
        ("1.5", "1.5", "1.5"),
        (Path("a.b/1.5"), "a.b/1.5", "a.b/1.5"),
        ((1.5, 3), "[1.5, 3]", "[1,5; 3]"),
        ([1.5, 3], "1.5, 3", "1,5; 3"),
        (["Low", "b"], "Low, b", "Low, b"),
        ([Message("Low"), Message("Full")], "Low, Full", "Niedrig, Voll"),
        (date(2026, 3, 5), "5 Mar 2026", "5. 3. 2026"),
        (datetime(2026, 3, 5, 9, 7), "5 Mar 2026, 09:07", "5. 3. 2026, 09:07"),
        (None, "None", "None"),
        (ParameterError(Message("Low")), "Low", "Niedrig"),
    ],
)
def test_values_are_written_as_in_the_language(value: object, english: str, german: str) -> None:
    assert (translated(value, "en"), translated(value, "de")) == (english, german)
    message = Message("<{value}>", value=value)
    assert (message, message.text("de")) == (f"<{english}>", f"<{german}>")


def test_a_format_keeps_the_decimal_sign_of_the_language() -> None:
    assert Message("{depth:.2f} mm", depth=1.0).text("de") == "1,00 mm"
    assert Message("{value!r}", value="1.5").text("de") == "'1.5'"


def test_messages_in_messages_are_translated_and_text_is_not() -> None:
    assert (NESTED, NESTED.text("de")) == ("Low and Low", "Niedrig and Low")
    assert joined([Message("Low"), Message("Full")], "; ").text("de") == "Niedrig; Voll"


def test_one_and_several_have_their_own_words() -> None:
    more = [count_message("… and {count} more problem", "… and {count} more problems", count=n) for n in (1, 2)]
    assert more == ["… and 1 more problem", "… and 2 more problems"]
    assert [each.text("de") for each in more] == ["… und 1 weiteres Problem", "… und 2 weitere Probleme"]


def test_an_empty_message_is_not_the_head_of_the_translations() -> None:
    assert translations("de").gettext("") != ""
    assert Message("").text("de") == ""


@pytest.mark.parametrize("kind", [ParameterError, ModelLimitWarning])
def test_code_and_fields_come_from_another_process(kind: type[ParameterError | ModelLimitWarning]) -> None:
    raised = kind(Message("{depth} at {place}", depth=1.5, place=Message("Low")), code="too_deep")
    for received in (pickle.loads(pickle.dumps(raised)), copy.deepcopy(raised)):
        assert (type(received), received.code, received.fields) == (kind, "too_deep", {"depth": 1.5, "place": "Low"})
        assert received.text("de") == "1,5 at Niedrig"


def test_problems_come_from_another_process() -> None:
    received = pickle.loads(pickle.dumps(FieldDataError([Message("Low")] * 22, code="problems")))
    assert (received.code, received.problems) == ("problems", ("Low",) * 22)
    assert received.text("de").splitlines()[19:] == ["Niedrig", "… und 2 weitere Probleme"]


def test_plain_text_has_no_fields() -> None:
    error = ParameterError("1.5 m")
    assert (error.code, error.fields, error.text("de")) == ("", {}, "1.5 m")


class Law:
    """An object that another process does not have."""

    def __reduce__(self) -> tuple[object, ...]:
        raise TypeError("not to be sent")

    def __repr__(self) -> str:
        return "Law(0.2)"


def test_objects_are_sent_as_their_text() -> None:
    message = Message("{law!r} and {error}: {laws}", law=Law(), error=ParameterError(Message("Low")), laws=[Law()])
    received = pickle.loads(pickle.dumps(message))
    assert (str(received), received.text("de")) == ("Law(0.2) and Low: Law(0.2)", "Law(0.2) and Niedrig: Law(0.2)")
