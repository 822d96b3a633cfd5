"""A small campaign without a problem, to be changed by each test."""

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path

import pytest

from skisnow.campaign import Campaign, Problem, check_campaign, read_campaign

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


class SmallCampaign(dict[str, str]):
    """Texts of the files of a campaign, with the folder into which they are written; further files come with a call."""

    def __init__(self, folder: Path) -> None:
        super().__init__(FILES)
        self.folder = folder

    def written(self, further: Mapping[str, str | bytes] | None = None) -> Path:
        """The folder with these files alone, texts in UTF-8 as they are."""
        return write_files(self.folder, {**self, **(further or {})})

    def check(self, further: Mapping[str, str | bytes] | None = None) -> tuple[Problem, ...]:
        return require_sentences(check_campaign(self.written(further)))

    def errors(self, further: Mapping[str, str | bytes] | None = None) -> list[Problem]:
        return [problem for problem in self.check(further) if problem.severity == "error"]

    def read(self, further: Mapping[str, str | bytes] | None = None) -> Campaign:
        return read_campaign(self.written(further))

    def replace(self, file: str, old: str, new: str) -> None:
        self[file] = self[file].replace(old, new)


def require_sentences(problems: Iterable[Problem]) -> tuple[Problem, ...]:
    """The problems, each with a file's name, a range of allowed values and an action that is a sentence."""
    every = tuple(problems)
    for problem in every:
        assert (" " in problem.code, problem.file != problem.code, problem.row != 0) == (False, True, True)
        assert (str(problem.action)[-1], str(problem.allowed)[-1:] == ".") == (".", False), problem
    return every


def write_files(folder: Path, files: Mapping[str, str | bytes]) -> Path:
    folder.mkdir(exist_ok=True)
    for old in folder.iterdir():
        old.unlink()
    for name, content in files.items():
        (folder / name).write_bytes(content.encode() if isinstance(content, str) else content)
    return folder


@pytest.fixture
def write_campaign(tmp_path: Path) -> Callable[[Mapping[str, str | bytes]], Path]:
    return partial(write_files, tmp_path / "campaign")


@pytest.fixture
def small(tmp_path: Path) -> SmallCampaign:
    return SmallCampaign(tmp_path / "campaign")
