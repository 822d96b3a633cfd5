"""ESRI ASCII grids and GeoTIFF: places, heights in m, and each rule that rejects a grid."""

import math
import struct
import sys
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow._support.messages import Message
from skisnow.scenario import read_snow_map, read_terrain
from skisnow.scenario.map_system import MapSystem, _scale, length_unit, map_system
from skisnow.scenario.raster import FINEST, PlacedValues, Raster, placed_heights, require_metres, require_places
from skisnow.scenario.raster_formats import _height_unit, _heights, _require_north_up, _require_one_band
from tests.coded import Coded, coded, raises

CASES = Path(__file__).parents[3] / "shared" / "cases" / "terrain"
PLANE = 2500.0 - math.tan(math.radians(12.0)) * (1.0 + 2.0 * np.arange(40.0)) + np.zeros((40, 1))
"""A slope of 12° that falls east, cells of 2 m: the terrain of the cases."""
HEADER = {
    "ncols": "3", "nrows": "2", "xllcorner": "100.0", "yllcorner": "50.0", "cellsize": "2.0", "NODATA_value": "-9999",
}  # fmt: skip
VALUES = "5 6 7\n1 2 3\n"
US_FOOT = 1200.0 / 3937.0


def header(**changes: str | None) -> str:
    entries = HEADER | changes
    return "".join(f"{word} {value}\n" for word, value in entries.items() if value is not None)


def written(folder: Path, text: str, name: str = "heights.asc") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def slope_deg(path: Path) -> float:
    along_x, along_y = read_terrain(path).surface.gradients(40.0, 0.0)
    return math.degrees(math.atan(math.hypot(float(along_x), float(along_y))))


def test_places_are_the_middles_of_cells_and_rows_begin_in_the_north(tmp_path: Path) -> None:
    terrain = read_terrain(written(tmp_path, header() + VALUES))
    assert terrain.x.tolist() == [101.0, 103.0, 105.0]
    assert terrain.y.tolist() == [51.0, 53.0]
    assert terrain.height.tolist() == [[1.0, 5.0], [2.0, 6.0], [3.0, 7.0]]  # north is y = 53
    middles = header(xllcorner=None, yllcorner=None, XLLCENTER="101", yllcenter="51")
    again = read_terrain(written(tmp_path, middles + VALUES, "other.asc"))
    assert (again.x.tolist(), again.y.tolist()) == (terrain.x.tolist(), terrain.y.tolist())


@pytest.mark.parametrize(
    "text",
    [
        header() + "5 6 7 1 2 3",
        header() + "5\n6\n7\n1\n2\n3\n",
        header() + "5 6\n7 1\n\n2 3\n",
        header().replace("\n", " ") + VALUES,
        header(cellsize=None, dx="2.0", dy="2.0") + VALUES,
        header(xllcenter="101") + VALUES,
        header(cellsize=None, DX="2", DY="2", NODATA_value=None, nodata="-1") + VALUES,
        header().replace("\n", "\r\n") + VALUES.replace("\n", "\r"),
    ],
)
def test_values_count_and_not_lines(tmp_path: Path, text: str) -> None:
    terrain = read_terrain(written(tmp_path, text))
    assert (terrain.x.tolist(), terrain.y.tolist()) == ([101.0, 103.0, 105.0], [51.0, 53.0])
    assert read_terrain(written(tmp_path, text, "heights.txt")).height.tolist() == terrain.height.tolist()
    assert terrain.height.tolist() == [[1.0, 5.0], [2.0, 6.0], [3.0, 7.0]]


def test_cells_need_not_be_square(tmp_path: Path) -> None:
    terrain = read_terrain(written(tmp_path, header(cellsize=None, dx="2", dy="3") + VALUES))
    assert (terrain.x.tolist(), terrain.y.tolist()) == ([101.0, 103.0, 105.0], [51.5, 54.5])
    assert [float(each) for each in terrain.surface.gradients(103.0, 53.0)] == pytest.approx([0.5, 4.0 / 3.0])


