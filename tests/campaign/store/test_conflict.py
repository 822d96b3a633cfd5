"""Entries written by hand that contradict each other or not, and the words of the conflict."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest

from skisnow.campaign.store import conflict as conflict_module
from skisnow.campaign.store import sync
from skisnow.campaign.store.conflict import Divergence, EntryIndex, Side, _shorten_text
from skisnow.campaign.store.journal_entry import JournalEntry
from skisnow.campaign.store.sync import Names, same_names

from .test_syncing import Laptop, ada, bo, both_sync, shared

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
) -> Divergence:
    uids = [{each.sequence: each.uid for each in (*common, *side)} for side in (here, there)]
    return Divergence("j", (file, "7"), tuple(common), tuple(here), tuple(there), *uids)


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
        ([BEGUN, CANCELLED], [entry(11, "add", position=0)], [], "begun twice", True),
        ([SECOND], [SECOND_TOO], [BEGUN], "added to", False),
        ([SECOND], [REMARKED], [BEGUN], "added to", False),
        ([CANCELLED], [REMARKED], [BEGUN], "cancelled", True),
        ([CANCELLED], [CANCELLED_OTHERWISE], [BEGUN], "cancelled", True),
        ([CANCELLED, DEEPER], [SHALLOWER], [BEGUN], "cancelled", False),
        ([SECOND], [CANCELLED_TOO], [BEGUN], "cancelled", True),
        ([TAKEN_BACK], [REMARKED], [BEGUN], "taken back", False),
        ([TAKEN_BACK], [SECOND_TOO], [BEGUN], "taken back", False),
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


def test_it_is_told_line_by_line() -> None:
    stored = entry(8, "correct", cells={"12/depth_mm": "2.5", "remark": "wind"}, about=1)
    nameless = entry(9, "undo", about=99, who="")
    late = entry(10, "add", cells={"experiment": "7", "depth_mm": "4", "remark": ""}, position=2)
    undone = entry(15, "undo", about=2, who="Ada")
    uids = {1: "u1", 2: "u2"}
    found = Divergence("j", (FILE, "7"), (BEGUN,), (DEEPER, stored, CANCELLED, nameless), (late, undone), uids, uids)
    told = found.told("a day")
    assert [line.partition(":")[0] for line in told.here] == ["Bo, 10"] * 3 + ["somebody, 10"]
    for line, parts in zip(told.here, ("'2'", "line 12 '2.5' 'wind'", "it slipped", ""), strict=True):
        assert all(part in line for part in parts.split())
    assert "depth_mm 4" in told.there[0] and told.there[1].startswith("Ada, ")
    head, *lines = str(told).splitlines()
    assert head.startswith(f"{found.id}  a day (j), ")
    assert lines == [*(f"    here: {line}" for line in told.here), *(f"    there: {line}" for line in told.there)]
    described = entry(3, "describe", cells={"campaign.toml": 'name =\n  "x"'})
    of_toml = Divergence("j", ("campaign.toml", ""), (), (described,), (described,), {}, {}).told("x")
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


def test_names_that_meet_for_the_first_time_are_told_by_kind() -> None:
    here, there = Names({"1": "x", "2": "y"}, {"3": "x"}), Names({"1": "x", "5": "x", "6": "z"}, {"3": "x", "7": "y"})
    (told,) = same_names(here, there)
    assert "'x': 1, " in told and " 5 " in told
    assert here.all == {"1": "x", "2": "y", "3": "x"}


def test_the_next_free_name_is_taken_and_progress_is_told(
    ada: Laptop, bo: Laptop, group: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
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
