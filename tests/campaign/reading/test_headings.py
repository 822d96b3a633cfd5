"""Templates of a campaign's tables, and their headings."""

import re
from pathlib import Path

import numpy as np
import pytest
from tests.coded import raises
from tests.key_names import DROP_CONE_DEPTH, SNOW_DENSITY
from tests.present import present

from skisnow._support.errors import OutputError
from skisnow.campaign import read_campaign
from skisnow.campaign.reading.headings import columns_by_synonym
from skisnow.campaign.reading.table_forms import DENSITY, DROP_CONE, PENETRATION, SHEAR, TableForm
from skisnow.campaign.templates import write_new_campaign
from skisnow.cli import main
from skisnow.estimation import analyse

from ..conftest import SmallCampaign

GERMAN = {
    "penetration.csv": """\
Versuch;Standort;Stempel;Kantwinkel [°];Last [N];Eindringtiefe [mm];Datum;Bearbeiter
P1;Süd;piece;30;70,5;1,25;23.11.2026 09:10;Huber
P1;Süd;piece;30;140,5;2,5;;
P1;Süd;piece;30;210,5;3,75;;
""",
    "shear.csv": """\
Versuch;Standort;Platte;Kantwinkel [°];Tiefe [mm];Hebelarm [mm];Drehmoment [Nm];Datum
S1;Süd;blade;90;5,5;300;12,25;23.11.26
""",
    "density.csv": "Probe;Standort;Dichte [kg/m³]\nD1;Süd;410,5\n",
    "drop_cone.csv": "Versuch;Standort;Wiederholung;Kegeltiefe [mm]\nC1;Süd;1;12,5\n",
}


def test_each_proposal_is_one_line_and_can_be_applied(small: SmallCampaign, capsys: pytest.CaptureFixture[str]) -> None:
    """Tables as a German Excel writes them: semicolons, decimal commas, Windows-1252."""
    german = {name: text.encode("cp1252") for name, text in GERMAN.items()}
    assert main(["check", str(small.written(german))]) == 1
    printed = capsys.readouterr().out.splitlines()
    errors = [line for line in printed if line.startswith("error ")]
    assert len(errors) == 4
    assert len([line for line in printed if "Windows-1252 in penetration" in line]) == 1
    lines = [found[0] for line in errors if (found := re.search(r"columns\.\w+ = \{.*?\}", line))]
    small["campaign.toml"] = "\n".join([*lines, small["campaign.toml"]])
    campaign = small.read(german)
    assert campaign.penetration is not None
    assert np.degrees(campaign.penetration.edge_angle).tolist() == pytest.approx([30.0])
    assert (campaign.penetration.load.tolist(), campaign.penetration.penetration_depth[0]) == (
        [70.5, 140.5, 210.5],
        1.25e-3,
    )
    assert (present(campaign.shear).lever_arm[0], present(campaign.shear).moment[0]) == (0.3, 12.25)
    assert (present(campaign.density).snow_density[0], present(campaign.drop_cone).drop_cone_depth[0]) == (
        410.5,
        12.5e-3,
    )
    assert campaign.penetration.further["time"][0] == "2026-11-23T09:10:00"
    assert not [problem for problem in campaign.problems if problem.needs_action]


@pytest.mark.parametrize(
    ("form", "headings", "columns"),
    [
        (
            PENETRATION,
            ["Nr.", "Hang", "Prüfkörper", "Aufkantwinkel / °", "Kraft (N)", "Einsinktiefe in mm", "Bemerkung"],
            ["experiment", "site", "tool", "edge_angle_deg", "load_N", "depth_mm", "remark"],
        ),
        (
            SHEAR,
            ["Versuch Nr.", "Ort", "Scherplatte", "Winkel", "Tiefe", "Hebel [mm]", "M [Nm]", "Drehwinkel", "Dichte"],
            ["experiment", "site", "plate", "edge_angle_deg", "depth_mm", "lever_arm_mm", "moment_Nm",
             "turning_angle_deg", SNOW_DENSITY],
        ),
        (DENSITY, ["Proben-Nr.", "Stelle", "ρ", "Schneedichte (kg/m3)"], ["sample", "site", SNOW_DENSITY]),
        (DENSITY, ["Versuch", "Ort", "Dichte [kg/m³]"], ["sample", "site", SNOW_DENSITY]),
        (DROP_CONE, ["Test", "Ort", "Wdh", "Fallkegel [mm]"], ["test", "site", DROP_CONE_DEPTH]),
        (PENETRATION, ["Essai", "Lieu", "Outil", "Angle [°]", "Force [N]", "Profondeur [mm]"],
         ["experiment", "site", "tool", "edge_angle_deg", "load_N", "depth_mm"]),
        (PENETRATION, ["Farbe", "Kurs", "x", ""], []),
    ],
)  # fmt: skip
def test_headings_that_people_write(form: TableForm, headings: list[str], columns: list[str]) -> None:
    assert list(columns_by_synonym(form, headings).values()) == columns


@pytest.mark.parametrize("ends", [";;", ""])
def test_a_title_above_the_headings_is_passed_over(small: SmallCampaign, ends: str) -> None:
    small["density.csv"] = f"Hang am 23. November{ends}\n{ends}\n{small['density.csv'].replace(',', ';')}"
    campaign = small.read()
    assert present(campaign.density).row.tolist() == [4, 5, 6]