@pytest.mark.parametrize(
    ("text", "place"),
    [
        (header() + "5 six 7\n1 2 3\n", coded("not_a_number", line=7, column=2, word="six")),
        (header() + "5 6 nan\n1 2 3\n", coded("out_of_range", where="line 7, column 3")),
        (header() + "5 -9999 7\n1 2 3\n", coded("out_of_range", where="line 7, column 2")),
        (header(NODATA_value="0") + "5 6 7 1\n2 0", coded("out_of_range", where="line 8, column 2")),
        (header(NODATA_value=None) + "5 -9999 7\n1 2 3\n", coded("out_of_range", where="line 6, column 2", size=6)),
        (header(NODATA_value=None) + "5 6 7\n1 -32768 3\n", coded("out_of_range", where="line 7, column 2")),
        (header(NODATA_value=None) + "5 6 7\n1 2 -3.4028235e38\n", coded("out_of_range", where="line 7, column 3")),
        (
            header(NODATA_value=None) + "1e308 6 7\n1 2 3\n",
            coded("out_of_range", where="line 6, column 1", count=1, size=6),
        ),
        (header() + "5 6 7\n1 2\n", "invalid"),
        (header() + "5 6 7\n1 2 3 4\n", "invalid"),
        (header() + "5 6 7\n", "invalid"),
        (header(ncols="3.5") + VALUES, coded("out_of_range", name="ncols", count=3.5)),
        (header(ncols="1e309") + VALUES, coded("out_of_range", name="ncols")),
        (header(nrows="nan") + VALUES, coded("out_of_range", name="nrows")),
        (header(nrows="-2") + VALUES, coded("out_of_range", name="nrows", count=-2.0)),
        (header(nrows="1") + VALUES, coded("out_of_range", name="nrows", count=1.0)),
        (header(nrows="two") + VALUES, coded("out_of_range", line=2, key="nrows", value="two")),
        (header(nrows=None) + VALUES, "invalid"),
        (header(cellsize=None) + VALUES, "invalid"),
        (header(cellsize=None, dx="2") + VALUES, "invalid"),
        (header(dx="3", dy="3") + VALUES, "repeated"),
        (header(cellsize="0") + VALUES, "invalid"),
        ("cellsize 3\n" + header() + VALUES, coded("repeated", key="cellsize")),
        (header(xllcenter="999") + VALUES, "invalid"),
        (header(cellsize="inf") + VALUES, "invalid"),
        (header(cellsize="1e300") + VALUES, coded("out_of_range", size=1e300)),
        (header(xllcorner=None) + VALUES, "invalid"),
        (header(yllcorner="inf") + VALUES, "invalid"),
        (header(xllcorner="1e200") + VALUES, coded("out_of_range", axis="x", first=1e200, last=1e200)),
        (header(yllcorner="1e200") + VALUES, coded("out_of_range", axis="y", first=1e200, last=1e200)),
        (header(ncols="99999", nrows="99999") + VALUES, coded("out_of_range", n_columns=99999.0, n_rows=99999.0)),
        (header(ncols="7000", nrows="7000") + VALUES, "invalid"),
        (header(cellsize="0.0000277778", xllcorner="11", yllcorner="47") + VALUES, "in_degrees"),
        (
            header(cellsize="0.008333", xllcorner="-117.5", yllcorner="-33") + VALUES,
            coded("in_degrees", target="EPSG:32711"),
        ),
        ("", "invalid"),
        ("DSAA\n3 2\n", "invalid"),
    ],
)
def test_an_esri_grid_is_rejected_with_the_place_of_the_fault(tmp_path: Path, text: str, place: str | Coded) -> None:
    path = written(tmp_path, text)
    with raises(ParameterError, place) as error:
        read_terrain(path)
    assert str(error.value).startswith(str(path))
    english, german = str(error.value).replace(str(path), ""), error.value.text("de").replace(str(path), "")
    assert not {"the", "is", "has", "of", "line"} & {*german.split()}
    assert german != english


