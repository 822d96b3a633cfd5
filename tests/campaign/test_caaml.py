"""CAAML of other programs and versions: read as the standard has it; what would hurt is refused."""

from pathlib import Path

import pytest

from skisnow._support.errors import FieldDataError
from skisnow.campaign import Problem
from skisnow.campaign.caaml import OWN_NAMESPACE, read_caaml
from skisnow.campaign.snow_pit import DepthTemperature, PlateValue, SnowPit

from .conftest import require_sentences

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
        ({"temperature": "cold"}, r"snowTemp.*'cold'.*finite"),
        ({"temperature": "nan"}, "finite number"),
        ({"temperature": "missing"}, "snowTemp"),
        ({"top": ""}, "depthTop"),
    ],
)
def test_what_cannot_be_taken_is_named(tmp_path: Path, changes: dict[str, str], words: str) -> None:
    with pytest.raises(FieldDataError, match=rf"pit\.xml.*{words}"):
        read_caaml(foreign(tmp_path / "pit.xml", **changes))
    assert refusal(foreign(tmp_path / "pit.xml", temperature="x" * 81)).value == "x" * 80


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
def test_bombs_and_foreign_files_are_rejected(tmp_path: Path, content: str, words: str) -> None:
    path = tmp_path / "pit.caaml"
    path.write_text(content, encoding="utf-8")
    with pytest.raises(FieldDataError, match=words):
        read_caaml(path)


CASES = Path(__file__).parents[2].parent / "shared" / "cases" / "pits"
VERSION_6 = """<?xml version="1.0" encoding="UTF-8"?>
<SnowProfile xmlns="http://caaml.org/Schemas/SnowProfileIACS/v{version}" xmlns:gml="http://www.opengis.net/gml">
<timeRef><recordTime><TimeInstant><timePosition>2024-02-10</timePosition></TimeInstant></recordTime></timeRef>
<locRef><name>x</name>
 <validElevation><ElevationPosition{elevation}><position>8200</position></ElevationPosition></validElevation>
 <validAspect><AspectPosition{angle}><position>1.5</position></AspectPosition></validAspect>
 <validSlopeAngle><SlopeAnglePosition{angle}><position>1.5</position></SlopeAnglePosition></validSlopeAngle>
 <pointLocation><gml:Point srsName="CRS84"><gml:pos>46.8 9.8</gml:pos></gml:Point></pointLocation>
</locRef>
<snowProfileResultsOf><SnowProfileMeasurements dir="top down">
 <weatherCond><airTempPres{temperature}>{degrees}</airTempPres></weatherCond>
 <snowPackCond><hS><Components><height{length}>150</height></Components></hS></snowPackCond>
 <stratProfile><Layer><depthTop{length}>10</depthTop><thickness{length}>4</thickness>
  <grainSize{grain}><Components><avg>2</avg></Components></grainSize></Layer></stratProfile>
 <tempProfile><Obs><depth{length}>20</depth><snowTemp{temperature}>{degrees}</snowTemp></Obs></tempProfile>
 <densityProfile><Layer><depthTop{length}>10</depthTop><thickness{length}>4</thickness><density{density}>30</density>
 </Layer></densityProfile>
 <hardnessProfile><Layer><depthTop{length}>10</depthTop><hardness{force}>5</hardness></Layer></hardnessProfile>
 <hardnessProfile><MeasurementComponents{tuple}/><Measurements><tupleList>10,5 20,6</tupleList></Measurements>
 </hardnessProfile>
</SnowProfileMeasurements></snowProfileResultsOf></SnowProfile>"""
VERSION_5 = """<SnowProfile xmlns="http://caaml.org/Schemas/V5.0/Profiles/SnowProfileIACS" xmlns:gml="http://www.opengis.net/gml">
<metaDataProperty><MetaData><srcRef><Operation><contactPerson><Person><name>Kim</name></Person></contactPerson></Operation>
</srcRef></MetaData></metaDataProperty>
<validTime><TimeInstant><timePosition>2019-01-28T14:25:00</timePosition></TimeInstant></validTime>
<snowProfileResultsOf><SnowProfileMeasurements dir="top down"><comment>windy</comment>
 <airTempPres uom="degF">14</airTempPres>
 <hS><Components><snowHeight uom="in">60</snowHeight></Components></hS>
 <stratProfile><Layer><comment>Jan 17</comment><depthTop uom="cm">10</depthTop><hardness uom="N">4F</hardness></Layer>
 </stratProfile>
 <tempProfile uomDepth="m" uomTemp="K"><Obs><depth>0.2</depth><snowTemp>268.15</snowTemp></Obs></tempProfile>
 <densityProfile uomDepthTop="mm" uomThickness="in" uomDensity="gcm-3">
  <Layer><depthTop>100</depthTop><thickness>4</thickness><density>0.3</density></Layer></densityProfile>
 <hardnessProfile uomHardness="kN" uomDepthTop="cm"><MetaData><methodOfMeas>Ram Sonde</methodOfMeas></MetaData>
  <Layer><depthTop>10</depthTop><hardness>0.5</hardness></Layer></hardnessProfile>
</SnowProfileMeasurements></snowProfileResultsOf>
<locRef><ObsPoint><name>Study plot</name>
 <validElevation><ElevationPosition uom="ft"><position>1000</position></ElevationPosition></validElevation>
 <gml:Point srsName="urn:ogc:def:crs:OGC:1.3:CRS84"><gml:pos>-116.4784 51.709</gml:pos></gml:Point>
</ObsPoint></locRef></SnowProfile>"""
PLACES = ("elevation", "angle", "temperature", "length", "grain", "density", "force")


