"""The lab analyses campaigns in memory: the same numbers as over the folder that is exported, and no folder made."""

from base64 import b64decode
from pathlib import Path
from typing import Any

import pytest

import skisnow
from skisnow.campaign import read_campaign
from skisnow.campaign.store import Journals, NewEntry, Store, export_corrected
from skisnow.estimation import analyse
from skisnow.report.campaign.page import DRAWERS
from skisnow.report.formatting import significant
from skisnow.web.campaign_analysis import CampaignSource, Choice, Numbers, analyse_files, figure
from skisnow.web.edit_session import CorrectionSession
from skisnow.web.scenario_fields import campaign_snow, results_and_snow_words
from skisnow.web.settings import Lab
from skisnow.web.transfer import files_in_memory, write_campaign
from tests.present import present

from ..campaign.recordings import plain_snow
from .campaign_texts import DESK

TOML = DESK
ROWS = [("20", "1.5"), ("40", "2.1"), ("60", "2.6")]
PENETRATION = "experiment,site,tool,edge_angle_deg,load_N,depth_mm\n" + "".join(
    f"{name},A,ski piece,30,{load},{depth}\n" for name in ("1", "2") for load, depth in ROWS
)


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    return Lab(Store.open(tmp_path / "store.sqlite3"), tmp_path / "runs")


SMET = "SMET 1.1 ASCII\n[HEADER]\nstation_id = S\nnodata = -999\nfields = timestamp TA\n[DATA]\n2026-02-03T08:00 263\n"


def kept_id(lab: Lab, folder: Path) -> str:
    folder.mkdir()
    (folder / "campaign.toml").write_text(TOML, encoding="utf-8")
    (folder / "penetration.csv").write_text(PENETRATION, encoding="utf-8")
    (folder / "photo.jpg").write_bytes(b"\xff\xd8")
    return lab.store.add(folder).id


def entered(lab: Lab) -> str:
    """The id of a campaign with one series that is being entered."""
    journals = Journals(lab.store)
    id_ = journals.begin(TOML)
    for load, depth in ROWS:
        cells = {"site": "A", "tool": "ski piece", "edge_angle_deg": "30", "load_N": load, "depth_mm": depth}
        entry = NewEntry(action="add", file="penetration.csv", test="1", cells={"experiment": "1", **cells}, who="Ada")
        journals.append(id_, entry, seen=journals.entries(id_)[-1].sequence)
    return id_


def correct(lab: Lab, id_: str) -> None:
    entry = NewEntry(
        action="correct", file="penetration.csv", test="2", cells={"7/depth_mm": "3.2"}, who="Ada", why="slip", about=0
    )
    session = CorrectionSession(lab, id_)
    session.write_down(entry, seen=0)


def experiments(results: dict[str, Any]) -> Any:
    return results["penetration"]["experiments"]


def test_a_campaign_being_entered_is_analysed_as_its_export(lab: Lab, tmp_path: Path) -> None:
    id_ = entered(lab)
    write_campaign(lab, "entry", id_, tmp_path / "export")
    found = analyse_files(files_in_memory(lab, "entry", id_), Choice())
    assert isinstance(found, Numbers)
    assert experiments(found.analysis.results) == experiments(analyse(read_campaign(tmp_path / "export")).results)


def test_a_kept_campaign_is_analysed_as_its_export_with_what_was_corrected(lab: Lab, tmp_path: Path) -> None:
    id_ = kept_id(lab, tmp_path / "kept")
    before = files_in_memory(lab, "kept", id_)
    correct(lab, id_)
    export_corrected(lab.store, id_, tmp_path / "export")
    found = analyse_files(files_in_memory(lab, "kept", id_), Choice())
    assert isinstance(found, Numbers)
    results = analyse(read_campaign(tmp_path / "export")).results
    assert experiments(found.analysis.results) == experiments(results)
    assert found.analysis.results["provenance"]["files"] == results["provenance"]["files"]
    assert found.analysis.campaign.unread_files == ("photo.jpg",)
    assert CorrectionSession(lab, id_).quick_results("A").experiments["penetration.csv", "2"] == experiments(results)[1]
    compared = [row for row in results["group_comparisons"] if row["quantity"] == "H_V"]
    assert len(CorrectionSession(lab, id_).quick_verdicts("penetration.csv")) == len(compared)
    assert CorrectionSession(lab, id_).quick_verdicts("density.csv") == []
    unchanged = analyse_files(before, Choice())
    assert isinstance(unchanged, Numbers)
    assert experiments(unchanged.analysis.results)[1] != experiments(results)[1]