@pytest.mark.parametrize("size", ["0.0125", "0.05"])
@pytest.mark.parametrize("smoothing", [0.0, 10.0])
def test_coarse_degrees_are_rejected_also_with_smoothing(tmp_path: Path, size: str, smoothing: float) -> None:
    """Smoothing over metres makes such a grid flat; one wrong height among metres is a cliff."""
    text = header(ncols="3", nrows="3", cellsize=size, xllcorner="11", yllcorner="47") + "2400 2410 2430\n" * 2
    with raises(ParameterError, coded("in_degrees", target="EPSG:32632")):
        read_terrain(written(tmp_path, text + "2390 2400 2420"), smoothing=smoothing)
    with raises(ParameterError, "out_of_range"):
        read_terrain(written(tmp_path, text.replace("10 2430", "00 2400", 2) + "2400 2400 2460"))


UTM = (
    'PROJCS["WGS_1984_UTM_Zone_32N",GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],'
    'PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],'
    'PARAMETER["False_Easting",500000.0],PARAMETER["False_Northing",0.0],PARAMETER["Central_Meridian",9.0],'
    'PARAMETER["Scale_Factor",0.9996],PARAMETER["Latitude_Of_Origin",0.0],UNIT["Meter",1.0]]'
)
FEET = UTM.replace('UNIT["Meter",1.0]', 'UNIT["Foot_US",0.3048006096012192]')
HEIGHT_FEET = f'{UTM},VERTCS["NAVD88_height_(ftUS)",VDATUM["NAVD88"],UNIT["Foot_US",0.3048006096012192]]'
DEGREES = UTM[UTM.index("GEOGCS") : UTM.index(",PROJECTION")]
MERCATOR = UTM.replace("Transverse_Mercator", "Mercator_Auxiliary_Sphere").replace("UTM_Zone_32N", "Web_Mercator")


@pytest.mark.parametrize(
    ("text", "in_degrees", "unit", "height_unit"),
    [
        (UTM, False, 1.0, None),
        (FEET, False, US_FOOT, None),
        (HEIGHT_FEET, False, 1.0, US_FOOT),
        (f'COMPD_CS["both",{FEET},VERT_CS["h",UNIT["foot",0.3048]]]', False, US_FOOT, 0.3048),
        (DEGREES, True, 1.0, None),
        ('GEOGCRS["WGS 84",CS[ellipsoidal,2],UNIT["degree",0.017]]', True, 1.0, None),
        ('LOCAL_CS["pit",UNIT["metre",1]]', False, 1.0, None),
        ("Projection GEOGRAPHIC\nDatum NAD83\nUnits DD\n", True, 1.0, None),
        ("Projection UTM\nZone 12\nZunits FEET\nUnits METERS\n", False, 1.0, 0.3048),
    ],
)
def test_units_of_a_map_system(text: str, in_degrees: bool, unit: float, height_unit: float | None) -> None:
    system = map_system(text)
    assert system.in_degrees is in_degrees
    assert system.unit == pytest.approx(unit)
    assert system.height_unit == (height_unit and pytest.approx(height_unit))
    assert not system.downwards


def test_the_prj_file_gives_the_units_of_an_esri_grid(tmp_path: Path) -> None:
    path = written(tmp_path, header(xllcorner="500000", yllcorner="5200000", cellsize="20") + VALUES)
    written(tmp_path, FEET, "heights.PRJ")
    with pytest.raises(ParameterError, match="unit of the heights is missing"):
        read_terrain(path)
    (tmp_path / "heights.PRJ").unlink()
    written(tmp_path, "Projection STATEPLANE\nUnits FEET\nZunits METERS\n", "heights.prj")
    assert read_terrain(path).x == pytest.approx(np.array([500010.0, 500030.0, 500050.0]) * 0.3048)
    assert read_terrain(path).height[2].tolist() == [3.0, 7.0]
    written(tmp_path, HEIGHT_FEET, "heights.prj")
    assert read_terrain(path).height[2].tolist() == pytest.approx([3.0 * US_FOOT, 7.0 * US_FOOT])
    for text, fault in ((DEGREES, "degrees"), (MERCATOR, "stretches lengths")):
        written(tmp_path, text, "heights.prj")
        with pytest.raises(ParameterError, match=fault):
            read_terrain(path)


