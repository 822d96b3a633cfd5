"""``skisnow store`` as its users call it."""

import csv
import hashlib
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import insert

from skisnow import read_campaign
from skisnow._support.errors import SkisnowError, StoreError
from skisnow.campaign.reading.campaign import check_campaign
from skisnow.campaign.store import JournalHead, Journals, NewEntry, Store, StoredCampaign, find_campaign
from skisnow.campaign.store.engine import writing
from skisnow.campaign.store.schema import journal
from skisnow.cli import main

RAW = b"experiment;site\r\nP1;Gr\xf6den\r\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    folder = tmp_path / "campaign"
    (folder / "raw").mkdir(parents=True)
    (folder / "campaign.toml").write_text('name = "Gröden"', encoding="utf-8")
    (folder / "raw" / "penetration.csv").write_bytes(RAW)
    return folder


@pytest.fixture
def place(tmp_path: Path) -> Path:
    return tmp_path / "store.sqlite3"


class Shell:
    def __init__(self, place: Path, capsys: pytest.CaptureFixture[str]) -> None:
        self.place, self.capsys = place, capsys

    def text(self, *words: object, code: int = 0) -> tuple[str, str]:
        assert main(["store", *map(str, words), "--store", str(self.place)]) == code
        return self.capsys.readouterr()

    def json(self, *words: object, code: int = 0) -> Any:
        out, told = self.text(*words, "--json", code=code)
        assert told == ""
        return json.loads(out)


@pytest.fixture
def shell(place: Path, capsys: pytest.CaptureFixture[str]) -> Shell:
    return Shell(place, capsys)


def test_from_add_to_export_in_json(shell: Shell, folder: Path, tmp_path: Path) -> None:
    added = shell.json("add", folder)
    assert (added["name"], added["n_files"], added["already_stored"]) == ("Gröden", 2, False)
    assert added["n_bytes"] == len(RAW) + len('name = "Gröden"'.encode())
    assert added["n_errors"] >= 1  # no penetration.csv and no shear.csv where they should be
    assert shell.json("add", folder) == {**added, "already_stored": True}
    (listed,) = shell.json("list")["campaigns"]
    shown = shell.json("show", added["id"][:5])
    assert {**listed, "files": shown["files"]} == shown
    for key in ("id", "name", "n_files", "n_bytes", "sha256", "n_errors", "n_warnings"):
        assert listed[key] == added[key], key
    assert listed["added_at"].endswith("+00:00")
    sha256 = hashlib.sha256(RAW).hexdigest()
    assert shown["files"][1] == {"path": "raw/penetration.csv", "size": len(RAW), "sha256": sha256}
    out = tmp_path / "out"
    assert shell.json("export", added["id"], "--out", out) == {**listed, "n_corrections": 0, "out": str(out)}
    assert (out / "raw" / "penetration.csv").read_bytes() == RAW
    assert shell.json("verify") == {"findings": []}


def test_what_was_corrected_in_the_lab_is_exported(shell: Shell, folder: Path, tmp_path: Path, place: Path) -> None:
    id_ = shell.json("add", folder)["id"]
    with Store.open(place) as store:
        entry = NewEntry(
            action="correct", file="shear.csv", test="1", cells={"2/depth_mm": "6,5"}, who="Ada", why="slip"
        )
        standing = {"2/depth_mm": "5,6", "2/site": "Gröden"}
        written = Journals(store).correct(id_, entry, seen=0, standing=standing)
    out, told = shell.text("export", id_[:6], "--out", tmp_path / "out")
    assert str(tmp_path / "out") in out and "corrections.csv: 1" in out
    assert told == ""
    with (tmp_path / "out" / "corrections.csv").open(encoding="utf-8", newline="") as file:
        (row,) = csv.reader(line for line in file if not line.startswith("file,"))
    assert row == ["shear.csv", "1", "2", "depth_mm", "5,6", "6,5", "Ada", str(written.at), "slip"]
    assert (tmp_path / "out" / "raw" / "penetration.csv").read_bytes() == RAW
    assert shell.json("export", id_, "--out", tmp_path / "again")["n_corrections"] == 1
    assert shell.json("export", id_, "--as-added", "--out", tmp_path / "alone")["n_corrections"] == 0
    assert sorted(path.name for path in (tmp_path / "alone").rglob("*.*")) == ["campaign.toml", "penetration.csv"]


