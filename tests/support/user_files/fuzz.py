"""Damaged files of each kind: what reads them gives a result or a `SkisnowError`, and nothing else.

``python -m tests.support.user_files.fuzz --seed 1 -n 1000`` tries so many of each kind and prints what broke.
"""

from __future__ import annotations

import argparse
import random
import traceback
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from skisnow._support.errors import SkisnowError
from skisnow.campaign.reading.campaign_file import read_campaign_file
from skisnow.campaign.reading.text import UnreadableTextError, decode
from skisnow.identification.data import collected, values_to_begin_with
from skisnow.identification.fitting import _clock
from skisnow.identification.parameter import parameter_table
from skisnow.identification.problem import keys_of_runs
from skisnow.identification.track_frame import _site
from skisnow.scenario import scenario_file, scenario_text
from skisnow.scenario.identify_section import given_parameters
from skisnow.scenario.keys import parse_change
from skisnow.scenario.reading import load_input
from skisnow.ski import read_ski
from skisnow.ski.monkeycam import monkeycam_shape
from skisnow.snow.from_results import snow_from_results
from skisnow.studies.study import read_study

CAMPAIGN = b"""name = "Hafelekar"
place = "Innsbruck"
observers = ["A", "B"]
gauge_resolution_mm = 0.01
load_uncertainty_N = 2.0
load_steps_N = [50, 100.0, 150]
[[tool]]
name = "ski"
shape = "ski"
length_mm = 100
width_mm = 62
[[tool]]
name = "disc"
shape = "disc"
diameter_mm = 50
[[plate]]
name = "blade"
length_mm = 200
[screening]
exclude = ["zero_depth"]
"""
SKI = b"""name = "mine"
length_mm = 1593
running_length_mm = 1396
sidecut_length_mm = 1458
tip_width_mm = 116
waist_width_mm = 68
tail_width_mm = 101
mass_kg = 2.231
camber_mm = 7
EI_N_m2 = [100, 250, 440, 260, 100]
GJ_N_m2 = [60, 140, 175, 140, 60]
"""
STUDY = b"""out = "table.csv"
[fixed]
ski = "slalom"
published = "race-piste"
load_N = 800
unloading_ratio = 10
[latin_hypercube]
n = 5
seed = 1
edge_angle_deg = [30, 60]
"""
IDENTIFY = b"""
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
RESULTS = b"""{"penetration": {"experiments": [
{"used": true, "site": "A", "H_V_N_per_mm3": 0.128}, {"used": true, "site": "B", "H_V_N_per_mm3": 0.2},
{"used": false, "site": "A", "H_V_N_per_mm3": null}]},
"shear": {"experiments": [{"used": true, "site": "A", "S_f_N_per_mm2": 0.1}]}}
"""
DESIGN = b"""{"board": {"name": "flat", "nose length": 20, "effective edge length": "120cm", "tail length": 18.5,
"sidecut radius": "14m", "taper": "2mm", "waist width": "7.2cm", "stance setback": 2.5, "splitboard": false,
"edge shape": {"type": "Basic Arc"}}}
"""
CELLS = "run,station_m,time_s\nfirst,20,3.34\nfirst,40,5.1\nfirst,60,6.5\n"

EVIL: tuple[bytes, ...] = (
    b"0", b"-1", b"9" * 5000, b"1" + b"0" * 400, b"1e400", b"-1e-320", b"nan", b"inf", b"NaN", b"Infinity", b"-0.0",
    b"9223372036854775808", b"true", b"null", b"[]", b"{}", b"[[]]", b'""', b'" "', b'"\\u0000"', b'"\\ud800"', b"\x00",
    b"\xff", b"\xff\xfe", b"[" * 3000, b"{" * 40, b"a." * 20_000, b'"' + b"x" * 3000 + b'"', b"'", b'"', b'"""', b"#",
    b"=", b",", b".", b"\n", b"\r", b"[a]\n", b"[[a]]\n", b"2013-02-01", b"10:00:00", b"0x1F", b"1_000", "ﬁé☃".encode(),
    b"../../x", b"/dev/zero", b"\\", b'"/dev/zero"', b'"\xc2\x85"', b"1" + b"0" * 300, b"1e300", b"1e-300",
)  # fmt: skip