@pytest.mark.parametrize(("south", "target"), [("89.5", "EPSG:32647"), ("90.5", "EPSG:32632"), ("-91", "EPSG:32632")])
def test_degrees_beyond_a_pole_have_a_zone_of_the_middle_of_the_map(tmp_path: Path, south: str, target: str) -> None:
    path = written(tmp_path, header(cellsize="1e-5", xllcorner="100", yllcorner=south) + VALUES)
    written(tmp_path, DEGREES, "heights.prj")
    with raises(ParameterError, coded("in_degrees", target=target)):
        read_terrain(path)


@pytest.mark.parametrize("east", [1.0, -1.0])
@pytest.mark.parametrize("north", [1.0, -1.0])
def test_rows_and_columns_run_in_either_direction(east: float, north: float) -> None:
    """An eighth of x plus half of y, from whichever corner the file begins."""
    x, y = 101.0 + 2.0 * np.arange(3)[:: int(east)], 51.0 + 2.0 * np.arange(2)[:: int(north)]
    raster = Raster(
        path="heights", values=0.125 * x[None, :] + 0.5 * y[:, None], first=(x[0], y[0]),
        step=(2.0 * east, 2.0 * north), height_unit=10.0, system=None, where=lambda *cell: Message("{cell}", cell=cell),
    )  # fmt: skip
    found = placed_heights(raster, column="z_m")
    assert (found.x.tolist(), found.y.tolist()) == ([101.0, 103.0, 105.0], [51.0, 53.0])
    assert found.columns["z_m"].tolist() == [[1.25 * a + 5.0 * b for b in (51.0, 53.0)] for a in (101.0, 103.0, 105.0)]


def test_geotiff_without_its_package_names_the_extra(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "rasterio", None)
    with raises(ParameterError, "package_missing", extra="geotiff"):
        read_terrain(written(tmp_path, "", "heights.tif"))


def test_bands_heights_and_position_of_a_geotiff_without_its_package() -> None:
    def source(*colours: str) -> SimpleNamespace:
        return SimpleNamespace(colorinterp=[SimpleNamespace(name=name) for name in colours])

    for good in (("gray",), ("gray", "alpha"), ("undefined",)):
        _require_one_band("a.tif", source(*good))
    for bad in ((), ("palette",), ("alpha",), ("alpha", "gray"), ("red", "green", "blue")):
        with raises(ParameterError, coded("out_of_range", n_colours=len(bad), colours=list(bad))):
            _require_one_band("a.tif", source(*bad))
    band = np.ma.masked_array(np.array([[1, 2], [3, 4]], dtype=np.int16), mask=[[False, False], [False, True]])
    file = SimpleNamespace(read=lambda number, masked: band if (number, masked) == (1, True) else None)
    heights = _heights(SimpleNamespace(read=file.read, scales=(2.0, 9.0), offsets=(3.0, 9.0)))
    np.testing.assert_array_equal(heights, [[5.0, 7.0], [9.0, np.nan]])

    none = {"a": 1.0, "b": 0.0, "c": 0.0, "d": 0.0, "e": 1.0, "f": 0.0}
    with raises(ParameterError, "missing"):
        _require_north_up("a.tif", SimpleNamespace(**none), None)
    _require_north_up("a.tif", SimpleNamespace(**none), cast("MapSystem", object()))
    for key in "acef":
        _require_north_up("a.tif", SimpleNamespace(**none | {key: 2.0}), None)
    for key in "bd":
        with raises(ParameterError, "wrong_kind"):
            _require_north_up("a.tif", SimpleNamespace(**none | {key: 0.1}), None)


