"""CAAML as other programs read it: snowpylot reads every value back, and the schema's rules hold."""

from pathlib import Path
from typing import Any

import pytest

from skisnow.interop.caaml import write_caaml

from ..interop.pits import full_pit


def test_snowpylot_reads_every_value(tmp_path: Path) -> None:
    snowpylot: Any = pytest.importorskip("snowpylot", reason="snowpylot is not installed (pip install snowpylot)")
    pit, written = full_pit(), snowpylot.caaml_parser(str(write_caaml(full_pit(), tmp_path / "pit.caaml")))
    core, profile = written.core_info, written.snow_profile
    assert (core.pit_name, core.date, core.comment) == (pit.name, "2026-02-03", pit.comment)
    assert core.user.username == pit.observer
    place = core.location
    assert (place.latitude, place.longitude) == (pit.latitude_deg, pit.longitude_deg)
    assert (place.elevation, place.aspect, place.slope_angle) == ([2014.0, "m"], "NE", ["17", "deg"])
    assert (place.country, place.region) == ("AT", "Tirol")
    assert core.weather_conditions.air_temp_pres == [-4.5, "degC"]
    assert (profile.measurement_direction, profile.hs) == ("top down", [125.0, "cm"])
    layers = [
        (each.depth_top, each.thickness, each.hardness, each.grain_form_primary.grain_form, each.comments)
        for each in profile.layers
    ]
    assert layers == [
        ([0.0, "cm"], [12.0, "cm"], "K-", "MFpc", "machine-made"),
        ([12.0, "cm"], [30.0, "cm"], "P+", "RGsr", None),
        ([42.0, "cm"], None, None, "FCxr", None),
    ]
    assert [(each.hardness_top, each.hardness_bottom) for each in profile.layers][2] == ("4F", "P")
    assert [each.grain_form_primary.grain_size_avg for each in profile.layers] == [[0.75, "mm"], [0.5, "mm"], None]
    temperatures = [(each.depth, each.snow_temp) for each in profile.temp_profile]
    assert temperatures == [
        ([0.0, "cm"], [-7.25, "degC"]),
        ([10.0, "cm"], [-5.5, "degC"]),
        ([50.0, "cm"], [0.0, "degC"]),
    ]
    densities = [(each.depth_top, each.thickness, each.density) for each in profile.density_profile]
    assert densities == [
        ([0.0, "cm"], [10.0, "cm"], [512.5, "kgm-3"]),
        ([20.0, "cm"], [10.0, "cm"], [430.0, "kgm-3"]),
        ([50.0, "cm"], None, [350.0, "kgm-3"]),
    ]


def test_order_units_and_codes_are_those_of_the_schema(tmp_path: Path) -> None:
    """The part of the standard's schema that skisnow writes; a wrong order, unit or code does not validate."""
    etree: Any = pytest.importorskip("lxml.etree", reason="lxml is not installed")
    schema = etree.XMLSchema(etree.parse(str(Path(__file__).with_name("caaml_6_0_3_part.xsd"))))
    text = write_caaml(full_pit(), tmp_path / "pit.caaml").read_bytes()
    schema.assertValid(etree.fromstring(text))
    wrong = (
        (b'depthTop uom="cm"', b'depthTop uom="m"'),
        (b">K-<", b">K--<"),
        (b"<caaml:country>AT</caaml:country>", b"<caaml:country>at</caaml:country>"),
        (b"<caaml:obsPointSubType>", b"<caaml:region>x</caaml:region><caaml:obsPointSubType>"),
    )
    for good, bad in wrong:
        assert good in text
        assert not schema.validate(etree.fromstring(text.replace(good, bad)))
