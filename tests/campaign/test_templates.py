"""A new campaign: complete, without a problem, and without a number that an estimate would count."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.coded import raises

from skisnow._support.errors import OutputError
from skisnow.campaign import read_campaign
from skisnow.campaign.templates import write_new_campaign
from skisnow.cli import main
from skisnow.estimation import analyse


@pytest.mark.parametrize("xlsx", [False, True])
def test_a_new_campaign_is_sound_and_its_examples_count_nowhere(tmp_path: Path, *, xlsx: bool) -> None:
    folder = tmp_path / "Hintertux"
    files = write_new_campaign(folder, xlsx=xlsx)
    assert sorted(path.name for path in folder.iterdir()) == sorted(path.name for path in files)
    campaign = read_campaign(folder)
    assert (campaign.name, campaign.problems) == ("Hintertux", ())
    assert campaign.penetration is not None
    assert campaign.shear is not None
    assert campaign.density is not None
    assert campaign.drop_cone is not None
    tables = (campaign.penetration, campaign.shear, campaign.density, campaign.drop_cone)
    assert all(table.cancelled[0].startswith("example") and len(table.cancelled) == 1 for table in tables)
    tool = campaign.tools[campaign.penetration.tool[0]]
    assert (tool.length, tool.width) == (0.2, 0.062)  # type: ignore[attr-defined]
    assert (campaign.load_steps[0], campaign.load_steps[-1]) == (12.0, 492.0)
    results = analyse(campaign, n_resamples=100, seed=1).results
    assert not any(row["used"] for row in (*results["penetration"]["experiments"], *results["shear"]["experiments"]))


def test_tables_that_are_there_get_a_description_alone(tmp_path: Path) -> None:
    (tmp_path / "shear.csv").write_text("Versuch;Ort\n1;Hang\n", encoding="utf-8")
    with raises(OutputError, "holds_campaign_already", there=["shear.csv"]):
        write_new_campaign(tmp_path, xlsx=True)
    assert [path.name for path in write_new_campaign(tmp_path)] == ["campaign.toml"]
    assert (tmp_path / "shear.csv").read_text(encoding="utf-8") == "Versuch;Ort\n1;Hang\n"


def test_nothing_is_written_over(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "campaign", str(tmp_path / "new")]) == 0
    assert "skisnow check" in capsys.readouterr().out
    with raises(OutputError, "holds_campaign_already"):
        write_new_campaign(tmp_path / "new", xlsx=True)
    assert main(["new", "campaign", str(tmp_path / "new")]) == 1