def in_units(folder: Path, version: str = "6.0.3", degrees: str = "-14", **units: str) -> Path:
    words = {place: f' uom="{units[place]}"' if place in units else "" for place in PLACES}
    words["tuple"] = "".join(
        f' {attribute}="{units[place]}"'
        for place, attribute in (("length", "uomDepth"), ("force", "uomHardness"))
        if place in units
    )
    path = folder / "pit.caaml"
    path.write_text(VERSION_6.format(version=version, degrees=degrees, **words), encoding="utf-8")
    return path


def lengths(pit: SnowPit) -> list[float | None]:
    layer, density, temperature = pit.layers[0], pit.densities[0], pit.temperatures[0]
    depths = [*pit.forces[0].depth.tolist(), *pit.forces[1].depth.tolist()]
    return [pit.snow_height, layer.top, layer.thickness, density.top, density.thickness, temperature.depth, *depths]


def refusal(path: Path) -> Problem:
    with pytest.raises(FieldDataError) as refused:
        read_caaml(path)
    (problem,) = refused.value.problems
    assert isinstance(problem, Problem)
    assert (problem.code, problem.file) == ("unreadable_file", path.name)
    return require_sentences([problem])[0]


@pytest.mark.parametrize("version", ["6.0", "6.0.3", "6.0.5", "6.0.6"])
def test_units_of_the_standard_are_the_default(tmp_path: Path, version: str) -> None:
    standard = {"elevation": "m", "angle": "deg", "temperature": "degC", "length": "cm", "grain": "mm",
                "density": "kgm-3", "force": "N"}  # fmt: skip
    for units in ({}, standard):
        pit = read_caaml(in_units(tmp_path, version, **units))
        assert (pit.elevation, pit.slope_angle_deg, pit.aspect) == (8200.0, 1.5, "1.5")
        assert (pit.latitude_deg, pit.longitude_deg) == (46.8, 9.8)
        assert (pit.air_temperature_C, pit.temperatures[0].temperature_C) == (-14.0, -14.0)
        assert lengths(pit) == pytest.approx([1.5, 0.1, 0.04, 0.1, 0.04, 0.2, 0.1, 0.1, 0.2])
        assert (pit.layers[0].grain_size, pit.densities[0].snow_density) == (2e-3, 30.0)
        assert [each.force.tolist() for each in pit.forces] == [[5.0], [5.0, 6.0]]


