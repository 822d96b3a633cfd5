"""Former names work and say what they are called now, where the caller stands."""

import sys
import warnings
from pathlib import Path
from types import ModuleType

import pytest

from skisnow.former_names import former_attributes, formerly, with_former_keywords


def doubled(number: int) -> int:
    """Twice the number."""
    return 2 * number


def test_a_former_function_warns_where_it_is_called() -> None:
    twice = formerly("twice", doubled)
    assert (twice.__name__, twice.__qualname__, twice.__doc__) == ("twice", "twice", "Twice the number.")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        assert twice(4) == 8
    (warning,) = caught
    assert str(warning.message) == "twice is called doubled now; the former name goes with the next release"
    assert warning.category is DeprecationWarning
    assert Path(warning.filename) == Path(__file__)


@with_former_keywords(anew="restart", most="count")
def search(*, restart: bool = False, count: int = 3) -> tuple[bool, int]:
    """What was asked."""
    return restart, count


def test_former_keywords_each_warn_and_present_ones_do_not() -> None:
    with pytest.warns(DeprecationWarning) as caught:
        assert search(anew=True, most=5) == (True, 5)  # type: ignore[call-arg]
    assert sorted(str(each.message).partition(";")[0] for each in caught) == [
        "anew= of search is called restart= now",
        "most= of search is called count= now",
    ]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert search(restart=True) == (True, 3)


def test_a_part_of_a_package_under_its_former_name(monkeypatch: pytest.MonkeyPatch) -> None:
    room = ModuleType("room")
    room.present = 7  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "room", room)
    found = former_attributes("room", {"past": "present"})
    with pytest.warns(DeprecationWarning, match=r"room\.past is called room\.present now") as caught:
        assert found("past") == 7
    assert Path(caught[0].filename) == Path(__file__)
    with pytest.raises(AttributeError, match="module 'room' has no attribute 'present'"):
        found("present")
