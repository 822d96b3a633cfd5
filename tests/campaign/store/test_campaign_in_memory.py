"""A campaign in memory is the one that an export of its journal gives."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from skisnow._support.errors import FieldDataError
from skisnow._support.messages import Message
from skisnow.campaign import campaign_of_files
from skisnow.campaign.store import (
    Journals,
    NewEntry,
    ReplayedCampaign,
    campaign_files,
    campaign_in_memory,
    replay_journal,
)
from skisnow.campaign.store.stored_tables import (
    ABOVE,
    ANY_NUMBER,
    AT_LEAST,
    BETWEEN,
    BRANCH_WORD,
    FORMS,
    LONGEST_TEXT,
    NAME,
    SHORT_LINE,
    CellError,
    checked_cell,
)

from .test_journal import TOML, reading

if TYPE_CHECKING:
    from skisnow.campaign.store import Store


def shear_test(name: str, depth: str) -> NewEntry:
    cells = {"experiment": name, "site": "A", "plate": "p", "edge_angle_deg": "90", "depth_mm": depth}
    cells |= {"lever_arm_mm": "250", "moment_Nm": "1.25", "remark": "=windy, cold"}
    return NewEntry(action="add", file="shear.csv", test=name, position=0, cells=cells, who="Ada")


def sample(name: str, density: str) -> NewEntry:
    cells = {"sample": name, "site": "A", "snow_density_kg_per_m3": density}
    return NewEntry(action="add", file="density.csv", test=name, position=0, cells=cells, who="Ada")


class Entered:
    """A journal that the tests append to."""

    def __init__(self, store: Store) -> None:
        self._journals = Journals(store)
        self._id = self._journals.begin(TOML)
        self._seen: dict[tuple[str, str], int] = {}

    def append(self, entry: NewEntry) -> int:
        key = entry.file, entry.test
        self._seen[key] = self._journals.append(self._id, entry, seen=self._seen.get(key, 0)).sequence
        return self._seen[key]

    @property
    def campaign(self) -> ReplayedCampaign:
        return replay_journal(self._journals.entries(self._id))


@pytest.fixture
def entered(store: Store) -> Entered:
    entered = Entered(store)
    for name, depths in {"1": ("1.5", "2.25", "3"), "2": ("1.4", "2.2", "2.9")}.items():
        for position, depth in enumerate(depths):
            entered.append(reading(name, position, str(20 * (position + 1)), depth))
    entered.append(shear_test("1", "5"))
    entered.append(sample("1", "300"))
    return entered


def cancellation(test: str) -> NewEntry:
    return NewEntry(action="cancel", file="penetration.csv", test=test, who="Ada", why="-tilted")


def exported(campaign: ReplayedCampaign) -> dict[str, bytes]:
    return {name: text.encode() for name, text in campaign_files(campaign).items()}


def assert_equal(ours: Any, theirs: Any) -> None:
    """Compare records, field by field where they hold arrays."""
    for each in fields(theirs):
        one, other = getattr(ours, each.name), getattr(theirs, each.name)
        if hasattr(other, "__dataclass_fields__"):
            assert_equal(one, other)
        elif isinstance(other, np.ndarray):
            np.testing.assert_array_equal(one, other)
        elif each.name != "file_hashes":
            assert one == other, each.name


def test_tables_problems_and_corrections_are_those_of_the_exported_files(entered: Entered) -> None:
    wrong = entered.append(reading("2", 3, "80", "33"))
    correction = NewEntry(
        action="correct",
        file="penetration.csv",
        test="2",
        about=wrong,
        cells={"depth_mm": "3.3"},
        who="Bea",
        why="decimal point",
    )
    entered.append(correction)
    entered.append(cancellation("1"))
    ours = campaign_in_memory(entered.campaign)
    assert [each.new for each in ours.corrections] == ["-tilted", "3.3"]
    assert ours.penetration is not None and ours.shear is not None and ours.density is not None
    assert_equal(ours, campaign_of_files(exported(entered.campaign)))


def test_an_undone_cancellation_has_no_effect(entered: Entered) -> None:
    about = entered.append(cancellation("1"))
    undo = NewEntry(action="undo", file="penetration.csv", test="1", about=about, who="Ada")
    entered.append(undo)
    assert campaign_in_memory(entered.campaign).corrections == ()
    assert_equal(campaign_in_memory(entered.campaign), campaign_of_files(exported(entered.campaign)))


def test_only_the_chosen_tests_are_in_it(entered: Entered) -> None:
    campaign = campaign_in_memory(entered.campaign, of=[entered.campaign.test("shear.csv", "1")])
    assert campaign.penetration is None
    assert campaign.shear is not None


@pytest.mark.parametrize("depth, tool", [("1,5x", "piece"), ("", "piece"), ("-1", "piece"), ("1.5", "another tool")])
def test_errors_are_those_of_the_exported_files(entered: Entered, depth: str, tool: str) -> None:
    entry = reading("3", 0, "20", depth)
    entered.append(replace(entry, cells={**entry.cells, "tool": tool}))
    with pytest.raises(FieldDataError) as theirs:
        campaign_of_files(exported(entered.campaign))
    with pytest.raises(FieldDataError) as ours:
        campaign_in_memory(entered.campaign)
    assert ours.value.problems == theirs.value.problems


def test_without_measurements_the_error_is_that_of_the_exported_files(store: Store) -> None:
    entered = Entered(store)
    with pytest.raises(FieldDataError) as theirs:
        campaign_of_files(exported(entered.campaign))
    with pytest.raises(FieldDataError) as ours:
        campaign_in_memory(entered.campaign)
    assert ours.value.problems == theirs.value.problems


# Cells as they are typed: which may be blank, which are refused, what is written down


PENETRATION = FORMS["penetration.csv"]


@pytest.mark.parametrize(
    ("column", "typed", "written"),
    [
        ("experiment", " P1 ", "P1"),
        ("spot", "", ""),
        ("remark", "", ""),
        ("snow_density_kg_per_m3", "350", "350"),
        ("snow_density_kg_per_m3", " ", ""),
        ("load_N", "70.5", "70.5"),
        ("load_N", "70,5", "70.5"),
        ("load_N", "70", "70"),
    ],
)
def test_what_is_written_down(column: str, typed: str, written: str) -> None:
    assert checked_cell(PENETRATION, column, typed) == written


@pytest.mark.parametrize(
    ("file", "column", "typed", "code", "fix"),
    [
        ("penetration.csv", "experiment", "  ", "empty", NAME),
        ("penetration.csv", "load_N", "", "empty", Message(ABOVE, low=0.0)),
        ("penetration.csv", "load_N", "0", "not_allowed", Message(ABOVE, low=0.0)),
        ("penetration.csv", "load_N", "1,234.5", "not_allowed", Message(ABOVE, low=0.0)),
        ("penetration.csv", "load_N", "seventy", "not_allowed", Message(ABOVE, low=0.0)),
        ("penetration.csv", "depth_mm", "-1", "not_allowed", Message(AT_LEAST, low=0.0)),
        ("penetration.csv", "edge_angle_deg", "90", "not_allowed", Message(BETWEEN[False, True], low=0.0, high=90.0)),
        ("penetration.csv", "air_temperature_C", "nan", "not_allowed", ANY_NUMBER),
        (
            "penetration.csv",
            "snow_density_kg_per_m3",
            "918",
            "not_allowed",
            Message(BETWEEN[True, False], low=0.0, high=917.0),
        ),
        ("shear.csv", "edge_angle_deg", "91", "not_allowed", Message(BETWEEN[True, False], low=0.0, high=90.0)),
        (
            "shear.csv",
            "turning_angle_deg",
            "361",
            "not_allowed",
            Message(BETWEEN[False, False], low=-360.0, high=360.0),
        ),
        ("penetration.csv", "remark", "x" * (LONGEST_TEXT + 1), "too_long", SHORT_LINE),
        ("penetration.csv", "remark", "two\nlines", "too_long", SHORT_LINE),
        ("penetration.csv", "branch", "sideways", "not_allowed", BRANCH_WORD),
    ],
)
def test_what_is_rejected(file: str, column: str, typed: str, code: str, fix: Message) -> None:
    with pytest.raises(CellError) as raised:
        checked_cell(FORMS[file], column, typed)
    error = raised.value
    assert (error.code, error.column, error.value, error.fix) == (code, column, typed.strip(), fix)
    assert error.fix.fields == pytest.approx(fix.fields)


def test_both_sentences_are_in_german_with_the_name_of_the_field() -> None:
    error = CellError("not_allowed", "depth_mm", "2,o", Message(AT_LEAST, low=0.5))
    assert error.problem(error.code, "Tiefe").text("de") == "Tiefe: „2,o“ ist nicht erlaubt. Eine Zahl ab 0,5 eingeben."


def test_the_longest_text_is_taken() -> None:
    assert checked_cell(PENETRATION, "remark", "x" * LONGEST_TEXT) == "x" * LONGEST_TEXT
