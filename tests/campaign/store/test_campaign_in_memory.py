"""A campaign in memory, and two entries that contradict each other."""

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest
from tests.key_names import SNOW_DENSITY

from skisnow._support.errors import FieldDataError
from skisnow.campaign import campaign_of_files
from skisnow.campaign.store import (
    Journals,
    NewEntry,
    ReplayedCampaign,
    Store,
    campaign_files,
    campaign_in_memory,
    replay_journal,
    sync,
)
from skisnow.campaign.store import conflict as conflict_module
from skisnow.campaign.store.conflict import Conflict, EntryIndex, Side, _shorten_text
from skisnow.campaign.store.journal import JournalEntry
from skisnow.campaign.store.stored_tables import (
    BRANCH_WORD,
    FORMS,
    LONGEST_TEXT,
    NAME,
    SHORT_LINE,
    CellError,
    checked_cell,
)

from .test_journal import TOML, reading
from .test_syncing import Laptop, ada, bo, both_sync, shared


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
        action="correct", file="penetration.csv", test="2", about=wrong, cells={"depth_mm": "3.3"}, who="Bea",
        why="decimal point",
    )  # fmt: skip
    entered.append(correction)
    entered.append(cancellation("1"))
    ours = campaign_in_memory(entered.campaign)
    assert [each.new for each in ours.corrections] == ["-tilted", "3.3"]
    assert ours.penetration is not None and ours.shear is not None and ours.density is not None
    assert_equal(ours, campaign_of_files(exported(entered.campaign)))


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
        (SNOW_DENSITY, "350", "350"),
        (SNOW_DENSITY, " ", ""),
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
        ("penetration.csv", "load_N", "", "empty", "Enter a number above 0."),
        ("penetration.csv", "load_N", "0", "not_allowed", "Enter a number above 0."),
        ("penetration.csv", "load_N", "1,234.5", "not_allowed", "Enter a number above 0."),
        ("penetration.csv", "load_N", "seventy", "not_allowed", "Enter a number above 0."),
        ("penetration.csv", "depth_mm", "-1", "not_allowed", "Enter a number of 0 or more."),
        ("penetration.csv", "edge_angle_deg", "90", "not_allowed", "Enter a number from 0 to below 90."),
        ("penetration.csv", "air_temperature_C", "nan", "not_allowed", "Enter a finite number."),
        ("penetration.csv", SNOW_DENSITY, "918", "not_allowed", "Enter a number above 0 to 917."),
        ("shear.csv", "edge_angle_deg", "91", "not_allowed", "Enter a number above 0 to 90."),
        ("shear.csv", "turning_angle_deg", "361", "not_allowed", "Enter a number from −360 to 360."),
        ("penetration.csv", "remark", "x" * (LONGEST_TEXT + 1), "too_long", SHORT_LINE),
        ("penetration.csv", "remark", "two\nlines", "too_long", SHORT_LINE),
        ("penetration.csv", "branch", "sideways", "not_allowed", BRANCH_WORD),
    ],
)
def test_rejected_input(file: str, column: str, typed: str, code: str, fix: str) -> None:
    with pytest.raises(CellError) as raised:
        checked_cell(FORMS[file], column, typed)
    error = raised.value
    assert (error.code, error.column, error.value, error.fix) == (code, column, typed.strip(), fix)


def test_both_sentences_are_in_german_with_the_name_of_the_field() -> None:
    with pytest.raises(CellError) as raised:
        checked_cell(PENETRATION, "depth_mm", "2,o")
    problem = raised.value.problem(raised.value.code, "Tiefe").text("de")
    assert problem == "Tiefe: „2,o“ ist nicht erlaubt. Erlaubt: eine Zahl ab 0."


def test_the_longest_text_is_taken() -> None:
    assert checked_cell(PENETRATION, "remark", "x" * LONGEST_TEXT) == "x" * LONGEST_TEXT


__all__ = ["ada", "bo"]

FILE = "penetration.csv"


def entry(
    number: int, action: Any, *, cells: dict[str, str] | None = None, who: str = "Bo", **more: Any
) -> JournalEntry:
    plain: dict[str, Any] = {"file": FILE, "test": "7", "at": "10:00", "uid": f"u{number}", **more}
    return JournalEntry(action=action, cells=cells or {}, who=who, sequence=number, **plain)


