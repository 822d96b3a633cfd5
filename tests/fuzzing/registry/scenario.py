"""Readers of scenarios and of what they name: skis, slopes, snow, boots; and of identify's sections."""

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from skisnow import read_ski, read_snow
from skisnow.forces.friction import read_friction_file
from skisnow.identification.data import _read_site, collect_data, start_values
from skisnow.identification.parameter import parameter_table
from skisnow.identification.problem import expand_keys
from skisnow.scenario import load_scenario, read_profile, read_terrain, scenario_file, scenario_text
from skisnow.scenario.boots import read_boots
from skisnow.scenario.identify_section import given_parameters
from skisnow.scenario.keys import parse_change
from skisnow.scenario.reading import load_input
from skisnow.scenario.snow_map import read_snow_layers, read_snow_map
from tests.forces.friction.test_friction import STATES

from ..binaries import BINARY
from ..reader import Reader, single_file
from ..texts import TABLE, TEXT, token
from ..trees import JSON, TOML

_SKI = b"""name = "mine"
length_mm = 1593
running_length_mm = 1396
sidecut_length_mm = 1458
tip_width_mm = 116
waist_width_mm = 68
tail_width_mm = 101
mass_kg = 2.231
camber_mm = 7
boot_position_mm = -10
tip_rocker_length_mm = 50
tip_rocker_height_mm = 3
base_bevel_deg = 0.5
EI_N_m2 = [100, 250, 440, 260, 100]
GJ_N_m2 = [60, 140, 175, 140, 60]
stiffness_station_mm = [700, 300, 0, -300, -700]
"""
_WITH_TABLE = b"""name = "tab"
running_length_mm = 1396
sidecut_length_mm = 1458
mass_kg = 2.2
table = "table.csv"
GJ_N_m2 = [60, 140, 175, 140, 60]
camber_mm = 7
"""
_SKI_TABLE = b"station_m,width_mm,EI_N_m2\n0.8,100,60\n0.4,85,250\n0,68,440\n-0.4,80,250\n-0.8,100,60\n"
_IDENTIFY = b"""
[identify]
clock = "free"
[identify.mu_0]
start = 0.05
lower = 0.0
upper = 0.2
prior_mean = 0.04
prior_sd = 0.01
[identify.site]
fall_line_azimuth_deg = 120
latitude_deg = 47.1
longitude_deg = 11.3
[identify.runs."first"]
mass_kg = 80
"""
_CELLS = b"run,station_m,time_s\nfirst,20,3.34\nfirst,40,5.1\nfirst,60,6.5\n"
_RESULTS = b"""{"penetration": {"experiments": [
{"used": true, "site": "A", "H_V_N_per_mm3": 0.128}, {"used": true, "site": "B", "H_V_N_per_mm3": 0.2},
{"used": false, "site": "A", "H_V_N_per_mm3": null}],
"unloading": [{"site": "A", "unloading_ratio": 9.0, "unloading_ratio_interval": [7.0, 12.0]},
{"site": null, "unloading_ratio": 9.0, "unloading_ratio_interval": [7.0, 12.0]}]},
"shear": {"experiments": [{"used": true, "site": "A", "S_f_N_per_mm2": 0.1},
{"used": true, "site": "B", "S_f_N_per_mm2": 0.2}],
"displacement": [{"site": null, "shear_displacement_mm": 0.5, "shear_displacement_interval_mm": [0.2, 0.9]}]}}
"""
_CHANGES = b"mass_kg=80\nslope.angle_deg=10\ninertia_kg_m2=[6, 8, 10]\nski.name=slalom\npublished=race-piste\n"
_PROFILE = b"x,y\n" + b"".join(b"%d,%.1f\n" % (2 * i, 100 - 0.3 * i) for i in range(20))
_TERRAIN = b"x_m,y_m,z_m\n" + b"".join(
    b"%d,%d,%.2f\n" % (2 * i, 2 * j, 50 - 0.2 * i) for i in range(6) for j in range(5)
)
_MAP = b"x_m,y_m,H_V_N_per_mm3,S_f_N_per_mm2\n" + b"".join(
    b"%d,%d,%.2f,0.5\n" % (2 * i, 2 * j, 0.2 + 0.01 * i) for i in range(5) for j in range(4)
)
_LAYERS = b"depth_mm,hardness_share\n0,1\n5,10\n12,3\n"
_FRICTION = STATES.encode()
_ALONG = b"x_m,H_V_N_per_mm3\n0,0.2\n3,0.21\n10,0.3\n11,0.2\n"
_ESRI = b"ncols 5\nnrows 4\nxllcorner 100.0\nyllcorner 200.0\ncellsize 2.0\nNODATA_value -9999\n" + b"".join(
    b" ".join(b"%.2f" % (50 - 0.3 * i - 0.1 * j) for i in range(5)) + b"\n" for j in range(4)
)
_SYSTEM = (
    b'PROJCS["WGS_1984_UTM_Zone_32N",GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,'
    b'298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],'
    b'PARAMETER["False_Easting",500000.0],PARAMETER["False_Northing",0.0],PARAMETER["Central_Meridian",9.0],'
    b'PARAMETER["Scale_Factor",0.9996],PARAMETER["Latitude_Of_Origin",0.0],UNIT["Meter",1.0]]'
)
_BOOTS = b"time_s,left_edge_angle_deg,left_up_m,right_edge_angle_deg,right_heading_deg\n" + b"".join(
    b"%.1f,%d,0.01,%d,1\n" % (0.1 * i, i, i) for i in range(8)
)
_MOT = (
    b"boots\nversion=1\nnRows=8\nnColumns=4\ninDegrees=yes\nendheader\ntime\tleft_edge_angle_deg\tright_edge_angle_deg\tleft_forward_m\n"
    + b"".join(b"%.1f\t%d\t%d\t0.01\n" % (0.1 * i, i, i) for i in range(8))
)
_PLACES = np.linspace(-3.0, 30.0, 7)


