"""Two laptops and a group's store: what each lacks it gets, once; what contradicts is shown, and the user chooses."""

import json
import re
import shutil
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import pytest
from tests.coded import raises

from skisnow._support.errors import StoreError
from skisnow.campaign.store import (
    Journals,
    NewEntry,
    Side,
    Store,
    SyncResult,
    campaign_files,
    corrected_files,
    replay_journal,
    sync,
)
from skisnow.campaign.store.conflict import entry_index
from skisnow.campaign.store.engine import writing
from skisnow.cli import main

from .conftest import opened
from .test_journal import PLAIN, TOML, correction, kept, reading, standing
from .test_store import FILES, contents, write


@dataclass
class Laptop:
    """A store offline, and a person."""

    who: str
    store: Store

    @property
    def journals(self) -> Journals:
        return Journals(self.store)

    def enter(self, id_: str, test: str, *depths: str) -> int:
        """A series; the last sequence."""
        last = 0
        for position, depth in enumerate(depths):
            entry = reading(test, position, str(20 * (position + 1)), depth)
            last = self.journals.append(id_, replace(entry, who=self.who), seen=last).sequence
        return last

    def change(self, id_: str, test: str, **values: object) -> None:
        """An entry about the first reading of a series."""
        now = replay_journal(self.journals.entries(id_)).test("penetration.csv", test)
        values = {"action": "correct", "about": now.rows[0].entered.sequence, **values}
        entry = NewEntry(file="penetration.csv", test=test, who=self.who, **values)  # type: ignore[arg-type]
        self.journals.append(id_, entry, seen=now.last)

    def depths(self, id_: str, test: str) -> list[str]:
        rows = replay_journal(self.journals.entries(id_)).test("penetration.csv", test).rows
        return [row.cells["depth_mm"] for row in rows]

    def files(self, id_: str) -> dict[str, str]:
        return campaign_files(replay_journal(self.journals.entries(id_)))

    def sync(self, group: Store, keep: dict[str, Side] | None = None) -> SyncResult:
        done = sync(self.store, group, keep=keep, who=self.who)
        assert done.problems == ()
        return done


@pytest.fixture
def ada(empty_file: Path, tmp_path: Path) -> Iterator[Laptop]:
    with opened(shutil.copy(empty_file, tmp_path / "ada.sqlite3")) as store:
        yield Laptop("Ada", store)


@pytest.fixture
def bo(empty_file: Path, tmp_path: Path) -> Iterator[Laptop]:
    with opened(shutil.copy(empty_file, tmp_path / "bo.sqlite3")) as store:
        yield Laptop("Bo", store)


def counts(done: SyncResult) -> tuple[int, int, int, int]:
    return done.n_campaigns_given, done.n_campaigns_taken, done.n_entries_given, done.n_entries_taken


def shared(ada: Laptop, bo: Laptop, group: Store) -> str:
    """A campaign with the series 1, which both have; its id."""
    id_ = ada.journals.begin(TOML, who=ada.who)
    ada.enter(id_, "1", "1.5", "2.25")
    assert counts(ada.sync(group)) == (0, 0, 3, 0)
    assert counts(bo.sync(group)) == (0, 0, 0, 3)
    return id_


def both_sync(ada: Laptop, bo: Laptop, group: Store) -> None:
    for laptop in (ada, bo, ada):
        assert laptop.sync(group).conflicts == ()


def assert_alike(id_: str, *stores: Store) -> None:
    entries = [Journals(store).entries(id_) for store in stores]
    assert len({tuple(entry.uid for entry in each) for each in entries}) == 1
    assert len({json.dumps(campaign_files(replay_journal(each))) for each in entries}) == 1
    assert [store.verify() for store in stores] == [()] * len(stores)