BEGUN = entry(1, "add", cells={"experiment": "7", "depth_mm": "1.5", "remark": ""}, position=0)
DEEPER, SHALLOWER = (entry(n, "correct", cells={"depth_mm": text}, about=1) for n, text in ((2, "2"), (12, "1")))
DEEPER_TOO = entry(12, "correct", cells={"depth_mm": "2"}, about=1)
REMARKED = entry(13, "correct", cells={"remark": "wind"}, about=1)
CANCELLED, CANCELLED_TOO = (entry(n, "cancel", why="it slipped") for n in (4, 14))
CANCELLED_OTHERWISE = entry(14, "cancel", why="it broke")
TAKEN_BACK = entry(5, "undo", about=1)
SECOND, SECOND_TOO = (entry(n, "add", cells={"experiment": "7", "depth_mm": "3"}, position=1) for n in (6, 16))


def divergence(
    here: Sequence[JournalEntry],
    there: Sequence[JournalEntry],
    common: Sequence[JournalEntry] = (BEGUN,),
    file: str = FILE,
) -> Conflict:
    uids = [{each.sequence: each.uid for each in (*common, *side)} for side in (here, there)]
    return Conflict("j", "", file, "7", tuple(common), tuple(here), tuple(there), *uids)


@pytest.mark.parametrize(
    ("here", "there", "common"),
    [
        ([DEEPER], [REMARKED], [BEGUN]),  # other cells
        ([DEEPER], [DEEPER_TOO], [BEGUN]),  # the same word
        ([CANCELLED], [CANCELLED_TOO], [BEGUN]),
        ([CANCELLED, DEEPER], [DEEPER_TOO, CANCELLED_TOO], [BEGUN]),
    ],
)
def test_what_can_stand_together(here: Any, there: Any, common: Any) -> None:
    assert divergence(here, there, common).is_agreed


@pytest.mark.parametrize(
    ("here", "there", "common", "kind", "both"),
    [
        ([DEEPER], [SHALLOWER], [BEGUN], "corrected", False),
        ([BEGUN], [entry(11, "add", position=0)], [], "begun twice", True),
        ([SECOND], [SECOND_TOO], [BEGUN], "added to", False),
        ([SECOND], [REMARKED], [BEGUN], "added to", False),
        ([CANCELLED], [REMARKED], [BEGUN], "cancelled", True),
        ([CANCELLED], [CANCELLED_OTHERWISE], [BEGUN], "cancelled", True),
        ([CANCELLED, DEEPER], [SHALLOWER], [BEGUN], "cancelled", False),
        ([SECOND], [CANCELLED_TOO], [BEGUN], "cancelled", True),
        ([TAKEN_BACK], [REMARKED], [BEGUN], "taken back", False),
    ],
)
def test_what_contradicts(here: Any, there: Any, common: Any, kind: str, both: bool) -> None:
    """From either side."""
    for found in (divergence(here, there, common), divergence(there, here, common)):
        assert not found.is_agreed
        assert found.kind == kind
        sides: tuple[Side, ...] = ("here", "there", "both") if both else ("here", "there")
        assert found.choices == sides


def test_descriptions_agree_where_the_last_word_is_the_same() -> None:
    said = [entry(n, "describe", cells={"campaign.toml": text}) for n, text in ((1, "a"), (2, "b"), (3, "b"), (4, "c"))]
    assert divergence(said[:2], said[2:3], (), "campaign.toml").is_agreed
    assert divergence([said[1]], [said[3], said[2]], (), "campaign.toml").is_agreed
    apart = divergence([said[1], said[0]], said[2:3], (), "campaign.toml")
    assert (apart.is_agreed, apart.kind, apart.choices) == (False, "described", ("here", "there"))


def test_contested_are_the_cells_with_two_values() -> None:
    assert divergence([DEEPER, REMARKED], [SHALLOWER]).contested == [("u1", "depth_mm")]
    other = entry(13, "correct", cells={"remark": "sun"}, about=1)
    assert divergence([DEEPER, REMARKED], [other, SHALLOWER]).contested == [("u1", "depth_mm"), ("u1", "remark")]
    # of another row it is another cell; what was corrected twice came to the last word
    assert divergence([DEEPER], [entry(12, "correct", cells={"depth_mm": "1"}, about=9)]).contested == []
    assert divergence([DEEPER], [SHALLOWER, entry(13, "correct", cells={"depth_mm": "2"}, about=1)]).contested == []


