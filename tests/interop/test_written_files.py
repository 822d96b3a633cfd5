"""What is in the files that others read, line by line, where little or nothing is known."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.io import netcdf_file

from skisnow import read_campaign
from skisnow.campaign.caaml import read_caaml
from skisnow.campaign.snow_pit import DepthTemperature, PlateValue, SnowLayer, SnowPit
from skisnow.interop.caaml import caaml_text, write_caaml
from skisnow.interop.campaign_netcdf import write_campaign_netcdf

from .pits import full_pit


def test_half_a_place_is_none_and_a_name_may_be_any(tmp_path: Path) -> None:
    for changes in ({"latitude_deg": None}, {"longitude_deg": None}):
        text = caaml_text(replace(full_pit(), **changes))  # type: ignore[arg-type]
        assert "pointLocation" not in text
        assert '"skisnow-Hang__Süd____Ost"' in text
    assert 'id="skisnow-pit"' in caaml_text(replace(full_pit(), name=""))
    pit = read_caaml(write_caaml(replace(full_pit(), observer=""), tmp_path / "p.xml"))
    assert pit.observer == "unknown"


def test_heights_and_angles_are_whole_numbers_in_caaml() -> None:
    text = caaml_text(replace(full_pit(), elevation=2014.6, slope_angle_deg=16.6))
    assert '<caaml:ElevationPosition uom="m"><caaml:position>2015</caaml:position>' in text
    assert '<caaml:SlopeAnglePosition uom="deg"><caaml:position>17</caaml:position>' in text


def test_a_layer_may_have_one_hardness_at_its_bottom_alone() -> None:
    text = caaml_text(replace(full_pit(), layers=(SnowLayer(0.1, hardness_bottom="P"),)))
    layer = text.partition("<caaml:stratMetaData/>")[2].partition("</caaml:stratProfile>")[0]
    assert layer == (
        '<caaml:Layer><caaml:depthTop uom="cm">10</caaml:depthTop><caaml:hardnessBottom uom="">P</caaml:hardnessBottom>'
        "</caaml:Layer>"
    )


def test_snow_at_its_melting_point_can_be_written_and_a_day_without_a_clock() -> None:
    pit = SnowPit("x", "2026-02-03T09:10:11.5Z", temperatures=(DepthTemperature(0.0, 0.0),))
    assert '<caaml:snowTemp uom="degC">0</caaml:snowTemp>' in caaml_text(pit)
    for given, written in (("2026-02-03T09:10", "2026-02-03T09:10:00"), ("2026-02-03T09:10Z", "2026-02-03T09:10Z")):
        assert f"<caaml:timePosition>{written}</caaml:timePosition>" in caaml_text(replace(pit, time=given))


def test_own_values_have_their_numbers() -> None:
    text = caaml_text(SnowPit("x", "2026-02-03", snow_hardness=PlateValue(2.5, 12, (1.75, 3.5))))
    assert '<skisnow:snowHardness uom="N mm-3" n="12" low="1.75" high="3.5">2.5</skisnow:snowHardness>' in text
    assert "failureShearStress" not in text
    assert "customData" not in caaml_text(SnowPit("x", "2026-02-03"))


TOML = """
name = "Hang Süd"
gauge_resolution_mm = 0.01
tool = [{name = "ski", shape = "ski", length_mm = 200, width_mm = 62}]
plate = [{name = "blade", length_mm = 100}]
"""
PENETRATION = """experiment,site,tool,edge_angle_deg,load_N,depth_mm,branch,remark
p1,Süd,ski,0,100,1.5,,dry
p1,Süd,ski,0,200,2.5,,
p1,Süd,ski,0,100,2.4,unloading,
p2,Nord,ski,45,120,6,,wet
p2,Nord,ski,45,240,8.5,,
"""
SHEAR = """experiment,site,plate,edge_angle_deg,depth_mm,lever_arm_mm,moment_Nm,snow_density_kg_per_m3
s1,Süd,blade,90,5,250,12.5,410
"""


@pytest.fixture
def written(tmp_path: Path) -> Any:
    folder = tmp_path / "campaign"
    folder.mkdir()
    (folder / "campaign.toml").write_text(TOML, encoding="utf-8")
    (folder / "penetration.csv").write_text(PENETRATION, encoding="utf-8")
    (folder / "shear.csv").write_text(SHEAR, encoding="utf-8")
    write_campaign_netcdf(read_campaign(folder), tmp_path / "out.nc")
    return netcdf_file(tmp_path / "out.nc", mmap=False)


def texts(file: Any, name: str) -> list[str]:
    return [b"".join(row).rstrip(b"\0").decode("utf-8") for row in file.variables[name].data]


def test_readings_are_si_and_belong_to_their_experiment(written: Any) -> None:
    values = {name: variable.data for name, variable in written.variables.items()}
    np.testing.assert_allclose(values["penetration_reading_load"], [100.0, 200.0, 120.0, 240.0])
    np.testing.assert_allclose(values["penetration_reading_depth"], [0.0015, 0.0025, 0.006, 0.0085])
    assert values["penetration_reading_row_size"].tolist() == [2, 2]
    assert values["penetration_reading_row"].tolist() == [2, 3, 5, 6]
    assert values["unloading_reading_row_size"].tolist() == [1, 0]
    np.testing.assert_allclose(values["unloading_reading_depth"], [0.0024])
    np.testing.assert_allclose(values["penetration_test_edge_angle"], [0.0, np.pi / 4.0])
    np.testing.assert_allclose(values["shear_test_lever_arm"], [0.25])
    np.testing.assert_allclose(values["shear_test_snow_density"], [410.0])
    assert written.variables["shear_test_snow_density"].standard_name == b"snow_density"


def test_absent_numbers_are_missing_and_texts_are_kept_and_units_and_conventions_are_stated(written: Any) -> None:
    density = written.variables["penetration_test_snow_density"]
    assert density.data.tolist() == [density._FillValue] * 2
    assert texts(written, "penetration_test_site") == ["Süd", "Nord"]
    assert texts(written, "penetration_reading_further_1") == ["dry", "", "wet", ""]
    assert written.variables["penetration_reading_further_1"].long_name == b"remark"
    assert written.Conventions.startswith(b"CF-")
    assert written.title.decode("utf-8") == "Hang Süd"
    units = {name: getattr(variable, "units", None) for name, variable in written.variables.items()}
    assert units["penetration_reading_load"] == b"N" and units["shear_test_moment"] == b"N m"
    numbers = [name for name, variable in written.variables.items() if variable.typecode() != "c"]
    assert all(units[name] for name in numbers)
    assert written.variables["penetration_reading_row_size"].sample_dimension == b"penetration_reading"
