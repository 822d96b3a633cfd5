"""Conversions by endings, from the command line: results, and refusals with nothing written."""

from pathlib import Path

import pytest

from skisnow import analyse, read_campaign
from skisnow.campaign.caaml import read_caaml
from skisnow.cli import main
from skisnow.interop.caaml import write_caaml
from skisnow.interop.site_pit import site_pit
from skisnow.scenario.snow_map import read_snow_layers
from tests.present import present

from ..campaign.recordings import NEWTON, STEP_MM, built, plain_snow
from .pits import full_pit

TOML = """
name = "Hang"
place = "Kühtai"
observers = ["A. Müller"]
tool = [{name = "disc", shape = "disc", diameter_mm = 100}]
"""
PENETRATION = (
    "experiment,site,tool,edge_angle_deg,load_N,depth_mm,time,snow_temperature_C,air_temperature_C\n"
    + "".join(
        f"p{site}{number},{site},disc,0,{load},{load / 100 * number},2026-02-0{number}T09:10,-{number}.5,-8\n"
        for site in "AB"
        for number in (2, 1)
        for load in (100, 200, 300)
    )
)


@pytest.fixture
def campaign(tmp_path: Path) -> Path:
    folder = tmp_path / "campaign"
    folder.mkdir()
    (folder / "campaign.toml").write_text(TOML, encoding="utf-8")
    (folder / "penetration.csv").write_text(PENETRATION)
    (folder / "density.csv").write_text("sample,site,snow_density_kg_per_m3\n1,A,450\n2,B,300\n3,A,470\n")
    (folder / "snow_micro_pen.csv").write_text("recording,site,file\nr,A,r.pnt\n")
    (folder / "r.pnt").write_bytes(plain_snow(2.0))
    return folder


def told(capsys: pytest.CaptureFixture[str]) -> tuple[list[str], str]:
    found = capsys.readouterr()
    return found.out.split(), found.err