def test_from_add_to_export_in_words(shell: Shell, folder: Path, tmp_path: Path) -> None:
    out, told = shell.text("add", folder)
    id_ = out.split()[0]
    assert f"{id_}  Gröden: 2 files" in out and "checked: errors" in out
    assert told == ""
    assert id_ in shell.text("add", folder)[0]
    assert shell.text("list")[0].startswith(f"{id_}  2")
    assert hashlib.sha256(RAW).hexdigest() in shell.text("show", id_)[0]
    assert str(tmp_path / "out") in shell.text("export", id_, "--out", tmp_path / "out")[0]
    assert shell.text("verify")[1] == ""


@pytest.mark.parametrize(("counts", "lists"), [((0, 0), False), ((1, 0), True), ((0, 2), True)])
def test_an_import_with_problems_names_the_check_to_run(
    counts: tuple[int, int], lists: bool, shell: Shell, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    add = Store.add

    def counted(store: Store, *words: Any, **named: Any) -> Any:
        return replace(add(store, *words, **named), n_errors=counts[0], n_warnings=counts[1])

    monkeypatch.setattr(Store, "add", counted)
    told = shell.text("add", folder)[0]
    assert f"checked: errors {counts[0]}, warnings {counts[1]}" in told
    assert ("skisnow check" in told) == lists


def test_an_empty_store(shell: Shell, place: Path) -> None:
    Store.open(place).close()
    assert shell.json("list") == {"campaigns": [], "lab_campaigns": []}
    assert shell.text("list")[1] == ""


@pytest.mark.parametrize("words", [["list"], ["show", "0123"], ["verify"], ["export", "0123", "--out", "x"]])
def test_without_a_store(words: list[str], shell: Shell, place: Path, noted_errors: list[SkisnowError]) -> None:
    assert shell.text(*words, "--json", code=1)[0] == ""
    assert noted_errors[-1].code == "no_store"
    assert not place.exists()


def test_trouble_goes_to_stderr(shell: Shell, folder: Path, tmp_path: Path, noted_errors: list[SkisnowError]) -> None:
    shell.text("add", folder)
    out, told = shell.text("export", "ffff", "--out", tmp_path / "out", "--json", code=1)
    assert (out, noted_errors[-1].code) == ("", "unknown_id")
    assert "Gröden" in told
    out, told = shell.text("add", tmp_path / "absent", code=1)
    assert (out, noted_errors[-1].code) == ("", "no_folder")


def test_damage_is_exit_code_one(shell: Shell, folder: Path, place: Path) -> None:
    id_ = shell.json("add", folder)["id"]
    raw = bytearray(place.read_bytes())
    raw[raw.index(RAW)] ^= 1
    place.write_bytes(raw)
    (finding,) = shell.json("verify", code=1)["findings"]
    assert (finding["campaign"], finding["path"]) == (id_, "raw/penetration.csv")
    assert "raw/penetration.csv" in shell.text("verify", code=1)[0]
    assert "whole: 1" in shell.text("add", folder)[0]
    assert shell.json("verify") == {"findings": []}


def test_a_check_that_breaks_is_reported(shell: Shell, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def breaks(_: Path) -> None:
        raise ZeroDivisionError("by zero")

    monkeypatch.setattr("skisnow.campaign.reading.campaign.check_campaign", breaks)
    out, told = shell.text("add", folder, "--json")
    assert json.loads(out)["n_errors"] is None
    assert "ZeroDivisionError: by zero" in told
    assert "not checked" in shell.text("list")[0]


def test_store_and_json_before_or_after_actions(folder: Path, place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["store", "--store", str(place), "--json", "add", str(folder)]) == 0
    added = json.loads(capsys.readouterr().out)
    for words in (["--store", str(place), "list", "--json"], ["--json", "list", "--store", str(place)]):
        assert main(["store", *words]) == 0
        assert json.loads(capsys.readouterr().out)["campaigns"][0]["id"] == added["id"]
    assert main(["store", "--store", str(place.with_name("other")), "list", "--store", str(place)]) == 0
    assert added["id"] in capsys.readouterr().out


TOML = """name = "Nordhang"
observers = ["Ada"]
tool = [{name = "ski", shape = "ski", length_mm = 200, width_mm = 62}]
"""


def entered(place: Path, *depths: str) -> str:
    """A campaign that consists of lab entries: its description and a reading for each depth (mm); its id."""
    with Store.open(place) as store:
        journals = Journals(store)
        id_ = journals.begin(TOML)
        seen = 0
        for position, depth in enumerate(depths):
            cells = {"experiment": "1", "site": "A", "tool": "ski", "edge_angle_deg": "30", "depth_mm": depth}
            cells["load_N"] = str(20 * (position + 1))
            entry = NewEntry(action="add", file="penetration.csv", test="1", cells=cells, position=position)
            seen = journals.append(id_, entry, seen=seen).sequence
    return id_


def assert_read(folder: Path, *depths: float) -> None:
    """`check` finds no error in a campaign folder, and it has these depths (mm)."""
    assert [problem.code for problem in check_campaign(folder) if problem.severity == "error"] == []
    tests = read_campaign(folder).penetration
    assert tests is not None
    assert [depth * 1000 for depth in tests.penetration_depth] == pytest.approx(depths)


def test_a_campaign_of_the_lab_is_listed_and_exported(shell: Shell, place: Path, tmp_path: Path, folder: Path) -> None:
    stored, lab = shell.json("add", folder), entered(place, "1.5", "2.25", "3")
    listed = shell.json("list")
    assert [each["id"] for each in listed["campaigns"]] == [stored["id"]]
    (row,) = listed["lab_campaigns"]
    assert (row["id"], row["name"], row["n_entries"]) == (lab, "Nordhang", 4)
    assert f"{lab}  {row['begun_at'][:10]}" in shell.text("list")[0]
    assert shell.json("export", lab[:6], "--out", tmp_path / "out") == {**row, "out": str(tmp_path / "out")}
    assert_read(tmp_path / "out", 1.5, 2.25, 3.0)
    shown = shell.json("show", lab)["files"]
    assert shown == [
        {"path": path.name, "size": path.stat().st_size, "sha256": hashlib.sha256(path.read_bytes()).hexdigest()}
        for path in sorted((tmp_path / "out").iterdir())
    ]


def test_export_of_lab_entries_never_overwrites_and_adds_nothing(shell: Shell, place: Path, tmp_path: Path) -> None:
    lab = entered(place, "1.5")
    out = tmp_path / "out"
    shell.text("export", lab, "--out", out, "--as-added", code=1)
    assert not out.exists()
    out.mkdir()
    (out / "own.txt").write_text("mine")
    shell.text("export", lab, "--out", out, code=1)
    assert [path.name for path in out.iterdir()] == ["own.txt"]
    assert lab in shell.text("export", "ffffffff", "--out", tmp_path / "other", code=1)[1]  # lists what there is


def test_an_id_that_fits_both_kinds_is_ambiguous(place: Path, folder: Path) -> None:
    with Store.open(place) as store:
        stored = store.add(folder).id
        with writing(store.engine) as connection:
            id_ = stored[:4] + ("0" if stored[4] != "0" else "1") * 8
            connection.execute(insert(journal).values(id=id_, begun_at="2026-01-12T08:00:00Z"))
        assert isinstance(find_campaign(store, stored), StoredCampaign)
        assert isinstance(find_campaign(store, id_), JournalHead)
        with pytest.raises(StoreError) as raised:
            find_campaign(store, stored[:4])
        assert stored in str(raised.value)
        assert id_ in str(raised.value)
