"""What is in the files that others read, line by line, where little or nothing is known."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.io import netcdf_file

from skisnow import read_campaign
from skisnow._support.errors import ParameterError
from skisnow.campaign import read_snow_micro_pen
from skisnow.campaign.caaml import read_caaml
from skisnow.campaign.smet import StationSeries
from skisnow.campaign.snow_pit import DepthTemperature, LayerDensity, PlateValue, SnowLayer, SnowPit
from skisnow.interop.caaml import caaml_text, write_caaml
from skisnow.interop.campaign_netcdf import write_campaign_netcdf
from skisnow.interop.convert import write_smet, write_weather_csv
from skisnow.interop.snowex import write_snowex_force, write_snowex_pit
from tests.coded import raises

from ..campaign.recordings import plain_snow
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


BARE_HEAD = """# Location,-9999
# Site,x
# PitID,x
# Date/Local Time,-9999
# Latitude,-9999
# Longitude,-9999
# HS (cm),80
"""


def test_what_a_pit_does_not_know_is_9999_in_snowex(tmp_path: Path) -> None:
    pit = SnowPit("x", snow_height=0.8, layers=(SnowLayer(0.1), SnowLayer(0.2, 0.05, "F", hardness_bottom="4F")))
    (written,) = write_snowex_pit(pit, tmp_path / "p.csv")
    assert written.name == "p_stratigraphy.csv"
    assert written.read_text(encoding="utf-8") == BARE_HEAD + (
        "# Top (cm),Bottom (cm),Grain Size (mm),Grain Type,Hand Hardness,Manual Wetness,Comments\n"
        "70,-9999,-9999,-9999,-9999,-9999,\n60,55,-9999,-9999,F/4F,-9999,\n"
    )
    one = SnowPit("x", snow_height=0.8, densities=(LayerDensity(0.0, 300.0),))
    (written,) = write_snowex_pit(one, tmp_path / "p.csv")
    assert written.read_text(encoding="utf-8").splitlines()[-1] == "80,-9999,300,-9999,-9999"
    known = full_pit()
    head = write_snowex_pit(known, tmp_path / "q.csv")[0].read_text(encoding="utf-8").splitlines()[:7]
    assert [line.partition(",")[2] for line in head] == [
        "Tirol", known.name, known.name, known.time, "47.25", "11.01", "125",
    ]  # fmt: skip
    with raises(ParameterError, "no_data", name="x"):
        write_snowex_pit(SnowPit("x", snow_height=0.8), tmp_path / "none.csv")
    assert not list(tmp_path.glob("none*"))


def test_a_recording_says_where_and_when_or_that_it_does_not_know(tmp_path: Path) -> None:
    source = tmp_path / "S31M0067_20190302.pnt"
    source.write_bytes(plain_snow(1.0, air_mm=1.0, snow_mm=2.0))
    profile = read_snow_micro_pen(source)
    unknown = replace(profile, latitude_deg=None, longitude_deg=None, recorded_on=None)
    found = []
    for each in (profile, unknown):
        lines = write_snowex_force(each, tmp_path / "r.csv").read_text(encoding="utf-8").splitlines()
        found.append([line.partition(",")[2] for line in lines[:4]])
    assert found == [
        [profile.name, "2019-03-02", "-45.5", "170.25"], [profile.name, "-9999", "-9999", "-9999"],
    ]  # fmt: skip
    depth, force = (float(cell) for cell in lines[-1].split(","))
    assert (depth, force) == pytest.approx((749 * 0.004, profile.force[-1]), abs=1e-6)


def series(*values: float, **known: float) -> StationSeries:
    place = {"latitude_deg": None, "longitude_deg": None, "altitude": None} | known
    time = np.array([1770105600.0 + 3600.0 * i for i in range(len(values))])  # 2026-02-03 08:00 UTC
    return StationSeries("s.smet", "Hang oben", **place, utc_offset=-3.5, time=time, fields={"TA": np.array(values)})


def test_a_station_without_a_place_has_999(tmp_path: Path) -> None:
    lines = write_smet(series(271.0, np.nan), tmp_path / "s.smet").read_text(encoding="utf-8").splitlines()
    assert lines == [
        "SMET 1.1 ASCII", "[HEADER]", "station_id = Hangoben", "station_name = Hang oben", "latitude = -999",
        "longitude = -999", "altitude = -999", "nodata = -999", "tz = -3.5", "fields = timestamp TA", "[DATA]",
        "2026-02-03T04:30:00 271", "2026-02-03T05:30:00 -999",
    ]  # fmt: skip
    placed = write_smet(series(271.0, latitude_deg=47.5, longitude_deg=0.0, altitude=2000.0), tmp_path / "t.smet")
    assert placed.read_text(encoding="utf-8").splitlines()[4:7] == [
        "latitude = 47.5", "longitude = 0", "altitude = 2000",
    ]  # fmt: skip
    nameless = write_smet(replace(series(1.0), station=" "), tmp_path / "u.smet").read_text(encoding="utf-8")
    assert "station_id = station\n" in nameless


def test_a_value_that_stands_for_none_is_rejected(tmp_path: Path) -> None:
    with raises(ParameterError, "out_of_range", file="s.smet", no_data=-999.0, when="2026-02-03T05:30:00"):
        write_smet(series(1.0, -999.0), tmp_path / "s.smet")
    assert not (tmp_path / "s.smet").exists()


def test_only_known_quantities_of_a_station_become_csv(tmp_path: Path) -> None:
    wind = replace(series(271.0), fields={"VW": np.array([1 / 3]), "XX": np.array([1.0]), "TSS": np.array([268.15])})
    text = write_weather_csv(wind, tmp_path / "w.csv").read_text(encoding="utf-8")
    assert text == ("time,snow_surface_temperature_C,wind_speed_m_per_s\n2026-02-03T04:30:00-03:30,-5,0.3333333333\n")


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