def test_both_see_what_each_entered_offline(ada: Laptop, bo: Laptop, store: Store, tmp_path: Path) -> None:
    id_ = shared(ada, bo, store)
    ada.enter(id_, "2", "1", "2", "3")
    ada.change(id_, "1", cells={"depth_mm": "1.75"}, why="misheard")
    bo.enter(id_, "3", "4", "5")
    own = bo.journals.begin(TOML.replace("a day", "another day"), who="Bo")
    added = bo.store.add(write(tmp_path / "stored", FILES))
    assert counts(ada.sync(store)) == (0, 0, 4, 0)
    assert counts(bo.sync(store)) == (1, 0, 3, 4)
    assert counts(ada.sync(store)) == (0, 1, 0, 3)
    for laptop in (ada, bo):
        assert counts(laptop.sync(store)) == (0, 0, 0, 0)
        assert [laptop.depths(id_, test) for test in "123"] == [["1.75", "2.25"], ["1", "2", "3"], ["4", "5"]]
    assert_alike(id_, ada.store, bo.store, store)
    assert_alike(own, ada.store, bo.store, store)
    (stored,) = ada.store.list()
    assert (stored,) == bo.store.list() == store.list()
    ada.store.export(added.id, tmp_path / "out")
    assert contents(tmp_path / "out") == FILES


def test_changes_of_different_cells_go_together(ada: Laptop, bo: Laptop, group: Store) -> None:
    id_ = shared(ada, bo, group)
    ada.change(id_, "1", cells={"depth_mm": "1.75"})
    bo.change(id_, "1", cells={"edge_angle_deg": "35"})
    both_sync(ada, bo, group)
    assert_alike(id_, ada.store, bo.store, group)
    (row, _) = replay_journal(bo.journals.entries(id_)).test("penetration.csv", "1").rows
    assert (row.cells["depth_mm"], row.cells["edge_angle_deg"]) == ("1.75", "35")


def conflict_of_corrections(ada: Laptop, bo: Laptop, group: Store) -> str:
    id_ = shared(ada, bo, group)
    ada.change(id_, "1", cells={"depth_mm": "1.75"}, why="misheard")
    bo.change(id_, "1", cells={"depth_mm": "1.25"}, why="misread")
    ada.sync(group)
    return id_


@pytest.mark.parametrize(("side", "depth"), [("here", "1.25"), pytest.param("there", "1.75", marks=pytest.mark.slow)])
def test_a_reading_corrected_differently(ada: Laptop, bo: Laptop, group: Store, side: Side, depth: str) -> None:
    id_ = conflict_of_corrections(ada, bo, group)
    for _ in range(2):  # as often as one likes: nothing is carried over, and all else is
        bo.enter(id_, f"{_ + 7}", "1")
        done = bo.sync(group)
        assert counts(done) == (0, 0, 1, 0)
        assert (bo.depths(id_, "1")[0], Laptop("", group).depths(id_, "1")[0]) == ("1.25", "1.75")
    (conflict,) = done.conflicts
    assert (conflict.campaign, conflict.name, conflict.test, conflict.choices) == (id_, "a day", "1", ("here", "there"))
    assert "same cell" in conflict.what
    assert conflict.here[0].startswith("Bo, ") and conflict.here[0].endswith("'1.25'")
    assert conflict.there[0].startswith("Ada, ") and conflict.there[0].endswith("'1.75'")
    settled = bo.sync(group, {conflict.id: side})
    assert (settled.n_settled, settled.conflicts) == (1, ())
    both_sync(ada, bo, group)
    assert_alike(id_, ada.store, bo.store, group)
    assert ada.depths(id_, "1") == [depth, "2.25"]
    history = replay_journal(ada.journals.entries(id_)).test("penetration.csv", "1").history
    assert {entry.who for entry in history if entry.action == "correct"} == {"Ada", "Bo"}
    (undo,) = [entry for entry in history if entry.action == "undo"]
    assert (undo.who, bool(undo.why)) == ("Bo", True)
    assert depth in ada.files(id_)["corrections.csv"]