def test_size_and_damage_of_a_geotiff_without_its_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class DamagedError(Exception):
        pass

    def damaged(_: Path) -> None:
        raise DamagedError

    library = SimpleNamespace(open=lambda _: nullcontext(SimpleNamespace(width=1, height=5)))
    errors = SimpleNamespace(CPLE_BaseError=DamagedError, CRSError=DamagedError, RasterioError=DamagedError)
    for name, module in (("rasterio", library), ("rasterio._err", errors), ("rasterio.errors", errors)):
        monkeypatch.setitem(sys.modules, name, cast("Any", module))
    path = written(tmp_path, "", "heights.tif")
    with raises(ParameterError, "out_of_range", name="ncols", count=1):
        read_terrain(path)
    library.open = damaged
    with raises(ParameterError, "cannot_read"):
        read_terrain(path)


def test_unit_of_heights_is_that_of_the_band_or_of_the_vertical_system() -> None:
    metres = MapSystem("", in_degrees=False, unit=1.0, height_unit=None, downwards=False)
    feet, degrees = replace(metres, unit=0.3048), replace(metres, in_degrees=True, unit=0.0175)
    for name, system, unit in (
        (None, None, 1.0), ("ft", None, 0.3048), ("ft", metres, 0.3048), ("m", feet, 1.0), (" ", degrees, 1.0),
        (None, replace(feet, height_unit=0.3), 0.3), ("m", replace(metres, height_unit=1.00005), 1.0),
    ):  # fmt: skip
        assert _height_unit("a.tif", name, system) == unit
    for vertical in (0.999, 1.001):
        with raises(ParameterError, "contradiction", name="m", vertical=vertical):
            _height_unit("a.tif", "m", replace(metres, height_unit=vertical))
    with raises(ParameterError, "out_of_range", name="furlong"):
        _height_unit("a.tif", "furlong", None)
    with raises(ParameterError, "missing", unit=0.3048):
        _height_unit("a.tif", "", feet)


@pytest.mark.parametrize(
    ("last", "code"),
    [
        ((360.0, 90.0), "in_degrees"),
        ((-360.0, -90.0), "in_degrees"),
        ((360.5, 90.0), "out_of_range"),
        ((-360.5, 90.0), "out_of_range"),
        ((360.0, 90.5), "out_of_range"),
        ((360.0, -90.5), "out_of_range"),
    ],
)
def test_places_up_to_360_and_90_may_be_degrees(last: tuple[float, float], code: str) -> None:
    steps = [-math.copysign(FINEST / 2.0, end) for end in last]
    with raises(ParameterError, code):
        require_places("a.asc", last, (steps[0], steps[1]), (2, 2))
    x, y = (np.sort([end, end - math.copysign(0.5, end)]) for end in last)
    places = PlacedValues(x, y, {"z_m": np.array([[0.0, 100.0], [100.0, 200.0]])})
    if code == "in_degrees":
        with raises(ParameterError, code):
            require_metres("a.asc", places, "z_m", steepest=2.0)
        require_metres("a.asc", places, "z_m", steepest=201.0)
        require_metres("a.asc", replace(places, x=np.array([0.0, 1.0])), "z_m", steepest=2.0)
    else:
        require_metres("a.asc", places, "z_m", steepest=2.0)


@pytest.fixture(name="rasterio")
def _rasterio() -> Any:
    return pytest.importorskip("rasterio", reason="the extra geotiff is not installed")