def test_a_choice_is_called_by_what_both_sides_say() -> None:
    """Eight digits; the other way round, or with an entry more, it is another."""
    one = divergence([DEEPER], [SHALLOWER])
    assert len(one.id) == 8
    assert one.id == divergence([DEEPER], [SHALLOWER], ()).id
    others = {
        divergence([SHALLOWER], [DEEPER]).id, divergence([DEEPER, CANCELLED], [SHALLOWER]).id,
        divergence([DEEPER], [SHALLOWER], file="shear.csv").id,
    }  # fmt: skip
    assert len({one.id, *others}) == 4


def test_it_is_reported_line_by_line() -> None:
    stored = entry(8, "correct", cells={"12/depth_mm": "2.5", "remark": "wind"}, about=1)
    nameless = entry(9, "undo", about=99, who="")
    late = entry(10, "add", cells={"experiment": "7", "depth_mm": "4", "remark": ""}, position=2)
    undone = entry(15, "undo", about=2, who="Ada")
    uids = {1: "u1", 2: "u2"}
    here = (DEEPER, stored, CANCELLED, nameless)
    told = Conflict("j", "a day", FILE, "7", (BEGUN,), here, (late, undone), uids, uids)
    assert [line.partition(":")[0] for line in told.here] == ["Bo, 10"] * 3 + ["somebody, 10"]
    for line, parts in zip(told.here, ("'2'", "line 12 '2.5' 'wind'", "it slipped", ""), strict=True):
        assert all(part in line for part in parts.split())
    assert "depth_mm 4" in told.there[0] and told.there[1].startswith("Ada, ")
    head, *lines = str(told).splitlines()
    assert head.startswith(f"{told.id}  a day (j), ")
    assert lines == [*(f"    here: {line}" for line in told.here), *(f"    there: {line}" for line in told.there)]
    described = entry(3, "describe", cells={"campaign.toml": 'name =\n  "x"'})
    of_toml = Conflict("j", "x", "campaign.toml", "", (), (described,), (described,), {}, {})
    assert of_toml.here[0].endswith('name = "x"')
    assert "(j), campaign.toml: the" in str(of_toml)


def test_long_words_are_cut_at_eighty() -> None:
    assert _shorten_text("a\n b") == "a b"
    assert _shorten_text("a" * 80) == "a" * 80
    assert _shorten_text("a" * 81) == "a" * 80 + "…"


def test_both_wrote_about_a_test_where_each_has_what_the_other_lacks() -> None:
    here = EntryIndex({"a": (FILE, "1"), "b": (FILE, "2"), "c": (FILE, "3"), "d": ("shear.csv", "1")})
    there = EntryIndex({"a": (FILE, "1"), "e": (FILE, "2"), "f": (FILE, "1"), "g": ("shear.csv", "1")})
    assert here.missing_in(there) == {"b", "c", "d"}
    assert here.written_on_both(there) == there.written_on_both(here) == [(FILE, "2"), ("shear.csv", "1")]


def test_next_free_name_and_progress(ada: Laptop, bo: Laptop, group: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """A series 2 (2) is there already, in one of both stores; corrections follow to the new name.

    Entries are requested in portions, here of two.
    """
    monkeypatch.setattr(conflict_module, "_ENTRIES_PER_QUERY", 2)
    id_ = shared(ada, bo, group)
    ada.enter(id_, "2", "4")
    ada.enter(id_, "2 (2)", "6")
    bo.enter(id_, "2", "7")
    bo.change(id_, "2", cells={"depth_mm": "8"})
    ada.sync(group)
    seen: list[tuple[int, int]] = []
    done = sync(bo.store, group, keep={"all": "both"}, who="Bo", progress=lambda *at: seen.append(at))
    assert (done.n_settled, done.conflicts) == (1, ())
    assert seen == [(1, 2), (2, 2)]
    both_sync(ada, bo, group)
    assert [ada.depths(id_, test) for test in ("2", "2 (2)", "2 (3)")] == [["4"], ["6"], ["8"]]