def test_a_choice_that_was_made_can_be_made_otherwise(ada: Laptop, bo: Laptop, group: Store) -> None:
    """An undoing of the laptop that did not know of the choice is a conflict again, and can win."""
    id_ = conflict_of_corrections(ada, bo, group)
    ada.change(id_, "1", cells={"depth_mm": "1.8"}, why="thought again")
    bo.sync(group, {"all": "here"})
    (conflict,) = ada.sync(group).conflicts
    assert "taken back" in conflict.what
    ada.sync(group, {"all": "here"})
    both_sync(ada, bo, group)
    assert_alike(id_, ada.store, bo.store, group)
    assert bo.depths(id_, "1") == ["1.8", "2.25"]


@pytest.mark.parametrize("side", ["both", *(pytest.param(side, marks=pytest.mark.slow) for side in ("here", "there"))])
def test_cancelled_here_and_changed_there(ada: Laptop, bo: Laptop, group: Store, side: Side) -> None:
    id_ = shared(ada, bo, group)
    ada.change(id_, "1", cells={"depth_mm": "1.75"}, why="misheard")
    bo.change(id_, "1", action="cancel", about=None, why="the plate slipped")
    ada.sync(group)
    (conflict,) = bo.sync(group).conflicts
    assert conflict.here[0].endswith("the plate slipped")
    assert not replay_journal(ada.journals.entries(id_)).test("penetration.csv", "1").cancelled
    bo.sync(group, {"all": side})
    both_sync(ada, bo, group)
    assert_alike(id_, ada.store, bo.store, group)
    test = replay_journal(ada.journals.entries(id_)).test("penetration.csv", "1")
    assert test.cancelled == ("" if side == "there" else "the plate slipped")
    assert test.rows[0].cells["depth_mm"] == ("1.5" if side == "here" else "1.75")


@pytest.mark.parametrize(
    ("side", "tests"),
    [
        pytest.param("here", {"2": "7"}, marks=pytest.mark.slow),
        ("there", {"2": "4"}),
        ("both", {"2": "4", "2 (2)": "7"}),
    ],
)
def test_a_number_given_twice(ada: Laptop, bo: Laptop, group: Store, side: Side, tests: dict[str, str]) -> None:
    """Both crews went on counting offline."""
    id_ = shared(ada, bo, group)
    ada.enter(id_, "2", "4", "5")
    bo.enter(id_, "2", "7", "8")
    bo.change(id_, "2", cells={"remark": "windy"})
    ada.sync(group)
    (conflict,) = bo.sync(group).conflicts
    assert "load_N 20, depth_mm 4" in conflict.there[0]
    at = bo.journals.entries(id_)[-1].at
    bo.sync(group, {"all": side})
    both_sync(ada, bo, group)
    assert_alike(id_, ada.store, bo.store, group)
    found = [test for test in replay_journal(ada.journals.entries(id_)).of_file("penetration.csv") if test.name != "1"]
    assert {test.name: test.rows[0].cells["depth_mm"] for test in found} == tests
    assert [len(test.rows) for test in found] == [2] * len(found)
    for test in found:
        assert {row.cells["experiment"] for row in test.rows} == {test.name}
        if test.rows[0].cells["depth_mm"] == "7":
            assert (test.rows[0].cells["remark"], test.rows[0].corrections[0].at) == ("windy", at)
            assert {row.entered.who for row in test.rows} == {"Bo"}


def test_a_series_that_both_went_on_with(ada: Laptop, bo: Laptop, group: Store) -> None:
    id_ = shared(ada, bo, group)
    for laptop, depth in ((ada, "3"), (bo, "4")):
        last = replay_journal(laptop.journals.entries(id_)).test("penetration.csv", "1").last
        laptop.journals.append(id_, replace(reading("1", 2, "60", depth), who=laptop.who), seen=last)
    ada.sync(group)
    (conflict,) = bo.sync(group).conflicts
    assert conflict.choices == ("here", "there")
    with raises(StoreError, "unknown_side", side="both"):
        bo.sync(group, {"all": "both"})
    bo.sync(group, {"all": "there"})
    both_sync(ada, bo, group)
    assert ada.depths(id_, "1") == bo.depths(id_, "1") == ["1.5", "2.25", "3"]