def test_the_likeliest_heading_gets_the_column() -> None:
    for headings, likely in ((["Tiefe oben", "Tiefe"], "Tiefe"), (["Tiefe", "Tiefe [mm]"], "Tiefe [mm]")):
        assert columns_by_synonym(PENETRATION, headings) == {likely: "depth_mm"}


def test_many_alike_are_counted(small: SmallCampaign, capsys: pytest.CaptureFixture[str]) -> None:
    """Merged cells: a name only in the first row."""
    rows = [f"{'D1' if row == 2 else ''},Süd,{300 + row}" for row in range(2, 20)]
    table = "\n".join(["sample,site,snow_density_kg_per_m3", *rows])
    assert main(["check", str(small.written({"density.csv": table}))]) == 1
    printed = capsys.readouterr().out.splitlines()
    assert len([line for line in printed if "density.csv, row" in line]) == 10
    assert any("7 more" in line and "row 19" in line for line in printed)
    assert printed[-1] == "errors: 17, warnings: 0, flags: 0"


def test_a_unit_of_another_quantity_is_neither_proposed_nor_taken(small: SmallCampaign) -> None:
    table = GERMAN["penetration.csv"].replace("Eindringtiefe [mm]", "Eindringtiefe [kg]")
    problem = small.errors({"penetration.csv": table})[0]
    assert "depth_mm" not in problem.action.split("}")[0]
    assert "depth_mm" in problem.action.split("}")[1]
    mapped = f'columns."Eindringtiefe [kg]" = "depth_mm"\n{small["campaign.toml"]}'
    table = small["penetration.csv"].replace("depth_mm", "Eindringtiefe [kg]")
    (problem,) = small.check({"campaign.toml": mapped, "penetration.csv": table})
    assert (problem.severity, problem.code, problem.row, problem.column) == ("error", "other_unit", 1, "depth_mm")


def test_a_mapping_of_one_table_comes_before_that_of_all(small: SmallCampaign) -> None:
    mapping = '[columns]\n"Tiefe" = "depth_mm"\nOrt = "site"\n[columns.drop_cone]\nTIEFE = "drop_cone_depth_mm"\n'
    small["campaign.toml"] += mapping
    for name in ("penetration.csv", "shear.csv"):
        small[name] = small[name].replace("depth_mm", "Tiefe", 1).replace(",site,", ",Ort,")
    small.replace("drop_cone.csv", "drop_cone_depth_mm", "Tiefe")
    campaign = small.read()
    assert campaign.problems == ()
    assert present(campaign.drop_cone).drop_cone_depth[0] == 12.5e-3
    assert present(campaign.shear).penetration_depth[0] == 5.5e-3


@pytest.mark.parametrize(
    ("line", "column", "told"),
    [
        ('columns."Last" = "load"', "columns.Last", "load_N?"),
        ("columns.Last = 3", "columns.Last", "both in quotes"),
        ('columns.penetration.x = "moment_Nm"', "columns.penetration.x", "both in quotes"),
        ('columns = "x"', "columns", "[columns]"),
    ],
)
def test_a_mapping_to_no_column_is_rejected(small: SmallCampaign, line: str, column: str, told: str) -> None:
    small["campaign.toml"] = f"{line}\n{small['campaign.toml']}"
    (problem,) = small.check()
    assert (problem.code, problem.column) == ("bad_toml", column)
    assert told in f"{problem.allowed} {problem.action}"


@pytest.mark.parametrize("xlsx", [False, True])
def test_a_new_campaign_is_sound_and_its_examples_count_nowhere(tmp_path: Path, *, xlsx: bool) -> None:
    folder = tmp_path / "Hintertux"
    files = write_new_campaign(folder, xlsx=xlsx)
    assert sorted(path.name for path in folder.iterdir()) == sorted(path.name for path in files)
    campaign = read_campaign(folder)
    assert (campaign.name, campaign.problems) == ("Hintertux", ())
    assert campaign.penetration is not None
    tables = (campaign.penetration, present(campaign.shear), present(campaign.density), present(campaign.drop_cone))
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


@pytest.mark.parametrize(("titles", "row"), [(0, 1), (19, 20), (20, 1)])
def test_headings_are_searched_in_twenty_rows(small: SmallCampaign, titles: int, row: int) -> None:
    title, table = "Hang\n" * titles, small["density.csv"].replace("site", "sites")
    missing = [each for each in small.errors({"density.csv": title + table}) if each.code == "missing_column"]
    assert [(each.row, each.column) for each in missing] == [(row, "site" if titles < 20 else None)]


def test_a_heading_like_a_known_column_needs_an_action(small: SmallCampaign) -> None:
    for heading, needs_action in (("remrk", True), ("Wetter", False)):
        (problem,) = small.check({"density.csv": small["density.csv"].replace("sample", f"{heading},sample", 1)
                                  .replace("\nD", "\nx,D")})  # fmt: skip
        assert (problem.code, problem.row, problem.column) == ("unknown_column", 1, heading)
        assert (problem.needs_action, "Did you mean 'remark'? Rename 'remrk'" in problem.action) == (needs_action,) * 2