def _read_identify(folder: Path) -> object:
    path = folder / "identify.toml"
    given = load_input(path)
    own = given_parameters(given.identify)
    _read_site(given.identify.get("site", {"fall_line_azimuth_deg": 0}))
    asked = scenario_file(path)
    read = collect_data(given, asked, [folder / "cells.csv"], ["friction.mu_0"])
    keys = expand_keys(["friction.mu_0"], read.runs)
    return parameter_table(keys, start_values(asked, read, own), own)


def _read_changes(folder: Path) -> object:
    words = (folder / "changes").read_bytes().decode("utf-8", "surrogateescape").replace("\0", "").split("\n")
    return scenario_file("carved-46m", changes=dict(parse_change(word) for word in words if "=" in word))


def _used_ski(path: Path) -> object:
    ski = read_ski(path)
    return ski.at(np.zeros(1)), ski.sidecut_radius_of_edge_line, repr(ski)


def _used_profile(path: Path) -> object:
    profile = read_profile(path)
    return profile.heights(_PLACES), profile.gradients(_PLACES), repr(profile)


def _used_terrain(path: Path) -> object:
    terrain = read_terrain(path, smoothing=1.0)
    return repr(terrain)


def _used_map(path: Path) -> object:
    found = read_snow_map(path)
    return found.mean_hardness, found.mean_stress, repr(found)


def _used_layers(path: Path) -> object:
    return repr(read_snow_layers(path))


def _used_friction(path: Path) -> object:
    law = read_friction_file(path)
    return law.at(-5.0, 0.0), law.at(0.0, 1.0), repr(law)


def _used_boots(path: Path) -> object:
    boots = read_boots(path, edge_angle=0.1, stance_width=0.4)
    return [boots.poses(at) for at in (-1.0, 0.0, 0.15, 3.0)], repr(boots)


@cache
def _geotiff() -> dict[str, bytes]:
    import rasterio

    heights = 50.0 - 0.3 * np.arange(20.0).reshape(4, 5)
    with TemporaryDirectory() as name:
        place = Path(name) / "heights.tif"
        with rasterio.open(
            place, "w", driver="GTiff", width=5, height=4, count=1, dtype="float32", nodata=-9999.0,
            crs="EPSG:32632", transform=rasterio.Affine(2.0, 0.0, 100.0, 0.0, -2.0, 54.0), compress="deflate",
        ) as file:  # fmt: skip
            file.write(heights.astype("float32"), 1)
        return {"heights.tif": place.read_bytes()}


_SLALOM = scenario_text("slalom-20-gates").encode()
_TABLED = {"ski.toml": _WITH_TABLE, "table.csv": _SKI_TABLE}
READERS = (
    single_file("scenario.toml", _SLALOM, load_scenario, TOML, "scenario.reading:load_input"),
    Reader(
        name="identify.toml", target="identify.toml", read=_read_identify, mutations=TOML,
        files=lambda: {"identify.toml": scenario_text("carved-46m").encode() + _IDENTIFY, "cells.csv": _CELLS},
        covers=("scenario.reading:load_input",),
    ),
    Reader(
        name="changes", target="changes", files=lambda: {"changes": _CHANGES}, read=_read_changes,
        mutations=(token, *TOML), covers=("scenario.keys:parse_change",),
    ),
    single_file("ski.toml", _SKI, _used_ski, TOML, "ski.file_parts:file_values"),
    single_file(
        "ski with table.toml", lambda: _TABLED, _used_ski, TOML, "ski.file_parts:file_values", target="ski.toml"
    ),
    Reader(
        name="ski table.csv", target="table.csv", files=lambda: _TABLED, mutations=TABLE,
        read=lambda folder: _used_ski(folder / "ski.toml"), covers=("ski.table_file:_lines",),
    ),
    single_file("results.json", _RESULTS, lambda path: repr(read_snow(path)), JSON, "snow.from_results:_read_results"),
    single_file("profile.csv", _PROFILE, _used_profile, TABLE, "scenario.slope:read_profile"),
    single_file(
        "terrain.csv", _TERRAIN, _used_terrain, TABLE,
        "scenario.raster_formats:read_grid_table", "scenario.terrain:_read_heights",
    ),
    single_file("terrain.asc", _ESRI, _used_terrain, TEXT, "scenario.raster_formats:read_esri_ascii"),
    Reader(
        name="terrain.prj", target="terrain.prj", files=lambda: {"terrain.asc": _ESRI, "terrain.prj": _SYSTEM},
        read=lambda folder: _used_terrain(folder / "terrain.asc"), mutations=TEXT,
        covers=("scenario.raster_formats:read_esri_ascii",),
    ),
    single_file(
        "heights.tif", _geotiff, _used_terrain, BINARY, "scenario.raster_formats:read_geotiff", needs=("rasterio",)
    ),
    single_file("map.csv", _MAP, _used_map, TABLE, "scenario.snow_map:read_snow_map"),
    single_file("along.csv", _ALONG, _used_map, TABLE, "scenario.snow_map:read_snow_map"),
    single_file("friction.toml", _FRICTION, _used_friction, TOML, "forces.friction.law_file:read_friction_file"),
    single_file("layers.csv", _LAYERS, _used_layers, TABLE, "scenario.snow_map:read_snow_layers"),
    single_file("boots.csv", _BOOTS, _used_boots, TABLE, "scenario.boots:read_boots"),
    single_file("boots.mot", _MOT, _used_boots, TEXT, "scenario.boots:read_boots"),
)  # fmt: skip