@dataclass(frozen=True)
class Kind:
    """A kind of file: its name, one that is sound, and what reads it."""

    name: str
    sound: bytes
    read: Callable[[Path], object]


def _campaign(path: Path) -> object:
    try:
        return read_campaign_file(decode(path.read_bytes()).text, [])
    except UnreadableTextError:
        return None


def _identify(path: Path) -> object:
    given = load_input(path)
    own = given_parameters(given.identify)
    _clock(given, None)
    _site(given.identify.get("site", {"fall_line_azimuth_deg": 0}))
    cells = path.with_name("cells.csv")
    cells.write_text(CELLS, encoding="utf-8")
    asked = scenario_file(path)
    read = collected(given, asked, [cells], ["friction.mu_0"])
    keys = keys_of_runs(["friction.mu_0"], read.runs)
    return parameter_table(keys, values_to_begin_with(asked, read, own), own)


def _changes(path: Path) -> object:
    words = [line.replace("\0", "") for line in path.read_bytes().decode("utf-8", "surrogateescape").split("\n")]
    return scenario_file("carved-46m", changes=dict(parse_change(word) for word in words if "=" in word))


SCENARIO = scenario_text("carved-46m").encode()
CHANGES = b"mass_kg=80\nslope.angle_deg=10\ninertia_kg_m2=[6, 8, 10]\nski.name=slalom\npublished=race-piste\n"
KINDS = (
    Kind("campaign.toml", CAMPAIGN, _campaign),
    Kind("scenario.toml", SCENARIO, scenario_file),
    Kind("identify.toml", SCENARIO + IDENTIFY, _identify),
    Kind("ski.toml", SKI, read_ski),
    Kind("study.toml", STUDY, read_study),
    Kind("results.json", RESULTS, snow_from_results),
    Kind("ski-def.json", DESIGN, monkeycam_shape),
    Kind("changes", CHANGES, _changes),
)


def damaged(sound: bytes, random_: random.Random) -> bytes:
    """A file with one to three errors: bytes flipped, cut, doubled, replaced by something evil, values exchanged."""
    data = bytearray(sound)
    for _ in range(random_.choice((1, 1, 1, 2, 3))):
        at = random_.randrange(len(data) + 1)
        end = min(len(data), at + random_.choice((0, 1, 1, 3, 8, 30)))
        how = random_.randrange(6)
        if how == 0 and data:
            data[at % len(data)] ^= 1 << random_.randrange(8)
        elif how == 1:
            del data[at:end]
        elif how == 2:
            data[at:at] = data[at:end] * random_.choice((1, 2, 50))
        elif how == 3:
            data[at:end] = random_.choice(EVIL)
        else:
            _exchange_value(data, random_)
    return bytes(data)


def _exchange_value(data: bytearray, random_: random.Random) -> None:
    """Put something evil in place of what stands behind an equals sign or a colon."""
    places = [place for place, byte in enumerate(data) if byte in b"=:"]
    if places:
        at = random_.choice(places) + 1
        ends = [end for end in (data.find(mark, at) for mark in (b"\n", b",", b"}")) if end >= 0]
        data[at : min(ends, default=len(data))] = b" " + random_.choice(EVIL)


def broken(kind: Kind, folder: Path, *, seed: int, number: int) -> list[tuple[bytes, str]]:
    """Files that raised something else than a `SkisnowError`, with the trace."""
    found = []
    random_ = random.Random(f"{kind.name} {seed}")
    path = folder / kind.name
    for _ in range(number):
        data = damaged(kind.sound, random_)
        path.write_bytes(data)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                kind.read(path)
        except SkisnowError:
            continue
        except Exception:
            found.append((data, traceback.format_exc()))
    return found


def main() -> None:
    """Try many, print what broke, each place once."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-n", type=int, default=1000)
    parser.add_argument("--kind", default="")
    options = parser.parse_args()
    with TemporaryDirectory() as name:
        for kind in (each for each in KINDS if options.kind in each.name):
            found = broken(kind, Path(name), seed=options.seed, number=options.n)
            by_place = {trace[-300:]: (data, trace) for data, trace in found}
            print(f"{kind.name}: {len(found)} of {options.n} broke, at {len(by_place)} places", flush=True)
            for data, trace in list(by_place.values())[:10]:
                print(repr(data[-300:]), trace[-1500:], sep="\n")


if __name__ == "__main__":
    main()