@pytest.mark.parametrize(("side", "place"), [("here", "Bo's"), pytest.param("there", "Ada's", marks=pytest.mark.slow)])
def test_a_campaign_described_differently(ada: Laptop, bo: Laptop, group: Store, side: Side, place: str) -> None:
    id_ = shared(ada, bo, group)
    for laptop in (ada, bo):
        described = replay_journal(laptop.journals.entries(id_)).described
        text = f'place = "{laptop.who}\'s"\n{TOML}'
        entry = NewEntry(action="describe", file="campaign.toml", cells={"campaign.toml": text}, who=laptop.who)
        laptop.journals.append(id_, entry, seen=described)
    ada.sync(group)
    (conflict,) = bo.sync(group).conflicts
    assert conflict.file == "campaign.toml"
    bo.sync(group, {"all": side})
    both_sync(ada, bo, group)
    assert_alike(id_, ada.store, bo.store, group)
    assert ada.files(id_)["campaign.toml"].startswith(f'place = "{place}"')


def test_campaigns_of_one_name_are_kept_apart(ada: Laptop, bo: Laptop, group: Store) -> None:
    ids = [laptop.journals.begin(TOML, who=laptop.who) for laptop in (ada, bo)]
    both_sync(ada, bo, group)
    for laptop in (ada, bo):
        assert {head.id for head in laptop.journals.list()} == set(ids)


def test_corrections_of_a_stored_campaign(ada: Laptop, bo: Laptop, store: Store, tmp_path: Path) -> None:
    """Each laptop writes down what the file states; that is one entry, not two."""
    place = tmp_path / "kept"
    id_ = kept(ada.store, place, PLAIN.encode())
    assert counts(ada.sync(store)) == (1, 0, 0, 0)
    bo.sync(store)
    for laptop, cell in ((ada, "3/depth_mm"), (bo, "2/depth_mm")):
        entry = replace(correction("1", {cell: "2.25"}), who=laptop.who)
        laptop.journals.correct(id_, entry, seen=0, standing=standing(place, "1"))
    both_sync(ada, bo, store)
    files = [corrected_files({}, laptop.journals.corrections(id_)) for laptop in (ada, bo)]
    assert files[0] == files[1]
    assert files[0]["corrections.csv"].decode().count("\n") == 3
    assert store.verify() == ada.store.verify() == bo.store.verify() == ()
    assert [head.id for head in bo.journals.list()] == []


def test_a_choice_about_what_has_changed_since_is_rejected(ada: Laptop, bo: Laptop, group: Store) -> None:
    id_ = conflict_of_corrections(ada, bo, group)
    (conflict,) = bo.sync(group).conflicts
    ada.change(id_, "1", cells={"depth_mm": "1.8"})
    ada.sync(group)
    before = bo.journals.entries(id_)
    with raises(StoreError, "unknown_conflict"):
        bo.sync(group, {conflict.id: "here"})
    assert bo.journals.entries(id_) == before


def test_what_is_damaged_stays_where_it_is_and_the_rest_goes_over(ada: Laptop, group: Store, tmp_path: Path) -> None:
    bad = ada.journals.begin(TOML, who="Ada")
    good = ada.journals.begin(TOML.replace("a day", "another"), who="Ada")
    ada.enter(bad, "1", "1.5")
    broken = ada.store.add(write(tmp_path / "a", {"a.csv": b"broken"})).id
    whole = ada.store.add(write(tmp_path / "b", {"b.csv": b"whole"})).id
    with writing(ada.store.engine) as connection:
        connection.exec_driver_sql("UPDATE journal_entry SET cells = replace(cells, '1.5', '1.6')")
        connection.exec_driver_sql("UPDATE chunk SET data = x'00' WHERE data = CAST('broken' AS BLOB)")
    done = sync(ada.store, group)
    assert counts(done) == (1, 0, 1, 0)
    assert len(done.problems) == 2
    assert all(problem.startswith(str(ada.store.path)) for problem in done.problems)
    assert broken in done.problems[0] and bad in done.problems[1]
    assert ([each.id for each in group.list()], [each.id for each in Journals(group).list()]) == ([whole], [good])
    assert group.verify() == ()