@pytest.fixture(name="tif")
def _tif(rasterio: Any, tmp_path: Path) -> Any:
    """Writes a GeoTIFF of heights in the given system and unit."""

    def write(
        heights: Any, *, crs: str | None = "EPSG:32632", corner: tuple[float, float] = (500000.0, 5200000.0),
        cell: float = 2.0, unit: str | None = None, scale: float = 1.0, offset: float = 0.0, dtype: str = "float64",
        nodata: float | None = None, turned: float = 0.0,
    ) -> Path:  # fmt: skip
        path, values = tmp_path / "heights.tif", np.asarray(heights)
        form: dict[str, Any] = {"driver": "GTiff", "count": 1, "dtype": dtype, "nodata": nodata}
        transform = rasterio.Affine(cell, turned, corner[0], turned, -cell, corner[1])
        n_rows, n_columns = values.shape
        with rasterio.open(path, "w", crs=crs, transform=transform, width=n_columns, height=n_rows, **form) as file:
            file.write(values.astype(dtype), 1)
            file.scales, file.offsets = (scale,), (offset,)
            if unit is not None:
                file.units = (unit,)
        return path

    return write


def test_geotiff_lies_as_on_its_map(tif: Any) -> None:
    terrain = read_terrain(tif([[5.0, 6.0, 7.0], [1.0, 2.0, 3.0]], corner=(500100.0, 5200054.0)))
    assert (terrain.x.tolist(), terrain.y.tolist()) == ([500101.0, 500103.0, 500105.0], [5200051.0, 5200053.0])
    assert terrain.height.tolist() == [[1.0, 5.0], [2.0, 6.0], [3.0, 7.0]]


@pytest.mark.parametrize(
    ("changes", "unit"),
    [
        ({}, 1.0),
        ({"unit": "m"}, 1.0),
        ({"unit": "ft"}, 0.3048),
        ({"unit": "US survey foot"}, US_FOOT),
        ({"unit": "us-ft"}, US_FOOT),
        ({"unit": "dm"}, 0.1),
        ({"unit": "cm"}, 0.01),
        ({"crs": "EPSG:32632+5703"}, 1.0),
        ({"crs": "EPSG:32632+6360"}, US_FOOT),
        ({"crs": "EPSG:32632+8228"}, 0.3048),
        ({"crs": "EPSG:32632+6360", "unit": "US survey foot"}, US_FOOT),
    ],
)
def test_heights_of_a_geotiff_are_metres_whatever_their_unit(tif: Any, changes: dict[str, Any], unit: float) -> None:
    path = tif(PLANE / unit, **changes)
    terrain = read_terrain(path)
    assert terrain.height == pytest.approx(PLANE.T, rel=1e-12)


@pytest.mark.parametrize(("scale", "offset", "unit"), [(0.1, 2400.0, "m"), (1.0, 2000.0, "m"), (0.25, 8000.0, "ft")])
def test_scale_and_offset_of_a_geotiff_count(tif: Any, scale: float, offset: float, unit: str) -> None:
    size = {"m": 1.0, "ft": 0.3048}[unit]
    stored = np.rint((PLANE / size - offset) / scale)
    terrain = read_terrain(tif(stored, scale=scale, offset=offset, unit=unit, dtype="uint16"))
    assert terrain.height == pytest.approx(PLANE.T, abs=scale * size / 2.0 + 1e-9)


def test_nodata_is_a_stored_number_before_scale_and_offset(tif: Any) -> None:
    stored = np.full((3, 3), 960)
    stored[1, 2] = 0
    with pytest.raises(ParameterError, match="row 2, column 3"):
        read_terrain(tif(stored, scale=0.1, offset=2400.0, dtype="uint16", nodata=0))


def test_places_in_feet_become_metres(tif: Any) -> None:
    terrain = read_terrain(tif(PLANE / US_FOOT, crs="EPSG:2231", corner=(3e6, 1.4e6), unit="us-ft"))
    assert terrain.x[:2] == pytest.approx(np.array([3000001.0, 3000003.0]) * US_FOOT)
    along_x, _ = terrain.surface.gradients(terrain.x[20], terrain.y[20])
    assert float(along_x) == pytest.approx(-math.tan(math.radians(12.0)) / US_FOOT)