def test_recordings_and_weather_of_a_kept_campaign_are_read_from_the_store(lab: Lab, tmp_path: Path) -> None:
    folder = tmp_path / "kept"
    folder.mkdir()
    toml = TOML + '\n[weather]\nfile = "s.smet"\n'
    (folder / "campaign.toml").write_text(toml, encoding="utf-8")
    (folder / "penetration.csv").write_text(PENETRATION, encoding="utf-8")
    (folder / "snow_micro_pen.csv").write_text("recording,site,file\nr,A,R.PNT\n", encoding="utf-8")
    (folder / "R.PNT").write_bytes(plain_snow(2.0))
    (folder / "s.smet").write_text(SMET, encoding="utf-8")
    id_ = lab.store.add(folder).id
    found = analyse_files(files_in_memory(lab, "kept", id_), Choice())
    assert isinstance(found, Numbers)
    assert found.analysis.results["snow_micro_pen"]["recordings"][0]["mean_force_N"] == pytest.approx(2.0, rel=0.01)
    assert found.analysis.results["weather"]["station"] == "S"
    assert "regressions" in found.tables["en"]
    (folder / "penetration.csv").unlink()
    alone = analyse_files(files_in_memory(lab, "kept", lab.store.add(folder).id), Choice())
    assert isinstance(alone, Numbers)
    assert list(alone.tables["de"]) == ["published_relations", "snow_micro_pen"]
    assert "Handhärte" in alone.key_results["de"][0] and "Plattenversuch" in alone.key_results["de"][0]
    assert set(CorrectionSession(lab, id_).tables) == {"penetration.csv"}
    assert (
        CorrectionSession(lab, id_).quick_results("A").experiments["penetration.csv", "1"]
        == experiments(found.analysis.results)[0]
    )


def test_a_measured_unloading_ratio_is_that_of_the_run_unless_one_is_typed(lab: Lab, tmp_path: Path) -> None:
    skisnow.write_reference(tmp_path / "reference", seed=1)
    key = f"kept-{lab.store.add(tmp_path / 'reference').id}"
    analysis = campaign_snow(lab, key)
    _, words = results_and_snow_words(analysis, "carved-46m", {})
    snow = analyse(read_campaign(tmp_path / "reference")).snow()
    assert f"; k_u/H_V = {significant(present(snow.unloading_ratio))}, [" in words
    assert "k_u" not in results_and_snow_words(analysis, "carved-46m", {"snow.unloading_ratio": "10"})[1]


def test_what_is_downloaded_is_the_campaign_that_was_analysed(lab: Lab, tmp_path: Path) -> None:
    """A correction that comes afterwards is not in it; the files that no analysis reads are."""
    id_ = kept_id(lab, tmp_path / "kept")
    subject = CampaignSource(lab, "kept", id_)
    correct(lab, id_)
    subject.write_campaign(tmp_path / "first")
    assert {path.name for path in (tmp_path / "first").iterdir()} == {"campaign.toml", "penetration.csv", "photo.jpg"}
    CampaignSource(lab, "kept", id_).write_campaign(tmp_path / "second")
    export_corrected(lab.store, id_, tmp_path / "export")
    exported = (tmp_path / "export" / "corrections.csv").read_bytes()
    assert (tmp_path / "second" / "corrections.csv").read_bytes() == exported


@pytest.mark.usefixtures("svg_alone")
def test_a_figure_is_drawn_where_there_are_data_for_it(tmp_path: Path) -> None:
    """For a campaign with only a few loads: force over depth in the page's language, none of shear stress."""
    (tmp_path / "campaign.toml").write_text(TOML, encoding="utf-8")
    (tmp_path / "penetration.csv").write_text(PENETRATION, encoding="utf-8")
    analysis = analyse(read_campaign(tmp_path), n_resamples=100)
    by_name = {drawer.__name__: number for number, drawer in enumerate(DRAWERS)}
    drawn = present(figure(analysis, by_name["force_depth"], "de"))
    assert drawn.name == "fig05_force_depth"
    assert "Eindringtiefe" in b64decode(drawn.image.partition(",")[2]).decode("utf-8")
    assert figure(analysis, by_name["stress_angle"], "de") is None


def test_reports_lie_in_a_folder_that_goes_with_who_holds_it(lab: Lab, tmp_path: Path) -> None:
    subject = CampaignSource(lab, "kept", kept_id(lab, tmp_path / "kept"))
    place = subject.place
    assert place.is_dir()
    assert subject.place == place
    del subject
    assert not place.exists()
