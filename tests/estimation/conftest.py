"""Small campaigns written as files, so that every estimate is tested through the door that users take."""

from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from skisnow.campaign import Campaign, read_campaign

CAMPAIGN_TOML = """
name = "test"
gauge_resolution_mm = {gauge}
load_uncertainty_N = {load}
moment_uncertainty_Nm = {moment}
lever_arm_uncertainty_mm = {arm}
[[tool]]
name = "ski"
shape = "ski"
length_mm = 200
width_mm = 62
[[tool]]
name = "disc"
shape = "disc"
diameter_mm = 100
[[plate]]
name = "blade"
length_mm = 100
"""

MakeCampaign = Callable[..., Campaign]


@pytest.fixture
def make_campaign(tmp_path: Path) -> MakeCampaign:
    """Write and read a campaign from rows of cells."""

    def make(
        penetration: Sequence[Sequence[object]] = (),
        shear: Sequence[Sequence[object]] = (),
        *,
        gauge: float = 0.01,
        load: float = 0.0,
        moment: float = 0.0,
        arm: float = 0.0,
        extra: str = "",
        top: str = "",
        further: dict[str, str] | None = None,
        columns: str = "",
        shear_columns: str = "",
    ) -> Campaign:
        folder = tmp_path / "campaign"
        folder.mkdir(exist_ok=True)
        toml = top + CAMPAIGN_TOML.format(gauge=gauge, load=load, moment=moment, arm=arm) + extra
        (folder / "campaign.toml").write_text(toml, encoding="utf-8")
        heads = {
            "penetration.csv": ("experiment,site,tool,edge_angle_deg,load_N,depth_mm" + columns, penetration),
            "shear.csv": (
                "experiment,site,plate,edge_angle_deg,depth_mm,lever_arm_mm,moment_Nm" + shear_columns,
                shear,
            ),
        }
        for name, (head, rows) in heads.items():
            if rows:
                lines = [head, *(",".join(str(cell) for cell in row) for row in rows)]
                (folder / name).write_text("\n".join(lines) + "\n", encoding="utf-8")
        for name, text in (further or {}).items():
            (folder / name).write_text(text, encoding="utf-8")
        return read_campaign(folder)

    return make