@pytest.mark.parametrize(
    ("changes", "fault"),
    [
        ({"crs": "EPSG:4326", "corner": (11.0, 47.0), "cell": 2.8e-5}, "degrees.*EPSG:32632"),
        ({"crs": None, "corner": (11.0, 47.0), "cell": 2.8e-5}, "degrees"),
        ({"crs": "EPSG:4326+5773", "corner": (11.0, 47.0), "cell": 2.8e-5}, "degrees"),
        ({"crs": "EPSG:3857", "corner": (1224514.0, 5942074.0)}, r"factor of 1\.46.*EPSG:32632"),
        ({"crs": "EPSG:3395", "corner": (1224514.0, 5911060.0)}, r"factor of 1\.46"),
        ({"crs": "EPSG:3031", "corner": (0.0, 3e6)}, "stretches lengths"),
        ({"crs": "EPSG:5070", "corner": (-856000.0, 1850000.0)}, "stretches lengths"),
        ({"crs": "EPSG:32632+5715"}, "downwards"),
        ({"crs": "EPSG:32632+6360", "unit": "m"}, "vertical system"),
        ({"unit": "fathom"}, "fathom"),
        ({"turned": 0.5}, "not run east"),
        ({"nodata": PLANE[0, 0]}, "row 1, column 1"),
        ({"scale": math.inf}, "row 1, column 1"),
        ({"scale": 1e300}, "row 1, column 1"),
    ],
)
def test_a_geotiff_that_would_be_misread_is_rejected(tif: Any, changes: dict[str, Any], fault: str) -> None:
    path = tif(PLANE, **changes)
    with pytest.raises(ParameterError, match=fault) as error:
        read_terrain(path)
    assert str(error.value).startswith(str(path))


@pytest.mark.parametrize(
    ("count", "form", "readable"),
    [
        (3, {"photometric": "RGB"}, False),
        (2, {"photometric": "MINISBLACK", "alpha": "NO"}, False),
        (2, {"photometric": "MINISBLACK", "alpha": "YES"}, True),
        (1, {"photometric": "PALETTE"}, False),
    ],
)
def test_the_band_of_heights(
    rasterio: Any, tmp_path: Path, count: int, form: dict[str, Any], *, readable: bool
) -> None:
    path, transform = tmp_path / "heights.tif", rasterio.Affine(2.0, 0.0, 500000.0, 0.0, -2.0, 5200000.0)
    size = {"width": 4, "height": 3, "count": count, "dtype": "uint8", "crs": "EPSG:32632", "transform": transform}
    with rasterio.open(path, "w", driver="GTiff", **size, **form) as file:
        file.write(np.full((count, 3, 4), 255, "uint8"))
        if form["photometric"] == "PALETTE":
            file.write_colormap(1, {255: (255, 0, 0, 255)})
    if readable:
        assert np.all(read_terrain(path).height == 255.0)
    else:
        with pytest.raises(ParameterError, match="bands"):
            read_terrain(path)


@pytest.mark.parametrize("code", [2056, 31287, 3035, 2154, 27700, 3006])
def test_maps_with_true_lengths_are_read(rasterio: Any, tif: Any, code: int) -> None:  # noqa: ARG001 - it skips
    from rasterio.warp import transform

    place = {27700: (-4.0, 57.0), 3006: (14.0, 66.0)}.get(code, (9.0, 46.8))
    x, y = transform("EPSG:4326", f"EPSG:{code}", *([each] for each in place))
    assert len(read_terrain(tif(PLANE, crs=f"EPSG:{code}", corner=(x[0], y[0]))).x) == 40


def test_a_picture_without_a_place_and_other_bytes_are_rejected(rasterio: Any, tmp_path: Path) -> None:
    path = tmp_path / "heights.tif"
    path.write_bytes(b"no picture")
    with pytest.raises(ParameterError, match="GeoTIFF"):
        read_terrain(path)
    form: dict[str, Any] = {"driver": "GTiff", "width": 3, "height": 3, "count": 1, "dtype": "uint8"}
    with pytest.warns(rasterio.errors.NotGeoreferencedWarning), rasterio.open(path, "w", **form) as file:
        file.write(np.ones((3, 3), "uint8"), 1)
    with raises(ParameterError, "missing"):
        read_terrain(path)


