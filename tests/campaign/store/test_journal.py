"""The journal of entries and the export of a corrected campaign."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sqlalchemy import insert
from sqlalchemy.exc import IntegrityError
from tests.coded import raises
from tests.present import present

from skisnow._support.errors import StoreError
from skisnow.campaign import read_campaign
from skisnow.campaign.reading.campaign_files import CampaignFiles
from skisnow.campaign.store import (
    Journals,
    NewEntry,
    OvertakenError,
    Store,
    campaign_files,
    export_corrected,
    replay_journal,
    stored_tables,
    write_campaign,
)
from skisnow.campaign.store.engine import writing
from skisnow.campaign.store.journal import uid_of_file
from skisnow.campaign.store.schema import journal_entry

TOML = """name = "a day"
gauge_resolution_mm = 0.01
load_steps_N = [20.0, 40.0, 60.0]
tool = [{name = "piece", shape = "ski", length_mm = 200.0, width_mm = 62.0}]
plate = [{name = "p", length_mm = 100.0}]
"""


def reading(test: str, position: int, load: str, depth: str) -> NewEntry:
    cells = {"experiment": test, "site": "A", "tool": "piece", "edge_angle_deg": "30", "load_N": load}
    return NewEntry(
        action="add", file="penetration.csv", test=test, position=position, cells={**cells, "depth_mm": depth},
        who="Ada",
    )  # fmt: skip


def campaign_with(journals: Journals, *depths: str) -> tuple[str, int]:
    """A journal with one series "1"; its id and the last sequence."""
    id_, last = journals.begin(TOML), 0
    for position, depth in enumerate(depths):
        entry = reading("1", position, str(20 * (position + 1)), depth)
        last = journals.append(id_, entry, seen=last).sequence
    return id_, last


def test_readings_are_in_the_order_of_their_loads_whichever_came_first(store: Store) -> None:
    journals = Journals(store)
    id_, last = campaign_with(journals, "1.5", "2.25")
    last = journals.append(id_, reading("1", 2, "30.5", "1.9"), seen=last).sequence
    journals.append(id_, reading("1", 3, "5", "0.7"), seen=last)
    test = replay_journal(journals.entries(id_)).test("penetration.csv", "1")
    assert [row.cells["load_N"] for row in test.rows] == ["5", "20", "30.5", "40"]
    under = test.row_under("30.50")
    assert under is not None and under.cells["depth_mm"] == "1.9"
    assert test.row_under("50") is None
    assert test.next_position == 4


def test_a_column_that_need_not_be_there_is_written_where_one_row_has_it(store: Store) -> None:
    """The remark of the second reading only; spot, which no reading has, is not a column."""
    journals = Journals(store)
    id_, last = campaign_with(journals, "1.5")
    first = reading("1", 1, "40", "2.25")
    journals.append(id_, replace(first, cells={**first.cells, "remark": "wind"}), seen=last)
    header, *rows = campaign_files(replay_journal(journals.entries(id_)))["penetration.csv"].splitlines()
    names = header.split(",")
    assert "spot" not in names
    assert [dict(zip(names, row.split(","), strict=True))["remark"] for row in rows] == ["", "wind"]


def test_a_correction_keeps_the_first_reading_and_what_came_between(store: Store, tmp_path: Path) -> None:
    journals = Journals(store)
    id_, last = campaign_with(journals, "1.5", "22.5", "3")
    subject = replay_journal(journals.entries(id_)).test("penetration.csv", "1").rows[1].entered.sequence
    for new in ("2.52", "2.25"):
        entry = NewEntry(
            action="correct", file="penetration.csv", test="1", about=subject, cells={"depth_mm": new}, why="slip"
        )
        last = journals.append(id_, entry, seen=last).sequence
    now = replay_journal(journals.entries(id_))
    files = campaign_files(now)
    assert "22.5" in files["penetration.csv"] and "2.25" not in files["penetration.csv"]
    lines = files["corrections.csv"].splitlines()
    assert lines[1].split(",")[2:6] == ["3", "depth_mm", "22.5", "2.52"] and ",2.52,2.25," in lines[2]
    write_campaign(now, tmp_path)
    campaign = read_campaign(tmp_path)
    np.testing.assert_allclose(present(campaign.penetration).penetration_depth, [1.5e-3, 2.25e-3, 3e-3], rtol=1e-15)
    assert [each.old for each in campaign.corrections] == ["22.5", "2.52"]


def test_undoing_takes_the_last_entry_back_and_keeps_it_in_the_history(store: Store) -> None:
    journals = Journals(store)
    id_, last = campaign_with(journals, "1.5", "2.25")
    test = replay_journal(journals.entries(id_)).test("penetration.csv", "1")
    assert test.undoable is not None and test.undoable.cells["depth_mm"] == "2.25"
    undo = NewEntry(action="undo", file="penetration.csv", test="1", about=test.undoable.sequence)
    journals.append(id_, undo, seen=last)
    test = replay_journal(journals.entries(id_)).test("penetration.csv", "1")
    assert [row.cells["depth_mm"] for row in test.rows] == ["1.5"]
    assert [entry.action for entry in test.history] == ["add", "add", "undo"]
    assert test.undoable is not None and test.undoable.cells["depth_mm"] == "1.5"


def test_two_who_write_about_one_test_do_not_overwrite_each_other(store: Store) -> None:
    journals = Journals(store)
    id_, last = campaign_with(journals, "1.5")
    journals.append(id_, reading("1", 1, "40", "2.25"), seen=last)
    with raises(OvertakenError, "overtaken", who="Ada", subject="penetration.csv, 1"):
        journals.append(id_, reading("1", 1, "40", "9.99"), seen=last)
    journals.append(id_, reading("2", 0, "20", "1"), seen=0)  # another test has no part in it
    assert "9.99" not in campaign_files(replay_journal(journals.entries(id_)))["penetration.csv"]


def test_a_name_that_another_gave_meanwhile_is_rejected(store: Store) -> None:
    journals = Journals(store)
    id_, _ = campaign_with(journals, "1.5")
    with pytest.raises(OvertakenError):
        journals.append(id_, reading("1", 0, "20", "7"), seen=0)


def test_only_what_is_there_can_be_corrected(store: Store) -> None:
    journals = Journals(store)
    id_, last = campaign_with(journals, "1.5")
    wrong = NewEntry(action="correct", file="penetration.csv", test="1", about=999, cells={"depth_mm": "1"})
    with raises(StoreError, "no_entry", about=999):
        journals.append(id_, wrong, seen=last)
    with raises(StoreError, "unknown_id"):
        journals.entries("0123456789ab")


@pytest.mark.parametrize(
    ("action", "about", "rule"),
    [("rewrite", 1, "known_action"), ("correct", None, "about_an_entry"), ("add", 1, "about_an_entry")],
)
def test_entries_can_only_be_added_by_the_rules(store: Store, action: str, about: int | None, rule: str) -> None:
    """The table itself refuses what no program should write."""
    id_, _ = campaign_with(Journals(store), "1.5")
    before = Journals(store).entries(id_)
    with writing(store.engine) as connection, pytest.raises(IntegrityError, match=f"ck_journal_entry_{rule}"):
        row = {"sequence": 99, "at": "", "who": "", "file": "", "test": "", "cells": "{}", "why": ""}
        connection.execute(insert(journal_entry).values(journal_id=id_, action=action, about=about, **row))
    assert Journals(store).entries(id_) == before


def test_later_entries_extend_a_replayed_journal(store: Store) -> None:
    """Bit by bit, as a page sees a journal grow, is the same as all at once; what was there before stays as it was."""
    journals = Journals(store)
    id_, last = campaign_with(journals, "1.5", "2.25")
    early = replay_journal(journals.entries(id_))
    entries = journals.entries(id_)
    undo = NewEntry(action="undo", file="penetration.csv", test="1", about=last)
    last = journals.append(id_, undo, seen=last).sequence
    journals.append(id_, reading("1", 1, "40", "2.3"), seen=last)
    journals.append(id_, reading("2", 0, "20", "1"), seen=0)
    later = journals.entries(id_, after=entries[-1].sequence)
    assert replay_journal(later, before=early) == replay_journal(journals.entries(id_))
    assert [row.cells["depth_mm"] for row in early.test("penetration.csv", "1").rows] == ["1.5", "2.25"]
    assert len(early.tests) == 1


def test_an_entry_that_is_sent_again_is_written_down_once(store: Store) -> None:
    journals = Journals(store)
    id_, last = campaign_with(journals, "1.5")
    sent = replace(reading("1", 1, "40", "2.25"), once="browser-7")
    first = journals.append(id_, sent, seen=last)
    assert journals.append(id_, sent, seen=last) == first  # and it is not overtaken by itself
    assert journals.append(id_, replace(sent, position=9), seen=first.sequence) == first
    assert [entry.once for entry in journals.entries(id_)[1:]] == [None, "browser-7"]
    other, _ = campaign_with(journals)
    assert journals.append(other, sent, seen=0).sequence > first.sequence
    assert journals.begin(TOML, once="page-1") == journals.begin(TOML, once="page-1")
    assert len(journals.list()) == 3


def test_names_like_formulas_are_exported_as_texts_and_read_as_they_were(store: Store, tmp_path: Path) -> None:
    journals = Journals(store)
    id_ = journals.begin(TOML)
    name, site = "=1+1", "'@SUM(A1)"
    for position, (load, depth) in enumerate((("20", "1.5"), ("40", "2.1"), ("60", "2.6"))):
        row = reading(name, position, load, depth)
        journals.append(id_, replace(row, cells={**row.cells, "site": site}), seen=position and 10**6)
    write_campaign(replay_journal(journals.entries(id_)), tmp_path)
    text = (tmp_path / "penetration.csv").read_text(encoding="utf-8")
    assert "'=1+1" in text
    assert "''@SUM(A1)" in text
    cells = next(csv.reader(text.splitlines()[1:]))
    assert not any(cell.startswith(("=", "@", "+", "-")) for cell in cells)
    campaign = read_campaign(tmp_path)
    assert (set(present(campaign.penetration).experiment), set(present(campaign.penetration).site)) == ({name}, {site})


EXPORTED_TOML = """name = "Kept"
tool = [{name = "ski piece", shape = "ski", length_mm = 200, width_mm = 62}]
"""
PLAIN = """experiment,site,tool,edge_angle_deg,load_N,depth_mm
1,A,ski piece,30,20,1.5
1,A,ski piece,30,40,22.5
1,A,ski piece,30,60,2.6
2,A,ski piece,30,20,1.4
2,A,ski piece,30,40,2.0
2,A,ski piece,30,60,2.5
"""
GERMAN = (
    PLAIN.replace(",", ";").replace(".", ",").replace("A;ski piece;30;20;1,4", "A;ski piece;30;20;14").encode("cp1252")
)
EARLIER = '''file,experiment,row,column,old,new,who,when,why,note
penetration.csv,2,5,depth_mm,14,"1,4",Bo,then,"the ""point""",seen
'''


def kept(store: Store, place: Path, penetration: bytes, corrections: str = "") -> str:
    """The id of a campaign with these files."""
    place.mkdir()
    (place / "campaign.toml").write_text(EXPORTED_TOML, encoding="utf-8")
    (place / "penetration.csv").write_bytes(penetration)
    if corrections:
        (place / "corrections.csv").write_text(corrections, encoding="utf-8")
    return store.add(place).id


def standing(place: Path, name: str) -> dict[str, str]:
    rows = stored_tables(CampaignFiles(place))["penetration.csv"].tests[name]
    return {f"{line}/{column}": text for line, cells in rows.items() for column, text in cells.items()}


def correction(test: str, cells: dict[str, str]) -> NewEntry:
    return NewEntry(
        action="correct", file="penetration.csv", test=test, cells=cells, who="Ada", why="typing error", about=0
    )


def depths(folder: Path) -> dict[str, list[float]]:
    """Depths (mm) of each series as an analysis reads them."""
    tests = present(read_campaign(folder).penetration)
    found = {name: tests.series(index).penetration_depth * 1e3 for index, name in enumerate(tests.experiment)}
    return {name: [round(float(depth), 9) for depth in each] for name, each in found.items()}


def test_a_correction_is_exported_and_read_and_the_files_stay(store: Store, tmp_path: Path) -> None:
    place = tmp_path / "kept"
    id_ = kept(store, place, PLAIN.encode())
    Journals(store).correct(id_, correction("1", {"3/depth_mm": "2.25"}), seen=0, standing=standing(place, "1"))
    assert export_corrected(store, id_, tmp_path / "out").n_corrections == 1
    for name in ("campaign.toml", "penetration.csv"):
        assert (tmp_path / "out" / name).read_bytes() == (place / name).read_bytes()
    assert depths(tmp_path / "out") == {"1": [1.5, 2.25, 2.6], "2": [1.4, 2.0, 2.5]}
    (applied,) = read_campaign(tmp_path / "out").corrections
    assert (applied.row, applied.old, applied.new, applied.who, applied.why) == (
        3,
        "22.5",
        "2.25",
        "Ada",
        "typing error",
    )
    assert Journals(store).list() == ()  # it is not a campaign that is being entered
    store.export(id_, tmp_path / "raw")
    assert not (tmp_path / "raw" / "corrections.csv").exists()


def test_decimal_commas_and_corrections_that_came_with_the_campaign(store: Store, tmp_path: Path) -> None:
    place = tmp_path / "kept"
    id_ = kept(store, place, GERMAN, EARLIER)
    assert standing(place, "2")["5/depth_mm"] == "1,4"  # as corrected before it came
    first = Journals(store).correct(id_, correction("2", {"5/depth_mm": "1.3"}), seen=0, standing=standing(place, "2"))
    again = correction("2", {"5/depth_mm": "1.25", "6/depth_mm": "2.1"})
    Journals(store).correct(id_, again, seen=first.sequence, standing=standing(place, "2"))
    export_corrected(store, id_, tmp_path / "out")
    assert depths(tmp_path / "out")["2"] == [1.25, 2.1, 2.5]
    lines = (tmp_path / "out" / "corrections.csv").read_text(encoding="utf-8").splitlines()
    assert lines[1] == EARLIER.splitlines()[1]
    assert [line.split(",")[2:4] for line in lines[2:]] == [["5", "depth_mm"], ["5", "depth_mm"], ["6", "depth_mm"]]


def test_corrections_come_test_by_test_in_the_order_in_which_they_were_made(store: Store, tmp_path: Path) -> None:
    place = tmp_path / "kept"
    id_ = kept(store, place, PLAIN.encode())
    by_name = sorted("12", key=lambda name: uid_of_file(id_, "penetration.csv", name))
    for name in reversed(by_name):  # not the order of what the entries of the file are called
        row = {"1": "3/depth_mm", "2": "6/depth_mm"}[name]
        Journals(store).correct(id_, correction(name, {row: "2.25"}), seen=0, standing=standing(place, name))
    export_corrected(store, id_, tmp_path / "out")
    assert [each.experiment for each in read_campaign(tmp_path / "out").corrections] == by_name[::-1]


def test_what_was_undone_is_not_exported(store: Store, tmp_path: Path) -> None:
    place = tmp_path / "kept"
    id_ = kept(store, place, PLAIN.encode(), EARLIER.replace("14", "1.4"))
    journals = Journals(store)
    written = journals.correct(id_, correction("1", {"3/depth_mm": "9"}), seen=0, standing=standing(place, "1"))
    test = replay_journal(journals.corrections(id_)).test("penetration.csv", "1")
    assert test.undoable == written
    undo = NewEntry(action="undo", file="penetration.csv", test="1", about=written.sequence)
    journals.correct(id_, undo, seen=written.sequence, standing={})
    test = replay_journal(journals.corrections(id_)).test("penetration.csv", "1")
    assert test.undoable is None  # a value of the file cannot be undone
    assert [entry.action for entry in test.history] == ["add", "correct", "undo"]
    export_corrected(store, id_, tmp_path / "out")
    assert (tmp_path / "out" / "corrections.csv").read_bytes() == (place / "corrections.csv").read_bytes()


def test_a_cancelled_test_takes_no_part(store: Store, tmp_path: Path) -> None:
    place = tmp_path / "kept"
    id_ = kept(store, place, PLAIN.encode())
    entry = NewEntry(action="cancel", file="penetration.csv", test="2", who="Ada", why="the tool, slipped")
    Journals(store).correct(id_, entry, seen=0, standing=standing(place, "2"))
    export_corrected(store, id_, tmp_path / "out")
    tests = read_campaign(tmp_path / "out").penetration
    assert tests is not None and tests.cancelled == ("", "the tool, slipped")


def test_an_entry_after_an_unseen_one_is_rejected(store: Store, tmp_path: Path) -> None:
    place = tmp_path / "kept"
    id_ = kept(store, place, PLAIN.encode())
    journals = Journals(store)
    journals.correct(id_, correction("1", {"3/depth_mm": "2.25"}), seen=0, standing=standing(place, "1"))
    with raises(OvertakenError, "overtaken", who="Ada", subject="penetration.csv, 1"):
        journals.correct(id_, correction("1", {"3/depth_mm": "2.3"}), seen=0, standing=standing(place, "1"))
    assert len(journals.corrections(id_)) == 2


def test_what_came_as_corrections_and_is_no_text_is_reported_and_nothing_is_left(store: Store, tmp_path: Path) -> None:
    place = tmp_path / "kept"
    place.mkdir()
    (place / "corrections.csv").write_bytes(bytes(range(256)))
    (place / "penetration.csv").write_text(PLAIN, encoding="utf-8")
    id_ = store.add(place).id
    assert export_corrected(store, id_, tmp_path / "plain").n_corrections == 0
    Journals(store).correct(id_, correction("1", {"3/depth_mm": "2.25"}), seen=0, standing=standing(place, "1"))
    with raises(StoreError, "unreadable_corrections", file="corrections.csv"):
        export_corrected(store, id_, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_only_kept_campaigns_are_corrected_so(store: Store) -> None:
    id_ = Journals(store).begin(EXPORTED_TOML)
    with raises(StoreError, "unknown_id"):
        Journals(store).correct(id_, correction("1", {}), seen=0, standing={})
    with raises(StoreError, "unknown_id"):
        Journals(store).corrections("0123456789ab")


def test_a_corrected_campaign_is_not_one_in_entry(store: Store, tmp_path: Path) -> None:
    place = tmp_path / "kept"
    id_ = kept(store, place, PLAIN.encode())
    Journals(store).correct(id_, correction("1", {"3/depth_mm": "2.25"}), seen=0, standing=standing(place, "1"))
    with raises(StoreError, "unknown_id"):
        Journals(store).entries(id_)
    with raises(StoreError, "unknown_id"):
        Journals(store).append(id_, NewEntry(action="add", file="penetration.csv", test="9"), seen=0)
