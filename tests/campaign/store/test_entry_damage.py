"""A flipped bit in an entry is noticed: verify names its place, and it is not read as if it were sound."""

import sqlite3
from dataclasses import replace
from pathlib import Path

import pytest
from tests.coded import raises

from skisnow._support.errors import StoreError
from skisnow.campaign.store import Journals, Store
from skisnow.campaign.store.stored_tables import cell_of

from .test_journal import TOML, campaign_with, reading

PENETRATION = "experiment,site,tool,edge_angle_deg,load_N,depth_mm\n1,A,piece,30,20,1.5\n1,A,piece,30,40,2.5\n"


@pytest.fixture
def place(tmp_path: Path) -> Path:
    return tmp_path / "store.sqlite3"


def entered(place: Path) -> str:
    """A series of three readings, entries 2 to 4, and a correction of the second one; the campaign's id."""
    with Store.open(place) as store:
        journals = Journals(store)
        id_, last = campaign_with(journals, "1.5", "2.25", "3")
        corrected = replace(reading("1", 0, "40", "2.5"), action="correct", position=None, cells={"depth_mm": "2.5"})
        journals.append(id_, replace(corrected, about=last - 1, why="misheard"), seen=last)
    return id_


def change(place: Path, statement: str) -> None:
    connection = sqlite3.connect(place, isolation_level=None)
    assert connection.execute(statement).rowcount > 0
    connection.close()


def told(place: Path) -> list[str]:
    with Store.open(place) as store:
        return [str(finding) for finding in store.verify()]


def cells(old: str, new: str, entry: int) -> str:
    return f"UPDATE journal_entry SET cells = replace(cells, '{old}', '{new}') WHERE sequence = {entry}"


def as_bytes(old: str, entry: int) -> str:
    """The last byte of a text becomes one that no text has, in a cell that stays a text for SQLite."""
    broken = f"x'{old[:-1].encode().hex()}{ord(old[-1]) | 0x80:02x}'"
    return f"UPDATE journal_entry SET cells = replace(cells, '{old}', CAST({broken} AS TEXT)) WHERE sequence = {entry}"


@pytest.mark.parametrize(
    ("statement", "said"),
    [
        (cells('"3"', '"2"', 4), "penetration.csv: test 1, row 3, column depth_mm: '2'"),
        (cells("piece", "pigce", 2), "penetration.csv: test 1, row 1, column tool: 'pigce'"),
        (as_bytes("piece", 2), "penetration.csv: test 1, row 1, column tool: 'piec\ufffd'"),
        (cells("depth_mm", "depth_mn", 3), "penetration.csv: test 1, row 2, column depth_mm"),
        (cells("2.5", "6.5", 5), "penetration.csv: test 1, row 2, column depth_mm: '6.5'"),
        (cells("}", "|", 3), "penetration.csv: test 1, row 2: its cells"),
        (cells("a day", "a bay", 1), 'campaign.toml: column campaign.toml: \'name = "a bay"'),
        ("UPDATE journal_entry SET who = 'Ava' WHERE sequence = 2", "penetration.csv: test 1, row 1: its who"),
        (f"UPDATE journal_entry SET position = CAST('{'9' * 5000}' AS BLOB) WHERE sequence = 2", "test 1"),
        ("UPDATE journal_entry SET position = 6 WHERE sequence = 2", "test 1, row 7: its position"),
        ("UPDATE journal_entry SET file = 'x.csv' WHERE sequence = 2", "x.csv: test 1, row 1: its file"),
        (
            "UPDATE journal_entry SET sums = replace(sums, '\"who\"', '\"hwo\"'), who = 'Ava' WHERE sequence = 3",
            "test 1, row 2: neither",
        ),
        (
            "UPDATE journal_entry SET sums = replace(sums, 'depth', 'death') WHERE sequence = 3",
            "test 1, row 2: its checksum",
        ),
        ("UPDATE journal_entry SET sha256 = '0' WHERE sequence = 3", "test 1, row 2: its checksum"),
        ("UPDATE journal_entry SET sha256 = '0', sums = '{' WHERE sequence = 3", "test 1, row 2: neither"),
        ("UPDATE journal_entry SET sums = NULL WHERE sequence = 3", "test 1, row 2: it has no checksum"),
    ],
)
def test_a_damaged_entry_is_named(place: Path, statement: str, said: str) -> None:
    id_ = entered(place)
    assert told(place) == []
    change(place, statement)
    found = told(place)
    assert any(finding.startswith(id_) and said in finding for finding in found), found


def test_a_damaged_correction_of_a_kept_campaign_is_named(place: Path, tmp_path: Path) -> None:
    folder = tmp_path / "campaign"
    folder.mkdir()
    (folder / "campaign.toml").write_text(TOML)
    (folder / "penetration.csv").write_text(PENETRATION)
    with Store.open(place) as store:
        id_ = store.add(folder).id
        entry = replace(reading("1", 0, "", ""), action="correct", position=None, cells={"3/depth_mm": "2.75"})
        Journals(store).correct(id_, entry, seen=0, standing={"2/depth_mm": "1.5", "3/depth_mm": "2.5"})
        assert store.verify() == ()
    change(place, cells("2.75", "2.35", 2))
    (finding,) = told(place)
    assert finding.startswith(f"{id_}, penetration.csv: test 1, row 3, column depth_mm: '2.35'")
    with Store.open(place) as store, raises(StoreError, "damaged", number="2"):
        Journals(store).corrections(id_)


def test_every_bit_of_a_cell_is_noticed_and_named(place: Path) -> None:
    """In the file itself, where SQLite's own check does not look."""
    id_ = entered(place)
    with sqlite3.connect(place) as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    raw = place.read_bytes()
    at = raw.index(b'"depth_mm": "2.25"') + len(b'"depth_mm": "')
    assert raw.count(b"2.25") == 1
    for bit in range(8 * len(b"2.25")):
        flipped = bytearray(raw)
        flipped[at + bit // 8] ^= 1 << bit % 8
        place.write_bytes(flipped)
        (finding,) = told(place)
        assert finding.startswith(f"{id_}, penetration.csv: test 1, row 2"), finding
        if flipped[at + bit // 8] not in b'"\\' and flipped[at + bit // 8] >= 32:
            assert "column depth_mm: " in finding
        with Store.open(place) as store, pytest.raises(StoreError, match="damaged"):
            Journals(store).entries(id_)


def test_a_damaged_store_opens_and_reports_each_damaged_entry(place: Path) -> None:
    entered(place)
    change(place, as_bytes("piece", 2))
    change(place, cells("}", "|", 3))
    with Store.open(place) as store:
        assert [finding.path for finding in store.verify()] == ["penetration.csv", "penetration.csv"]
    reported = told(place)
    assert "column tool" in reported[0]
    assert "row 2" in reported[1]


@pytest.mark.parametrize("key", ["", "/", "3/", "/depth_mm", "x/depth_mm", "-3/depth_mm", "9" * 5000 + "/depth_mm"])
def test_a_key_that_names_no_cell_is_damaged(key: str) -> None:
    with raises(StoreError, "damaged"):
        cell_of(key)