def test_a_site_of_a_campaign_becomes_caaml(campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """H_V of the two series: 300 N at 3 and 6 mm under a disc of 100 mm, and their geometric mean."""
    out = tmp_path / "a.caaml"
    assert main(["convert", str(campaign), str(out), "--site", "A"]) == 0
    assert told(capsys)[0] == [str(out)]
    pit = read_caaml(out)
    assert (pit.name, pit.region, pit.observer, pit.time) == ("A", "Kühtai", "A. Müller", "2026-02-01T09:10:00")
    assert [each.snow_density for each in pit.densities] == [450.0, 470.0]
    assert [each.temperature_C for each in pit.temperatures] == [-2.0]
    assert pit.air_temperature_C == -8.0
    assert "without a depth" in pit.comment
    soft, hard = (300.0 / (3.14159265 * 2500.0 * depth) for depth in (6.0, 3.0))
    assert present(pit.snow_hardness).value == pytest.approx((soft * hard) ** 0.5, rel=1e-6)
    assert (present(pit.snow_hardness).n, pit.failure_shear_stress) == (2, None)
    (force,) = pit.forces
    assert force.force.mean() == pytest.approx(2.0, rel=0.02)
    assert force.depth[0] == pytest.approx(0.0005, abs=1e-5)
    assert (pit.latitude_deg, pit.longitude_deg, pit.elevation) == (-45.5, 170.25, 2120.0)


def test_recordings_of_another_site_and_cancelled_ones_stay_out(campaign: Path) -> None:
    (campaign / "snow_micro_pen.csv").write_text(
        "recording,site,file,status\nr,A,r.pnt,\nq,A,q.pnt,slipped\ns,B,s.pnt,\n"
    )
    for name, force in (("q", 5.0), ("s", 9.0)):
        (campaign / f"{name}.pnt").write_bytes(plain_snow(force))
    analysis = analyse(read_campaign(campaign), n_resamples=100)
    for site, force in (("A", 2.0), ("B", 9.0)):
        (profile,) = site_pit(analysis, site).forces
        assert profile.force.mean() == pytest.approx(force, rel=0.02)


def test_shear_of_a_site_goes_along(campaign: Path, tmp_path: Path) -> None:
    """Two tests at A, one at B; the mean of what `analyse` says of those at A."""
    toml = campaign / "campaign.toml"
    toml.write_text(f"{toml.read_text(encoding='utf-8')}[[plate]]\nname = 'blade'\nlength_mm = 100\n", encoding="utf-8")
    rows = "s1,A,blade,30,40,250,3\ns2,A,blade,30,40,250,5\ns3,B,blade,30,40,250,8\n"
    head = "experiment,site,plate,edge_angle_deg,depth_mm,lever_arm_mm,moment_Nm\n"
    (campaign / "shear.csv").write_text(head + rows, encoding="utf-8")
    assert main(["convert", str(campaign), str(tmp_path / "a.caaml"), "--site", "A"]) == 0
    stress = present(read_caaml(tmp_path / "a.caaml").failure_shear_stress)
    shear = analyse(read_campaign(campaign)).results["shear"]["experiments"]
    here = [row["S_f_N_per_mm2"] for row in shear if row["site"] == "A"]
    assert len(here) == 2 < len(shear)
    assert stress.value == pytest.approx((here[0] + here[1]) / 2.0, rel=1e-3)


def test_the_only_site_needs_no_name(campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "b.caaml"
    assert main(["convert", str(campaign), str(out)]) == 1
    assert "--site: A, B" in told(capsys)[1]
    lines = PENETRATION.splitlines(keepends=True)
    (campaign / "penetration.csv").write_text("".join(line for line in lines if ",A," not in line))
    (campaign / "density.csv").write_text("sample,site,snow_density_kg_per_m3\n2,B,300\n")
    (campaign / "snow_micro_pen.csv").unlink()
    assert main(["convert", str(campaign), str(out)]) == 0
    assert read_caaml(out).name == "B"


def test_a_recording_becomes_caaml(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = tmp_path / "S31M0067_20190302.pnt"
    source.write_bytes(plain_snow(1.0, air_mm=1.0, snow_mm=2.0))
    assert main(["convert", str(source), str(tmp_path / "r.caaml")]) == 0
    assert read_caaml(tmp_path / "r.caaml").time == "2019-03-02"
    assert main(["convert", str(source), str(tmp_path / "again.caaml"), "--time", "2019-03-03"]) == 0
    capsys.readouterr()


def test_a_recording_becomes_layers_of_a_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Air of 0.05 N, 10 mm of snow with 1 N over 10 mm with 3 N: shares of 0.5 and 1.5 of their mean."""
    source, out = tmp_path / "two.pnt", tmp_path / "layers.csv"
    force = [0.05] * round(30.0 / STEP_MM) + [1.0] * round(10.0 / STEP_MM) + [3.0] * round(12.0 / STEP_MM)
    source.write_bytes(built([round(newtons / NEWTON) for newtons in force]))
    assert main(["convert", str(source), str(out), "--layers-to-mm", "20"]) == 0
    layers = read_snow_layers(out)
    assert layers.tops == pytest.approx([top / 1e3 for top in range(21)])
    assert layers.shares == pytest.approx([0.5] * 10 + [1.5] * 11)
    for words, target in ((["30"], "deeper.csv"), (["20"], "layers.caaml"), ([], "none.csv")):
        option = ["--layers-to-mm", *words] if words else []
        assert main(["convert", str(source), str(tmp_path / target), *option]) == 1
        assert not (tmp_path / target).exists()
    capsys.readouterr()


@pytest.mark.parametrize(
    ("target", "more", "words"),
    [
        ("a.caaml", [], "--site: A, B"),
        ("a.caaml", ["--site", "C"], "'C'; it has A, B"),
        ("a.csv", ["--site", "A"], "campaign to CSV is not known"),
        ("a.docx", ["--site", "A"], "states no format"),
        ("a.caam", ["--site", "A"], ".caaml?"),
        ("a.pnt", ["--site", "A"], "SnowMicroPen"),
    ],
)
def test_refusals(
    campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], target: str, more: list[str], words: str
) -> None:
    assert main(["convert", str(campaign), str(tmp_path / target), *more]) == 1
    assert words in told(capsys)[1]
    assert {path.name for path in tmp_path.iterdir()} == {"campaign"}


def test_the_source_is_not_written_over(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = write_caaml(full_pit(), tmp_path / "pit.caaml")
    before = source.read_bytes()
    assert main(["convert", str(source), str(source)]) == 1
    assert "another" in told(capsys)[1]
    assert source.read_bytes() == before


def test_a_missing_source_is_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("gone.caaml", "gone.pnt"):
        assert main(["convert", str(tmp_path / name), str(tmp_path / "x.caaml")]) == 1
        assert name in told(capsys)[1]


def test_densities_beside_experiments_reach_caaml_once(campaign: Path, tmp_path: Path) -> None:
    """450 is a sample of density.csv, too; 480 is not."""
    table = campaign / "penetration.csv"
    head, *rows = PENETRATION.splitlines()
    densities = {"pA1": "480", "pA2": "450", "pB1": "310", "pB2": "310"}
    noted = [f"{row},{densities[row.split(',')[0]]}" for row in rows]
    table.write_text("\n".join([f"{head},snow_density_kg_per_m3", *noted]) + "\n", encoding="utf-8")
    for site, expected in (("A", [450.0, 470.0, 480.0]), ("B", [300.0, 310.0])):
        assert (
            main(["convert", str(campaign), str(tmp_path / "out.caaml"), "--site", site, "--time", "2026-02-01"]) == 0
        )
        assert [layer.snow_density for layer in read_caaml(tmp_path / "out.caaml").densities] == expected


def test_a_sample_with_a_thickness_goes_from_its_top_down(campaign: Path, tmp_path: Path) -> None:
    """Middles 50 and 150 mm; the second has no thickness: its middle stands for its top, as the comment says."""
    (campaign / "density.csv").write_text(
        "sample,site,snow_density_kg_per_m3,sample_depth_mm,sample_thickness_mm\n"
        "1,A,420,50,60\n2,A,450,150,\n3,B,300,30,60\n",
        encoding="utf-8",
    )
    out = tmp_path / "out.caaml"
    for site, expected, is_assumed in (("A", [(0.02, 0.06), (0.15, None)], True), ("B", [(0.0, 0.06)], False)):
        assert main(["convert", str(campaign), str(out), "--site", site, "--time", "2026-02-01"]) == 0
        pit = read_caaml(out)
        assert [(layer.top, layer.thickness) for layer in pit.densities] == expected
        assert ("sample's middle" in pit.comment) is is_assumed
        assert "Densities without a depth" not in pit.comment


def test_a_campaign_becomes_netcdf(campaign: Path, tmp_path: Path) -> None:
    assert main(["convert", str(campaign), str(tmp_path / "out.nc")]) == 0
    assert (tmp_path / "out.nc").read_bytes()[:4] == b"CDF\x02"