@pytest.mark.parametrize(
    ("stated", "place"),
    [("", (None, None)), ("46.8 9.8 1200", (46.8, 9.8)), ("-90 180", (-90.0, 180.0)), ("90 -180", (90.0, -180.0)),
     ("46.8", None), ("90.5 9.8", None), ("-90.5 9.8", None), ("46.8 180.5", None), ("46.8 -180.5", None)],
)  # fmt: skip
def test_places(tmp_path: Path, stated: str, place: tuple[float | None, float | None] | None) -> None:
    path = in_units(tmp_path)
    path.write_text(path.read_text(encoding="utf-8").replace("46.8 9.8", stated), encoding="utf-8")
    if place is None:
        assert refusal(path).column == "pos"
    else:
        pit = read_caaml(path)
        assert (pit.latitude_deg, pit.longitude_deg) == place


@pytest.mark.parametrize(
    ("old", "new", "allowed"),
    [
        ("30</density>", "0</density>", True),
        ("30</density>", "1000</density>", True),
        ("30</density>", "1000.5</density>", False),
        ("30</density>", "5</density>", True),
        ("30</density>", "4.9</density>", False),
        ("4</thickness>", "10000</thickness>", True),
        ("4</thickness>", "10001</thickness>", False),
        ("-14</snowTemp>", "5</snowTemp>", True),
        ("-14</snowTemp>", "5.5</snowTemp>", False),
        ("-14</snowTemp>", "-90</snowTemp>", True),
        ("-14</snowTemp>", "-90.5</snowTemp>", False),
        ("10</depthTop>", "-5</depthTop>", True),
        ("10</depthTop>", "-5.5</depthTop>", False),
        ("10,5 20,6", "10,5,6 20,6", False),
    ],
)
def test_limits(tmp_path: Path, old: str, new: str, allowed: bool) -> None:
    path = in_units(tmp_path)
    path.write_text(path.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")
    if allowed:
        assert len(read_caaml(path).layers) == 1
    else:
        assert refusal(path).code == "unreadable_file"


def test_values_of_plates_have_their_count_and_interval(tmp_path: Path) -> None:
    path = in_units(tmp_path)
    own = '<customData><s:{} xmlns:s="{}" uom="Nmm-3" n="{}" low="0.4" high="0.7">0.5</s:{}></customData><weatherCond>'
    text = path.read_text(encoding="utf-8")
    for namespace, expected in ((OWN_NAMESPACE, PlateValue(0.5, 12, (0.4, 0.7))), ("urn:other", None)):
        hardness = own.format("snowHardness", namespace, "12", "snowHardness")
        path.write_text(text.replace("<weatherCond>", hardness), encoding="utf-8")
        pit = read_caaml(path)
        assert (pit.snow_hardness, pit.failure_shear_stress) == (expected, None)
    bare = hardness.replace("urn:other", OWN_NAMESPACE).replace(' low="0.4"', "").replace(' n="12"', "")
    path.write_text(text.replace("<weatherCond>", bare), encoding="utf-8")
    assert read_caaml(path).snow_hardness == PlateValue(0.5, 0, None)


@pytest.mark.parametrize(
    ("unit", "metres"), [("ft", 2499.36), ("feet", 2499.36), ("km", 8.2e6), ("cm", 82.0), ("m", 8200.0)]
)
def test_elevations(tmp_path: Path, unit: str, metres: float) -> None:
    assert read_caaml(in_units(tmp_path, elevation=unit)).elevation == pytest.approx(metres)


@pytest.mark.parametrize(("unit", "degrees"), [("degF", "14"), ("F", "14"), ("°F", "14"), ("K", "263.15")])
def test_temperatures(tmp_path: Path, unit: str, degrees: str) -> None:
    pit = read_caaml(in_units(tmp_path, temperature=unit, degrees=degrees))
    assert pit.air_temperature_C == pytest.approx(-10.0)
    assert pit.temperatures[0].temperature_C == pytest.approx(-10.0)


@pytest.mark.parametrize(("unit", "factor"), [("mm", 0.1), ("m", 100.0), ("in", 2.54), ("ft", 30.48), (" cm ", 1.0)])
def test_lengths(tmp_path: Path, unit: str, factor: float) -> None:
    standard = lengths(read_caaml(in_units(tmp_path)))
    expected = [factor * each for each in standard if each is not None]
    assert lengths(read_caaml(in_units(tmp_path, length=unit))) == pytest.approx(expected)
    grain = read_caaml(in_units(tmp_path, grain=unit)).layers[0].grain_size
    assert grain == pytest.approx(factor * 0.02)


@pytest.mark.parametrize("unit", ["gcm-3", "g cm-3", "g/cm3", "g/cm³", "g cm^-3"])
def test_densities(tmp_path: Path, unit: str) -> None:
    path = in_units(tmp_path, density=unit)
    path.write_text(path.read_text(encoding="utf-8").replace(">30</density>", ">0.3</density>"), encoding="utf-8")
    assert read_caaml(path).densities[0].snow_density == pytest.approx(300.0)


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("density", "30</density>", "-30</density>"),
        ("density", "30</density>", "1200</density>"),
        ("thickness", "4</thickness>", "-4</thickness>"),
        ("depthTop", "10</depthTop>", "-10</depthTop>"),
        ("depth", "20</depth>", "20000</depth>"),
        ("depthTop", "10</depthTop>", "170</depthTop>"),
        ("thickness", "4</thickness>", "20</thickness>"),
    ],
)
def test_values_that_no_snow_has_are_rejected(tmp_path: Path, name: str, old: str, new: str) -> None:
    """With heights from the ground a layer is between the ground and the surface."""
    path = in_units(tmp_path)
    text = path.read_text(encoding="utf-8").replace(f">{old}", f">{new}", 1)
    path.write_text(text, encoding="utf-8")
    if new[0] in "12":
        path.write_text(text.replace("top down", "bottom up"), encoding="utf-8")
    assert refusal(path).column == name


