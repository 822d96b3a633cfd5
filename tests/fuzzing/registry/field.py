"""Readers of field measurements: campaigns, workbooks, stores, snow pits, weather, recordings."""

import csv
import io
from argparse import Namespace
from functools import cache
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

import numpy as np

from skisnow import read_campaign, samples, write_reference
from skisnow._support.errors import FieldDataError
from skisnow.campaign.caaml import read_caaml
from skisnow.campaign.importing.answers import Answers, read_template
from skisnow.campaign.importing.proposal import propose
from skisnow.campaign.smet import read_smet
from skisnow.campaign.snow_micro_pen import read_snow_micro_pen
from skisnow.campaign.templates import workbook_bytes
from skisnow.cli import campaign
from skisnow.interop.caaml import write_caaml
from tests.campaign.recordings import built
from tests.interop.pits import full_pit

from ..archives import archive
from ..binaries import BINARY
from ..markup import XML
from ..reader import Files, Reader, single_file
from ..texts import TABLE, TEXT, Mutation
from ..trees import TOML

_SMET = b"""SMET 1.1 ASCII
[HEADER]
station_id       = WFJ2
station_name     = Weissfluhjoch: snow
latitude         = 46.829
longitude        = 9.809
altitude         = 2540
nodata           = -999
tz               = 1
units_offset     = 0 273.15 0 0
units_multiplier = 1 1 0.01 1
fields           = timestamp TA RH VW
[DATA]
2026-02-03T08:00  -4.0  80   3.5
2026-02-03T09:00  -2.0  -999 4.5   # remark

2026-02-03T14:00  +1.5  60   5.5
"""
_CORRECTIONS = (
    "file,experiment,row,column,old,new,who,when,why\n"
    "penetration.csv,{pen},2,depth_mm,{depth},1.2,A,2026-02-03,misread\n"
)
_MOST_LINES = 40


@cache
def _campaign() -> Files:
    with TemporaryDirectory() as name:
        folder = Path(name) / "campaign"
        write_reference(folder, seed=1)
        found = {each.name: each.read_bytes() for each in sorted(folder.iterdir())}
    for file, data in found.items():
        if file.endswith(".csv"):
            found[file] = b"".join(data.splitlines(keepends=True)[:_MOST_LINES])
    found["campaign.toml"] += b'\n[weather]\nfile = "station.smet"\n'
    found["station.smet"] = _SMET
    found["snow_micro_pen.csv"] = b"recording,file,site\n1,20260203_1.pnt,A\n2,20260203_2.pnt,B\n"
    found["20260203_1.pnt"] = found["20260203_2.pnt"] = _recording()
    head, first, *_ = csv.reader(io.StringIO(found["penetration.csv"].decode()))
    row = dict(zip(head, first, strict=True))
    found["corrections.csv"] = _CORRECTIONS.format(pen=row["experiment"], depth=row["depth_mm"]).encode()
    return found


@cache
def _recording() -> bytes:
    noise = np.random.default_rng(1).normal(0.0, 4.0, 600)
    return built(np.concatenate([noise[:200], 300 + 40 * noise[200:]]).astype(int))


def _below(folder: str, files: Files) -> Files:
    return {f"{folder}/{name}": content for name, content in files.items()}


def _read_campaign(folder: Path) -> object:
    try:
        campaign = read_campaign(folder / "campaign")
    except FieldDataError as error:
        return [str(each) for each in error.problems]
    return [str(each) for each in campaign.problems]


@cache
def _workbook() -> Files:
    from openpyxl import load_workbook

    book = load_workbook(io.BytesIO(workbook_bytes("Hafelekar")))
    for name, content in _campaign().items():
        if name.endswith(".csv") and "micro_pen" not in name:
            title = name.removesuffix(".csv")
            if title in book.sheetnames:
                del book[title]
            sheet = book.create_sheet(title)
            for cells in csv.reader(io.StringIO(content.decode())):
                sheet.append([_cell(each) for each in cells])
    stream = io.BytesIO()
    book.save(stream)
    return {"campaign.xlsx": stream.getvalue()}


def _cell(text: str) -> str | float:
    try:
        return float(text)
    except ValueError:
        return text


def _member(rng: Random, name: str, content: bytes) -> bytes:
    return rng.choice(XML if name.endswith((".xml", ".rels")) else BINARY)(rng, content)


def _read_workbook(folder: Path) -> object:
    try:
        return read_campaign(folder / "campaign.xlsx").problems
    except FieldDataError as error:
        return [str(each) for each in error.problems]


SAMPLES = Path(samples.__file__).parent / "files"


@cache
def _imported() -> Files:
    return propose("two-sites.xlsx", (SAMPLES / "two-sites.xlsx").read_bytes()).files


@cache
def _pit() -> Files:
    with TemporaryDirectory() as name:
        write_caaml(full_pit(), Path(name) / "pit.caaml")
        return {"pit.caaml": (Path(name) / "pit.caaml").read_bytes()}


def _of_campaign(file: str, mutations: tuple[Mutation, ...], *covers: str) -> Reader:
    return Reader(
        name=f"campaign {file}",
        target=f"campaign/{file}",
        files=lambda: _below("campaign", _campaign()),
        read=_read_campaign,
        mutations=mutations,
        covers=("campaign.reading.campaign_files:CampaignFiles.read", *covers),
    )


READERS = (
    _of_campaign("campaign.toml", TOML),
    _of_campaign("penetration.csv", TABLE),
    _of_campaign("shear.csv", TABLE),
    _of_campaign("density.csv", TABLE),
    _of_campaign("drop_cone.csv", TABLE),
    _of_campaign("snow_micro_pen.csv", TABLE),
    _of_campaign("corrections.csv", TABLE),
    Reader(
        name="campaign.xlsx",
        target="campaign.xlsx",
        files=_workbook,
        read=_read_workbook,
        mutations=archive(_member),
        covers=("campaign.reading.campaign:_read_folder", "_support.user_files.workbook:workbook_sheets"),
    ),
    single_file(
        "two-sites.xlsx",
        (SAMPLES / "two-sites.xlsx").read_bytes(),
        lambda path: campaign._ask_questions(Namespace(file=path), Answers(), asks=False),
        archive(_member),
        "cli.campaign:_ask_questions",
    ),
    single_file(
        "[import]", _imported, read_template, TOML, "campaign.importing.answers:read_template", target="campaign.toml"
    ),
    single_file("pit.caaml", _pit, read_caaml, XML, "campaign.caaml:read_caaml"),
    single_file("station.smet", _SMET, lambda path: repr(read_smet(path)), TEXT, "campaign.smet:read_smet"),
    single_file(
        "20260203.pnt", _recording(), read_snow_micro_pen, BINARY, "campaign.snow_micro_pen:read_snow_micro_pen"
    ),
)
