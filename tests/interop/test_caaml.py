"""CAAML out and in: what is written is read again, and as the standard has it; what would hurt is refused."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.errors import FieldDataError, ParameterError
from skisnow.campaign.caaml import read_caaml
from skisnow.campaign.snow_pit import DepthTemperature, SnowLayer, SnowPit
from skisnow.interop.caaml import caaml_text, write_caaml
from tests.coded import Coded, coded, raises

from .pits import full_pit

SNOWPILOT = """<?xml version="1.0" encoding="UTF-8"?>
<SnowProfile xmlns="http://caaml.org/Schemas/SnowProfileIACS/v6.0.5" xmlns:gml="http://www.opengis.net/gml" gml:id="x">
 <timeRef><recordTime><TimeInstant><timePosition>2024-12-10T11:30:00</timePosition></TimeInstant></recordTime></timeRef>
 <srcRef><Operation gml:id="o"><name>School</name><contactPerson gml:id="p"><name>Kim</name></contactPerson></Operation></srcRef>
 <locRef gml:id="l"><name>Ridge</name><obsPointSubType>x</obsPointSubType></locRef>
 <snowProfileResultsOf><SnowProfileMeasurements dir="{direction}">
  {height}
  <stratProfile><stratMetaData/><Layer><depthTop uom="cm">{top}</depthTop><thickness uom="mm">150</thickness>
   <grainSize uom="mm"><Components><avg>fine</avg></Components></grainSize>
   <hardnessTop uom="">4F</hardnessTop><hardnessBottom uom="">1F</hardnessBottom></Layer></stratProfile>
  <tempProfile><tempMetaData/><Obs><depth uom="cm">10</depth><snowTemp uom="degC">{temperature}</snowTemp></Obs></tempProfile>
 </SnowProfileMeasurements></snowProfileResultsOf>
</SnowProfile>"""  # noqa: E501
HEIGHT = '<snowPackCond><hS><Components><height uom="cm">140</height></Components></hS></snowPackCond>'


def foreign(path: Path, **changes: str) -> Path:
    words = {"direction": "top down", "height": HEIGHT, "top": "20", "temperature": "-3"} | changes
    path.write_text(SNOWPILOT.format(**words), encoding="utf-8")
    return path


def same(first: SnowPit, second: SnowPit) -> bool:
    forces = zip(first.forces, second.forces, strict=True)
    together = all(
        a.method == b.method and np.allclose(a.depth, b.depth, atol=1e-15) and np.array_equal(a.force, b.force)
        for a, b in forces
    )
    return together and replace(first, forces=()) == replace(second, forces=())


def test_a_pit_comes_back_as_it_was(tmp_path: Path) -> None:
    assert same(read_caaml(write_caaml(full_pit(), tmp_path / "pit.caaml")), full_pit())


def test_a_bare_pit_comes_back_as_it_was(tmp_path: Path) -> None:
    bare = SnowPit(name="x", time="2026-02-03", observer="B")
    assert same(read_caaml(write_caaml(bare, tmp_path / "pit.xml")), bare)


def test_another_program_s_file_of_another_version(tmp_path: Path) -> None:
    pit = read_caaml(foreign(tmp_path / "pit.xml"))
    assert (pit.name, pit.observer, pit.time) == ("Ridge", "Kim", "2024-12-10T11:30:00")
    assert pit.snow_height == pytest.approx(1.4)
    (layer,) = pit.layers
    assert (layer.top, layer.thickness, layer.grain_size) == (0.2, 0.15, None)
    assert (layer.hardness, layer.hardness_bottom) == ("4F", "1F")
    assert pit.temperatures == (DepthTemperature(0.1, -3.0),)


def test_heights_from_the_ground_become_depths(tmp_path: Path) -> None:
    pit = read_caaml(foreign(tmp_path / "pit.xml", direction="bottom up"))
    assert pit.layers[0].top == pytest.approx(1.2)
    assert pit.temperatures[0].depth == pytest.approx(1.3)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"direction": "bottom up", "height": ""}, "height of"),
        ({"temperature": "cold"}, r"snowTemp.*'cold'.*finite number"),
        ({"temperature": "nan"}, "finite number"),
        ({"temperature": "missing"}, "snowTemp"),
        ({"top": ""}, "depthTop"),
    ],
)
def test_what_cannot_be_taken_is_named(tmp_path: Path, changes: dict[str, str], words: str) -> None:
    with pytest.raises(FieldDataError, match=rf"pit\.xml.*{words}"):
        read_caaml(foreign(tmp_path / "pit.xml", **changes))


BOMB = """<!DOCTYPE b [<!ENTITY a "lol"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">]><SnowProfile>&b;</SnowProfile>"""
OUTSIDE = """<!DOCTYPE b [<!ENTITY a SYSTEM "file:///etc/passwd">]><SnowProfile>&a;</SnowProfile>"""


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (BOMB, "document type"),
        (OUTSIDE, "document type"),
        ("<a>" * 100 + "</a>" * 100, "each other"),
        ("<SnowProfile>", "damaged"),
        ("", "not XML"),
        ("<SnowProfile/>", "no namespace"),
        ('<gpx xmlns="http://www.topografix.com/GPX/1/1"/>', "gpx"),
    ],
)
def test_bombs_and_foreign_files_are_refused(tmp_path: Path, content: str, words: str) -> None:
    path = tmp_path / "pit.caaml"
    path.write_text(content, encoding="utf-8")
    with pytest.raises(FieldDataError, match=words):
        read_caaml(path)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"time": ""}, "missing"),
        ({"time": "yesterday"}, coded("missing", time="yesterday")),
        (
            {"layers": (SnowLayer(0.0, hardness="very hard"),)},
            coded("cannot_write", field="hand hardness", value="very hard"),
        ),
        ({"layers": (SnowLayer(0.0, grain_form="piste"),)}, coded("cannot_write", field="grain form", value="piste")),
        ({"temperatures": (DepthTemperature(0.0, 1.5),)}, "cannot_write"),
    ],
)
def test_what_the_standard_cannot_hold_is_refused(changes: dict[str, object], words: str | Coded) -> None:
    with raises(ParameterError, words):
        caaml_text(replace(full_pit(), **changes))  # type: ignore[arg-type]


def test_control_characters_do_not_spoil_the_file(tmp_path: Path) -> None:
    pit = replace(full_pit(), comment="a\x00b\x1bc")
    assert read_caaml(write_caaml(pit, tmp_path / "pit.xml")).comment == "a b c"
