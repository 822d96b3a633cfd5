"""A small campaign without a problem, to be changed by each test."""

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

FILES = {
    "campaign.toml": """\
name = "north slope"
place = "Kühtai"
observers = ["A. Müller", "B"]
gauge_resolution_mm = 0.01
load_uncertainty_N = 0.5
moment_uncertainty_Nm = 0.02
lever_arm_uncertainty_mm = 0.4
load_steps_N = [70, 140.5]

[[tool]]
name = "piece"
shape = "ski"
length_mm = 200
width_mm = 62

[[tool]]
name = "disc 100"
shape = "disc"
diameter_mm = 100

[[tool]]
name = "roll"
shape = "cylinder"
radius_mm = 50
width_mm = 80

[[plate]]
name = "blade"
length_mm = 200
""",
    "penetration.csv": """\
experiment,site,tool,edge_angle_deg,load_N,depth_mm,spot,snow_density_kg_per_m3,status,remark
P1,Süd,piece,30,70.5,1.25,a,350,,first
P1,Süd,piece,30,140.5,2.5,a,,,
P1,Süd,piece,30,210.5,3.75,a,360,,"hard, wet"
P2,Nord,disc 100,0,70.5,0.5,,,,
P2,Nord,disc 100,0,140.5,1,,,,
""",
    "shear.csv": """\
experiment,site,plate,edge_angle_deg,depth_mm,lever_arm_mm,moment_Nm,spot,drop_cone_depth_mm
S1,Süd,blade,90,5.5,300,12.25,a,14.5
S2,Nord,blade,45,6,300,10,,
""",
    "density.csv": "sample,site,snow_density_kg_per_m3\nD1,Süd,410.5\nD2,Nord,300\nD2,Nord,310\n",
    "drop_cone.csv": "test,site,repeat,drop_cone_depth_mm\nC1,Süd,1,12.5\nC1,Süd,2,13.5\nC2,Süd,1,17\n",
}


@pytest.fixture
def small_campaign() -> dict[str, str]:
    """Texts of the files of a campaign without a problem."""
    return dict(FILES)


@pytest.fixture
def write_campaign(tmp_path: Path) -> Callable[[Mapping[str, str | bytes]], Path]:
    """Write files into a folder, texts in UTF-8 as they are."""

    def write(files: Mapping[str, str | bytes]) -> Path:
        folder = tmp_path / "campaign"
        folder.mkdir(exist_ok=True)
        for old in folder.iterdir():
            old.unlink()
        for name, content in files.items():
            (folder / name).write_bytes(content.encode() if isinstance(content, str) else content)
        return folder

    return write
