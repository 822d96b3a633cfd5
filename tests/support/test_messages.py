"""Errors and messages."""

import copy
import math
import pickle
from dataclasses import dataclass, field
from datetime import date, datetime
from pathlib import Path

import numpy as np
import pytest
from build_backend.messages import SOURCES, faults, languages, unread_templates

from skisnow._support.arrays import content_bytes
from skisnow._support.errors import FieldDataError, ModelLimitWarning, ParameterError, RangeWarning, SkisnowError
from skisnow._support.messages import Message, count_message, joined, translated, translations
from skisnow._support.units import in_degrees_if_radians, unit_of_name, without_unit

NESTED = Message("{first} and {second}", first=Message("Low"), second="Low")
"""A message of the sources inside another; the same word as text of a user."""


@pytest.mark.parametrize("language", languages())
def test_every_template_has_its_translation(language: str) -> None:
    assert faults(language) == []


def test_every_template_is_one_literal_that_is_extracted() -> None:
    assert {path.name: lines for path in SOURCES.rglob("*.py") if (lines := unread_templates(path.read_bytes()))} == {}
    composed = ('f"{size} m"', '"low" if deep else "high"', 'words or "low"', '"low " + words')
    assert [unread_templates(f"Message({text})") for text in composed] == [[1]] * 4
    assert [unread_templates(f"Message({text})") for text in ('"{size} m"', 'words["low"]', "low if a else b")] == [
        []
    ] * 3


@pytest.mark.parametrize(
    ("value", "english", "german"),
    [
        (1.5, "1.5", "1,5"),
        (10.0, "10", "10"),
        (-0.25, "-0.25", "−0,25"),
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
    assert Message("{low:-g} to {high:-g}", low=-180.5, high=5.0) == "−180.5 to 5"


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
    assert (str(received), received.text("de")) == ("'Law(0.2)' and Low: Law(0.2)", "'Law(0.2)' and Niedrig: Law(0.2)")


@pytest.mark.parametrize("count", [0, 1, 20])
def test_up_to_twenty_problems_all_are_in_the_message(count: int) -> None:
    error = FieldDataError([f"problem {number}" for number in range(count)])
    assert str(error).splitlines() == [f"problem {number}" for number in range(count)]
    assert error.problems == tuple(f"problem {number}" for number in range(count))


def test_of_more_the_first_stand_there_and_the_others_are_counted() -> None:
    error = FieldDataError(list(range(23)))
    assert str(error).splitlines() == [*map(str, range(20)), "… and 3 more problems"]
    assert len(error.problems) == 23


def test_kinds_are_caught_as_what_python_calls_them() -> None:
    assert issubclass(ParameterError, ValueError)
    assert issubclass(ParameterError, SkisnowError)
    assert issubclass(RangeWarning, UserWarning)


SIZES = {
    "H_V_N_per_mm3": ("N/mm³", 1e9), "c_N_s_per_mm3": ("N s/mm³", 1e9), "S_f_N_per_mm2": ("N/mm²", 1e6),
    "H_e_N_per_mm": ("N/mm", 1e3), "density_kg_per_m3": ("kg/m³", 1.0), "line_kg_per_m": ("kg/m", 1.0),
    "g_m_per_s2": ("m/s²", 1.0), "speed_m_per_s": ("m/s", 1.0), "mu_1_s_per_m": ("s/m", 1.0),
    "k_per_rad": ("1/rad", 1.0), "rate_per_s": ("1/s", 1.0), "I_kg_m2": ("kg m²", 1.0), "EI_N_m2": ("N m²", 1.0),
    "twist_Nm_per_deg": ("N m/°", 180.0 / math.pi), "angle_deg": ("°", math.pi / 180.0), "width_mm": ("mm", 1e-3),
    "output_ms": ("ms", 1e-3), "moment_Nm": ("N m", 1.0), "area_m2": ("m²", 1.0), "mass_kg": ("kg", 1.0),
    "air_C": ("°C", 1.0), "load_N": ("N", 1.0), "x_m": ("m", 1.0), "time_s": ("s", 1.0), "age_h": ("h", 3600.0),
}  # fmt: skip


@pytest.mark.parametrize("name", SIZES)
def test_a_name_ends_with_its_unit(name: str) -> None:
    symbol, size = SIZES[name]
    found = unit_of_name(name)
    assert found.symbol == symbol
    assert found.size == pytest.approx(size, rel=1e-15)
    stem = without_unit(name)
    assert name.startswith(f"{stem}_")
    assert unit_of_name(stem).symbol == ""


def test_each_of_a_list_has_the_unit_of_the_list() -> None:
    assert unit_of_name("widths_mm[3]").symbol == "mm"
    assert unit_of_name("mu_0[m]").symbol == ""
    assert without_unit("mu_0") == "mu_0"


def test_angles_that_look_like_radians() -> None:
    assert in_degrees_if_radians(1.59) == pytest.approx(math.degrees(1.59))
    assert in_degrees_if_radians(1.6) is None
    assert in_degrees_if_radians(-0.5) is None
    assert in_degrees_if_radians(0.0) is None


@dataclass
class Pole:
    """Fields that count, and values computed from them."""

    x: float
    names: tuple[str, ...] = ()
    found: float = field(init=False, default=0.0)


@dataclass
class Flag:
    """The same fields under another name."""

    x: float
    names: tuple[str, ...] = ()


def test_kind_fields_and_parts_count_and_what_was_worked_out_does_not() -> None:
    pole = Pole(1.5, ("a", "b"))
    assert list(content_bytes(pole)) == [b"Pole", b"1.5", b"'a'", b"'b'"]
    other = Pole(1.5, ("a", "b"))
    other.found = 7.0
    assert list(content_bytes(other)) == list(content_bytes(pole))
    assert list(content_bytes(Flag(1.5, ("a", "b")))) != list(content_bytes(pole))
    assert list(content_bytes(Pole(1.5, ("a",)))) != list(content_bytes(pole))


def test_an_array_is_its_bytes_and_a_class_its_name() -> None:
    values = np.array([1.0, 2.0])
    assert list(content_bytes([values, [3]])) == [values.tobytes(), b"3"]
    assert list(content_bytes(Pole)) == [repr(Pole).encode()]
