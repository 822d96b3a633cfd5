"""CAAML, line by line, where little or nothing is known."""

from dataclasses import replace
from pathlib import Path

from skisnow.campaign.caaml import read_caaml
from skisnow.campaign.snow_pit import DepthTemperature, PlateValue, SnowLayer, SnowPit
from skisnow.interop.caaml import caaml_text, write_caaml

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
