"""Corrections of kept campaigns: beside the files, which stay, and read by every analysis of the export."""

from __future__ import annotations

from pathlib import Path

from tests.coded import raises

from skisnow._support.errors import StoreError
from skisnow.campaign import read_campaign
from skisnow.campaign.store import (
    Journals,
    NewEntry,
    OvertakenError,
    Store,
    export_corrected,
    replay_journal,
    stored_tables,
)
from skisnow.campaign.store.journal_entry import uid_of_file

TOML = """name = "Kept"
[[tool]]
name = "ski piece"
shape = "ski"
length_mm = 200
width_mm = 62
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
    (place / "campaign.toml").write_text(TOML, encoding="utf-8")
    (place / "penetration.csv").write_bytes(penetration)
    if corrections:
        (place / "corrections.csv").write_text(corrections, encoding="utf-8")
    return store.add(place).id


def standing(place: Path, name: str) -> dict[str, str]:
    rows = stored_tables(place)["penetration.csv"].tests[name]
    return {f"{line}/{column}": text for line, cells in rows.items() for column, text in cells.items()}


def correction(test: str, cells: dict[str, str]) -> NewEntry:
    return NewEntry(
        action="correct", file="penetration.csv", test=test, cells=cells, who="Ada", why="typing error", about=0
    )


def depths(folder: Path) -> dict[str, list[float]]:
    """Depths (mm) of each series as an analysis reads them."""
    tests = read_campaign(folder).penetration
    assert tests is not None
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


def test_somebody_else_was_quicker(store: Store, tmp_path: Path) -> None:
    place = tmp_path / "kept"
    id_ = kept(store, place, PLAIN.encode())
    journals = Journals(store)
    journals.correct(id_, correction("1", {"3/depth_mm": "2.25"}), seen=0, standing=standing(place, "1"))
    with raises(OvertakenError, "overtaken", who="Ada", subject="penetration.csv, 1"):
        journals.correct(id_, correction("1", {"3/depth_mm": "2.3"}), seen=0, standing=standing(place, "1"))
    assert len(journals.corrections(id_)) == 2


def test_what_came_as_corrections_and_is_no_text_is_said_and_nothing_is_left(store: Store, tmp_path: Path) -> None:
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
    id_ = Journals(store).begin(TOML)
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