@pytest.mark.parametrize("degrees", ["14", "265", "-100"])
def test_temperatures_that_no_snow_has_are_rejected(tmp_path: Path, degrees: str) -> None:
    assert refusal(in_units(tmp_path, degrees=degrees)).column == "snowTemp"


def test_densities_of_another_unit_than_stated_are_rejected(tmp_path: Path) -> None:
    path = in_units(tmp_path, density="kgm-3")
    path.write_text(path.read_text(encoding="utf-8").replace(">30</density>", ">0.3</density>"), encoding="utf-8")
    with pytest.raises(FieldDataError, match=r"density.*0\.3 kg/m³"):
        read_caaml(path)


def test_forces_and_angles(tmp_path: Path) -> None:
    pit = read_caaml(in_units(tmp_path, force="kN", angle="rad"))
    assert [each.force.tolist() for each in pit.forces] == [[5e3], [5e3, 6e3]]
    assert pit.slope_angle_deg == pytest.approx(85.9436692696)
    assert float(pit.aspect) == pytest.approx(85.9436692696)


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("unit", ["furlong", "", "lbft-3", "CM"])
def test_an_unknown_unit_is_an_error(tmp_path: Path, place: str, unit: str) -> None:
    problem = refusal(in_units(tmp_path, **{place: unit}))
    assert (problem.code, problem.file, problem.value) == ("unreadable_file", "pit.caaml", unit)


@pytest.mark.parametrize("number", ["1e101", "-1e308", "1e309", "nan"])
def test_impossible_numbers_are_rejected(tmp_path: Path, number: str) -> None:
    path = in_units(tmp_path)
    path.write_text(path.read_text(encoding="utf-8").replace(">8200<", f">{number}<"), encoding="utf-8")
    assert refusal(path).column == "position"