def test_an_entry_that_was_sent_again_stays_one(ada: Laptop, bo: Laptop, group: Store) -> None:
    id_ = shared(ada, bo, group)
    sent = replace(reading("2", 0, "20", "1"), once="page-7")
    ada.journals.append(id_, sent, seen=0)
    both_sync(ada, bo, group)
    assert bo.journals.append(id_, sent, seen=0).once == "page-7"
    assert counts(bo.sync(group)) == (0, 0, 0, 0)


def test_a_store_is_not_synchronised_with_itself(ada: Laptop) -> None:
    with raises(StoreError, "same_store"), Store.open(ada.store.path) as again:
        sync(ada.store, again)


# The command


def test_conflicts_in_the_terminal(ada: Laptop, bo: Laptop, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Over a stick: a file that is carried about is the group's store."""
    stick = tmp_path / "stick" / "group.sqlite3"
    bos = ["store", "--store", str(bo.store.path), "sync", str(stick)]
    assert main(bos) == 1
    assert str(stick.parent) in capsys.readouterr().err
    stick.parent.mkdir()
    with Store.open(stick) as group:
        conflict_of_corrections(ada, bo, group)
    assert main(bos) == 1
    told = capsys.readouterr().out
    assert told.startswith("given: 0 ")
    assert "here: Bo, " in told
    id_ = told.partition("choose with --keep ")[2].partition("=")[0]
    page = Path(__file__).parents[3] / "docs" / "how-to" / "store.md"
    shown = page.read_text(encoding="utf-8").partition("<!-- example: conflict -->\n```\n")[2].partition("```")[0]
    shortened = re.sub(r"\d{4}-\d\d-\d\dT[\d:]{8}Z", "TIME", told.replace(id_, "ID"))
    assert shown == re.sub(r"\([0-9a-f]{12}\)", "(CAMPAIGN)", shortened).partition("\n\n")[2]
    assert main([*bos, "--keep", f"{id_}=there", "--who", "Bo", "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert (said["n_settled"], said["conflicts"], said["n_entries_given"]) == (1, [], 2)
    with pytest.raises(SystemExit):
        main([*bos, "--keep", f"{id_}=mine"])
    assert "ID=there" in capsys.readouterr().err


def test_an_entry_without_a_uid_is_damaged(ada: Laptop, group: Store) -> None:
    damaged = ada.journals.begin(TOML, who=ada.who)
    with writing(ada.store.engine) as connection:
        connection.exec_driver_sql("UPDATE journal_entry SET uid = NULL")
        with raises(StoreError, "damaged"):
            entry_index(connection, damaged)
    assert sync(ada.store, group).n_entries_given == 0


def test_a_campaign_with_corrections_stays_and_another_is_removed_with_its_own_bytes(
    ada: Laptop, tmp_path: Path
) -> None:
    place = tmp_path / "kept"
    corrected = kept(ada.store, place, PLAIN.encode())
    ada.journals.correct(corrected, correction("1", {"3/depth_mm": "2.25"}), seen=0, standing=standing(place, "1"))
    files = {name: {"a.csv": b"shared", "b.csv": name.encode()} for name in ("first", "second")}
    first, second = (ada.store.add(write(tmp_path / name, texts)).id for name, texts in files.items())
    with raises(StoreError, "has_corrections"):
        ada.store.remove(corrected)
    assert ada.store.remove(first).id == first
    assert {stored.id for stored in ada.store.list()} == {corrected, second}
    assert ada.store.verify() == ()
    ada.store.export(second, tmp_path / "out")
    assert contents(tmp_path / "out") == files["second"]
    with writing(ada.store.engine) as connection:
        query = "SELECT count(*) FROM {} WHERE {}"
        for table, condition in (
            ("chunk", "data = CAST('first' AS BLOB)"),
            ("campaign_file", f"campaign_id = '{first}'"),
        ):
            assert connection.exec_driver_sql(query.format(table, condition)).scalar() == 0
