"""Photos and positions of tests: kept in the journal, exported with the campaign, never part of its numbers."""

import base64
import csv
import math
from pathlib import Path

import pytest
from tests.coded import raises

from skisnow._support.errors import ParameterError
from skisnow.campaign import read_campaign
from skisnow.campaign.store import (
    Journals,
    NewEntry,
    Position,
    Store,
    attachments_of,
    entered_files,
    export_corrected,
    export_entered,
    photo_entry,
    position_entry,
    replay_journal,
    sync,
)
from skisnow.campaign.store.export import MOST_PHOTO_BYTES, photo_of, rows_of_file

TOML = 'name = "x"\n[[tool]]\nname = "t"\nshape = "ski"\nlength_mm = 200\nwidth_mm = 62\n'
PHOTO = b"\xff\xd8\xff" + bytes(range(256)) * 1000
CELLS = {"site": "A", "experiment": "1", "tool": "t", "edge_angle_deg": "30", "load_N": "100", "depth_mm": "1.5"}


def begun(store: Store) -> str:
    journals = Journals(store)
    id_ = journals.begin(TOML)
    journals.append(id_, NewEntry(action="add", file="penetration.csv", test="1", cells=CELLS, position=0), seen=0)
    photo = photo_entry("penetration.csv", "1", base64.b64encode(PHOTO).decode(), who="Ada")
    journals.append(id_, photo, seen=0)
    journals.append(id_, position_entry("penetration.csv", "1", Position(47.25, 11.5, 6.0)), seen=0)
    return id_


def test_photo_and_position_are_exported_with_the_campaign(tmp_path: Path) -> None:
    with Store.open(tmp_path / "store.sqlite3") as store:
        id_ = begun(store)
        export_entered(store, id_, tmp_path / "out")
        paths = {file.path for file in entered_files(store, id_)}
    with (tmp_path / "out" / "attachments.csv").open(encoding="utf-8", newline="") as file:
        photo, position = csv.DictReader(file)
    data = (tmp_path / "out" / "attachments.csv").read_bytes()
    assert rows_of_file(data, "penetration.csv", "1") == [photo, position]
    assert rows_of_file(b"\xff", "penetration.csv", "1") == rows_of_file(data, "shear.csv", "1") == []
    assert (photo["table"], photo["test"], photo["who"]) == ("penetration.csv", "1", "Ada")
    assert (tmp_path / "out" / photo["photo"]).read_bytes() == PHOTO
    assert (position["latitude_deg"], position["longitude_deg"], position["accuracy_m"]) == ("47.25", "11.5", "6")
    assert {"attachments.csv", photo["photo"], "penetration.csv"} <= paths
    campaign = read_campaign(tmp_path / "out")
    assert campaign.penetration is not None
    assert (campaign.penetration.experiment, campaign.unread_files) == (("1",), ())


def test_attachments_reach_another_laptop_and_can_be_cancelled(tmp_path: Path) -> None:
    with Store.open(tmp_path / "a.sqlite3") as here, Store.open(tmp_path / "b.sqlite3") as there:
        id_ = begun(here)
        sync(here, there)
        campaign = replay_journal(Journals(there).entries(id_))
        photo, position = attachments_of(campaign, "penetration.csv", "1")
        assert photo_of(photo) == PHOTO
        cancel = NewEntry(action="cancel", file=photo.file, test=photo.name, why="a face")
        Journals(there).append(id_, cancel, seen=photo.last)
        sync(here, there)
        campaign = replay_journal(Journals(here).entries(id_))
        assert [each.name for each in attachments_of(campaign, "penetration.csv", "1")] == [position.name]
        export_entered(here, id_, tmp_path / "out")
    assert not list((tmp_path / "out").glob("photos/*"))


def test_attachments_of_an_imported_campaign_join_those_of_its_files(tmp_path: Path) -> None:
    with Store.open(tmp_path / "store.sqlite3") as store:
        export_entered(store, begun(store), tmp_path / "first")
        id_ = store.add(tmp_path / "first").id
        entry = photo_entry("penetration.csv", "1", base64.b64encode(PHOTO + b"2").decode())
        written = Journals(store).correct(id_, entry, seen=0, standing={})
        assert export_corrected(store, id_, tmp_path / "second").n_corrections == 0
        cancel = NewEntry(action="cancel", file=entry.file, test=entry.test, why="a face")
        Journals(store).correct(id_, cancel, seen=written.sequence, standing={})
        export_corrected(store, id_, tmp_path / "third")
    rows = (tmp_path / "second/attachments.csv").read_text().splitlines()
    assert rows[:3] == (tmp_path / "first/attachments.csv").read_text().splitlines()
    assert (tmp_path / "second" / rows[3].rpartition(",")[2]).read_bytes() == PHOTO + b"2"
    for name in ("attachments.csv", "penetration.csv"):
        assert (tmp_path / "third" / name).read_bytes() == (tmp_path / "first" / name).read_bytes()


@pytest.mark.parametrize("photo", ["no base64", base64.b64encode(b"GIF89a").decode(),
    base64.b64encode(PHOTO + bytes(MOST_PHOTO_BYTES)).decode()])  # fmt: skip
def test_what_is_no_small_photo_is_rejected(photo: str) -> None:
    with raises(ParameterError, "no_photo"):
        photo_entry("penetration.csv", "1", photo)


@pytest.mark.parametrize(
    "place",
    [
        (90.5, 0.0, 1.0),
        (-90.5, 0.0, 1.0),
        (0.0, 180.5, 1.0),
        (0.0, -180.5, 1.0),
        (47.0, 11.0, -1.0),
        (math.nan, 11.0, 1.0),
        (47.0, 11.0, math.inf),
    ],
)
def test_what_is_no_position_is_rejected(place: tuple[float, float, float]) -> None:
    with raises(ParameterError, "no_position"):
        Position(*place)


def test_the_largest_photo_and_the_outermost_positions_are_stored() -> None:
    """A photo is cut into cells of 90,000 characters, in their order."""
    assert [Position(*place).accuracy_m for place in ((90.0, 180.0, 0.0), (-90.0, -180.0, 1.0))] == [0.0, 1.0]
    entry = position_entry("shear.csv", "S1", Position(-47.123456789, 11.5, 6.0), who="Ada")
    assert entry.cells == {
        "table": "shear.csv", "test": "S1", "latitude_deg": "-47.12345679", "longitude_deg": "11.5", "accuracy_m": "6",
    }  # fmt: skip
    assert (entry.action, entry.file, entry.position, entry.who) == ("add", "attachments.csv", 0, "Ada")
    assert len(entry.test) == len("shear S1 ") + 8
    largest = base64.b64encode(PHOTO[:3] + bytes(MOST_PHOTO_BYTES - 3)).decode()
    cells = photo_entry("penetration.csv", "1", largest).cells
    pieces = [cells[f"photo_{number:02d}"] for number in range(len(cells) - 2)]
    assert [len(piece) for piece in pieces] == [90_000] * 10 + [len(largest) - 900_000]
    assert "".join(pieces) == largest
    with raises(ParameterError, "no_photo", size=MOST_PHOTO_BYTES + 1, most=MOST_PHOTO_BYTES):
        photo_entry("penetration.csv", "1", base64.b64encode(PHOTO[:3] + bytes(MOST_PHOTO_BYTES - 2)).decode())