def test_a_damaged_map_system_is_rejected(rasterio: Any, tmp_path: Path) -> None:
    path, place = tmp_path / "heights.tif", rasterio.Affine(2.0, 0.0, 100.0, 0.0, -2.0, 54.0)
    form: dict[str, Any] = {"width": 5, "height": 4, "count": 1, "dtype": "float32", "nodata": -9999.0}
    with rasterio.open(
        path, "w", driver="GTiff", crs="EPSG:32632", transform=place, compress="deflate", **form
    ) as file:
        file.write(np.zeros((4, 5), "float32"), 1)
    data = bytearray(path.read_bytes())
    size, key = data.index(struct.pack("<HHI", 33550, 12, 3)), data.index(struct.pack("<4H", 3072, 0, 1, 32632))
    data[size + 5] = 4  # a cell of 1,027 sizes
    data[key:key] = b"##"  # an unknown key of the map system: GDAL's own error, none of rasterio
    path.write_bytes(data)
    with raises(ParameterError, "cannot_read") as caught:
        read_terrain(path)
    assert not isinstance(caught.value.__cause__, rasterio.errors.RasterioError)


def test_a_text_that_is_no_map_system_has_no_scale(rasterio: Any) -> None:  # noqa: ARG001 - it skips
    assert (
        _scale(
            MapSystem(text='PROJCS["x", ', in_degrees=False, unit=1.0, height_unit=None, downwards=False),
            500000.0,
            5200000.0,
        )
        is None
    )


@pytest.mark.parametrize(("name", "unit"), [("Meters", 1.0), ("US_survey-foot", US_FOOT), ("fathom", None)])
def test_names_of_units(name: str, unit: float | None) -> None:
    assert length_unit(name) == unit


@pytest.mark.skipif(not CASES.is_dir(), reason="no ../shared")
@pytest.mark.parametrize("name", ["ok.tif", "scaled_dm.tif", "dxdy.asc", "onerow.asc", "wrap.asc"])
def test_shared_grids_are_the_same_slope(name: str) -> None:
    if name.endswith(".tif"):
        pytest.importorskip("rasterio", reason="the extra geotiff is not installed")
    terrain = read_terrain(CASES / name)
    assert terrain.height.mean() == pytest.approx(2491.5, abs=0.1)
    assert terrain.height[9].mean() == pytest.approx(2496.0, abs=0.1)
    assert slope_deg(CASES / name) == pytest.approx(12.0, abs=0.7)  # heights in whole decimetres, at one place
    assert (terrain.x[0], terrain.x[-1], terrain.y[0], terrain.y[-1]) == (1.0, 79.0, -39.0, 39.0)


@pytest.mark.skipif(not CASES.is_dir(), reason="no ../shared")
@pytest.mark.parametrize(
    ("name", "fault"),
    [
        ("merc.tif", "stretched"),
        ("deg.asc", "in_degrees"),
        (
            "hole_nohead.asc",
            coded("out_of_range", value=-9999.0, where="line 11, column 6", problem="-9999 m is not a height"),
        ),
        ("nrows-1e309.asc", coded("out_of_range", name="nrows")),
    ],
)
def test_shared_grids_that_are_rejected(name: str, fault: str | Coded) -> None:
    if name.endswith(".tif"):
        pytest.importorskip("rasterio", reason="the extra geotiff is not installed")
    with raises(ParameterError, fault):
        read_terrain(CASES / name)


@pytest.mark.skipif(not CASES.is_dir(), reason="no ../shared")
def test_shared_snow_map_with_a_huge_value_is_rejected() -> None:
    with raises(ParameterError, "out_of_range", row=5, column="H_V_N_per_mm3", cell="1e308"):
        read_snow_map(CASES / "map-huge-value.csv")