def test_version_5_has_units_at_the_profile(tmp_path: Path) -> None:
    path = tmp_path / "pit.xml"
    path.write_text(VERSION_5, encoding="utf-8")
    pit = read_caaml(path)
    assert (pit.name, pit.observer, pit.time, pit.comment) == ("Study plot", "Kim", "2019-01-28T14:25:00", "windy")
    assert [pit.latitude_deg, pit.longitude_deg, pit.elevation] == pytest.approx([51.709, -116.4784, 304.8])
    assert [pit.snow_height, pit.air_temperature_C] == pytest.approx([1.524, -10.0])
    assert (pit.layers[0].top, pit.layers[0].hardness, pit.layers[0].comment) == (0.1, "4F", "Jan 17")
    (density,), (temperature,), (force,) = pit.densities, pit.temperatures, pit.forces
    assert [density.top, density.thickness, density.snow_density] == pytest.approx([0.1, 0.1016, 300.0])
    assert [temperature.depth, temperature.temperature_C] == pytest.approx([0.2, -5.0])
    assert (force.method, force.depth.tolist(), force.force.tolist()) == ("Ram Sonde", [0.1], [500.0])
    path.write_text(VERSION_5.replace("gcm-3", "lbft-3"), encoding="utf-8")
    assert (refusal(path).column, refusal(path).value) == ("density", "lbft-3")


@pytest.mark.parametrize("encoding", ["UTF-9", "gb2312", "utf-7", "rot13", "punycode", "x" * 5000])
def test_an_encoding_that_cannot_be_read_is_an_error_of_the_first_line(tmp_path: Path, encoding: str) -> None:
    path = in_units(tmp_path)
    path.write_text(path.read_text(encoding="utf-8").replace("UTF-8", encoding).replace("<name>x", "<name>ä"), "utf-8")
    problem = refusal(path)
    assert problem.row == 1
    assert len(str(problem)) < 500


@pytest.mark.skipif(not CASES.is_dir(), reason="no ../shared")
def test_shared_cases() -> None:
    assert read_caaml(CASES / "elev_ft.caaml").elevation == pytest.approx(2499.36)
    assert read_caaml(CASES / "v603_tempF.caaml").temperatures[0].temperature_C == pytest.approx(-5.0)
    assert read_caaml(CASES / "density_gcm3.caaml").densities[0].snow_density == pytest.approx(300.0)
    assert refusal(CASES / "encoding-utf-9.caaml").row == 1


def test_words_for_missing_values_and_aspects(tmp_path: Path) -> None:
    path = in_units(tmp_path)
    text = path.read_text(encoding="utf-8")
    for stated, aspect in (("NE", "NE"), ("n/a", ""), ("Unknown", ""), ("1.2.3", "1.2.3"), ("225.50", "225.5")):
        path.write_text(text.replace(">1.5</position></AspectPosition>", f">{stated}</position></AspectPosition>"))
        assert read_caaml(path).aspect == aspect
    for stated, size in (("fine", None), ("missing", None), ("1", 1e-3)):
        path.write_text(text.replace("<avg>2</avg>", f"<avg>{stated}</avg>"))
        assert read_caaml(path).layers[0].grain_size == size
    path.write_text(text.replace("<thickness>4</thickness>", ""))
    assert (read_caaml(path).layers[0].thickness, read_caaml(path).densities[0].thickness) == (None, None)
    path.write_text(text.replace("SnowProfileMeasurements", "Other"))
    assert refusal(path).column == "snowProfileResultsOf"


@pytest.mark.parametrize(
    ("old", "new", "allowed"),
    [
        ("10</depthTop>", "155</depthTop>", True),
        ("10</depthTop>", "155.5</depthTop>", False),
        ("4</thickness>", "15</thickness>", True),
        ("4</thickness>", "15.5</thickness>", False),
        ("20</depth>", "-5</depth>", True),
        ("20</depth>", "-5.5</depth>", False),
    ],
)
def test_limits_of_heights(tmp_path: Path, old: str, new: str, allowed: bool) -> None:
    """With a snow height of 150 cm a layer may end 5 cm above the surface or below the ground."""
    path = in_units(tmp_path)
    text = path.read_text(encoding="utf-8").replace("top down", "bottom up")
    path.write_text(text.replace(old, new), encoding="utf-8")
    assert (len(read_caaml(path).layers) == 1) if allowed else refusal(path).code == "unreadable_file"
