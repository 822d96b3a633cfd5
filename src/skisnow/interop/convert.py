"""Conversion between file formats, chosen by the endings of the files (``skisnow convert``).

A further conversion is one more entry in `CONVERSIONS`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path
from typing import Final, TypeAlias

import numpy as np

from .._support.errors import OutputError, ParameterError
from .._support.messages import Message, joined
from .._support.spreadsheet_text import csv_text
from .._support.staging import write_file
from .._support.units import MM
from ..campaign import read_campaign, read_snow_micro_pen
from ..campaign.caaml import read_caaml
from ..campaign.smet import StationSeries, read_smet
from ..campaign.snow_micro_pen import SnowMicroPenSettings, snow_surface
from ..campaign.snow_pit import ForceProfile, SnowPit
from ..estimation.weather import QUANTITIES
from ..parameters import suggest_and_list
from .caaml import write_caaml
from .campaign_netcdf import write_campaign_netcdf
from .opensim import read_c3d, read_motion, read_trc, write_c3d, write_motion, write_trc
from .snowex import site_pit, sites_of, write_snowex_force, write_snowex_pit

NO_DATA: Final = -999.0


def write_smet(series: StationSeries, path: str | Path) -> Path:
    """Write all fields in SI, with the times in the file's own time zone.

    Raises ParameterError: a value is exactly -999, which means none.
    Raises OutputError: the file cannot be written.
    """
    write_file(path, smet_text(series))
    return Path(path)


def write_weather_csv(series: StationSeries, path: str | Path) -> Path:
    """Write the station's columns that a campaign uses: time with its zone, temperatures in °C, humidity in percent.

    Raises ParameterError: the station has no such quantity.
    Raises OutputError: the file cannot be written.
    """
    available = {key: made for key, made in QUANTITIES.items() if made[0] in series.fields}
    if not available:
        wanted = ", ".join(name for name, *_ in QUANTITIES.values())
        raise ParameterError("{file} has no field of {wanted}; nothing was written").tag(
            "no_data", file=series.file, wanted=wanted
        )
    columns = [(series.fields[name] * factor + offset).tolist() for name, factor, offset in available.values()]
    rows = (
        ",".join((when, *("" if math.isnan(value) else f"{value:.10g}" for value in values)))
        for when, *values in zip(_time_texts(series, zone=True), *columns, strict=True)
    )
    write_file(path, "\n".join((",".join(("time", *available)), *rows)) + "\n")
    return Path(path)


def smet_text(series: StationSeries) -> str:
    """Content of an SMET 1.1 file with all fields in SI."""
    name = re.sub("[#;]", " ", series.station)  # these begin a comment
    place = {"latitude": series.latitude_deg, "longitude": series.longitude_deg, "altitude": series.altitude}
    lines = [
        "SMET 1.1 ASCII",
        "[HEADER]",
        f"station_id = {''.join(name.split()) or 'station'}",
        f"station_name = {name}",
    ]
    lines += [f"{key} = {NO_DATA if value is None else value:.10g}" for key, value in place.items()]
    lines += [f"nodata = {NO_DATA:g}", f"tz = {series.utc_offset:g}"]
    lines += [f"fields = {' '.join(('timestamp', *series.fields))}", "[DATA]"]
    columns = [column.tolist() for column in series.fields.values()]
    for when, *values in zip(_time_texts(series, zone=False), *columns, strict=True):
        if NO_DATA in values:
            raise ParameterError(
                "{file} has a value of {no_data:g} at {when}, which means a missing value in SMET"
            ).tag("out_of_range", file=series.file, no_data=NO_DATA, when=when)
        lines.append(" ".join((when, *(f"{NO_DATA if math.isnan(value) else value:.10g}" for value in values))))
    return "\n".join(lines) + "\n"


def _time_texts(series: StationSeries, *, zone: bool) -> Iterator[str]:
    own = timezone(timedelta(hours=series.utc_offset))
    for seconds in series.time.tolist():
        moment = datetime.fromtimestamp(seconds, UTC).astimezone(own)
        yield (moment if zone else moment.replace(tzinfo=None)).isoformat()


CAMPAIGN: Final = "campaign"
CSV: Final = "CSV"
NETCDF: Final = "NetCDF"
ENDINGS: Final[Mapping[str, str]] = {
    ".caaml": "CAAML",
    ".xml": "CAAML",
    ".pnt": "SnowMicroPen",
    ".smet": "SMET",
    ".csv": CSV,
    ".xlsx": CAMPAIGN,
    ".xlsm": CAMPAIGN,
    ".mot": "OpenSim table",
    ".sto": "OpenSim table",
    ".trc": "TRC markers",
    ".c3d": "C3D markers",
    ".nc": NETCDF,
}
"""Kind of a file by its ending; a folder is a campaign."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ConvertOptions:
    """Values that the formats do not contain.

    site: site of a campaign; None if it has a single one.
    snow_height: height of the snow on the ground (m), if the source does not state it.
    time: ISO 8601, if the source does not state it.
    forces: a .mot or .sto file; its columns are written to the .c3d file together with the markers.
    layers_to: depth (m) to which a recording becomes layers of a run (``snow.layers_file``); None: it becomes a force
        table.
    report: called with each note about the source, such as the points of a .c3d file that were omitted.
    """

    site: str | None = None
    snow_height: float | None = None
    time: str | None = None
    forces: Path | None = None
    layers_to: float | None = None
    report: Callable[[str], None] | None = None


def convert(source: str | Path, target: str | Path, options: ConvertOptions | None = None) -> tuple[Path, ...]:
    """Read one file or campaign and write another; the kinds follow from the endings.

    Returns: the files that were written.
    Raises ParameterError: the conversion is unknown (the message lists the known ones), or the target's format requires
        data that the source does not contain.
    Raises FieldDataError: the source cannot be read.
    Raises OutputError: the target is the source, or cannot be written.
    """
    source, target = Path(source), Path(target)
    kinds = _kind_of_file(source), _kind_of_file(target)
    made = CONVERSIONS.get(kinds)
    if made is None:
        raise ParameterError("{source} to {target} is not known. Known are {known}").tag(
            "unknown_name",
            source=kinds[0],
            target=kinds[1],
            known="; ".join(f"{read} to {written}" for read, written in CONVERSIONS),
        )
    if source.resolve() == target.resolve():
        raise OutputError("{target} is the file that is read; give the new one another name").tag(
            "same_file", target=target
        )
    options = options or ConvertOptions()
    if options.forces is not None and kinds[1] != ENDINGS[".c3d"]:
        raise ParameterError(
            "forces are written to a .c3d file with its markers; {target} is not one. Remove --forces"
        ).tag("wrong_ending", target=target)
    if options.layers_to is not None and kinds != ("SnowMicroPen", CSV):
        raise ParameterError(
            "layers of a run come from a .pnt file and go into a .csv file. Remove --layers-to-mm"
        ).tag("wrong_ending")
    return made(source, target, options) or (target,)


def _kind_of_file(path: Path) -> str:
    if path.is_dir():
        return CAMPAIGN
    ending = path.suffix.lower()
    if ending not in ENDINGS:
        problem = Message("the ending of {path} states no format; a folder is a campaign.", path=path)
        raise ParameterError(joined([problem, suggest_and_list(ending, ENDINGS)])).tag("wrong_ending")
    return ENDINGS[ending]


def _pit_of_campaign(source: Path, options: ConvertOptions) -> SnowPit:
    from ..estimation.analysis import FEWEST_RESAMPLES, analyse

    campaign = read_campaign(source)
    sites = sites_of(campaign)
    if options.site is None and len(sites) != 1:
        raise ParameterError("{source} has {n_sites} sites; name one with --site: {sites}").tag(
            "missing", source=source, n_sites=len(sites), sites=list(sites)
        )
    site = sites[0] if options.site is None else options.site
    return site_pit(analyse(campaign, n_resamples=FEWEST_RESAMPLES), site)  # no bootstrap is in a mean's interval


def _pit_of_recording(source: Path) -> SnowPit:
    profile = read_snow_micro_pen(source)
    day = profile.recorded_on
    return SnowPit(
        name=profile.name or source.stem,
        time="" if day is None else day.isoformat(),
        comment=profile.comment,
        latitude_deg=profile.latitude_deg,
        longitude_deg=profile.longitude_deg,
        elevation=profile.height,
        forces=(ForceProfile("SnowMicroPen", profile.depth, profile.force.clip(min=0.0)),),
    )


def _recording_as_csv(source: Path, target: Path, options: ConvertOptions) -> None:
    profile = read_snow_micro_pen(source)
    if options.layers_to is None:
        write_snowex_force(profile, target)
        return
    default = SnowMicroPenSettings()
    surface = snow_surface(profile.force, profile.sample_distance, rise=default.surface_rise, hold=default.surface_hold)
    tops = MM * np.arange(round(options.layers_to / MM) + 2)
    if surface is None or profile.depth[-1] - surface.depth < tops[-1]:
        raise ParameterError("{source} has no snow surface with {depth_mm:g} mm of snow below it").tag(
            "no_data", source=source, depth_mm=tops[-1] / MM
        )
    borders = np.searchsorted(profile.depth, surface.depth + tops)
    layers = np.split(profile.force, borders)[1:-1]
    rows = (
        (f"{top / MM:g}", f"{max(float(layer.mean()), 1e-6):.6g}") for top, layer in zip(tops, layers, strict=False)
    )
    write_file(target, csv_text((("depth_mm", "force_N"), *rows)))


def _completed(pit: SnowPit, options: ConvertOptions) -> SnowPit:
    """The pit with snow height and time of the options where it lacks them."""
    height = options.snow_height if pit.snow_height is None else pit.snow_height
    return replace(pit, snow_height=height, time=pit.time or options.time or "")


def _to_caaml(read: Callable[[Path, ConvertOptions], SnowPit]) -> Conversion:
    return lambda source, target, options: (write_caaml(_completed(read(source, options), options), target),)


def _to_snowex(read: Callable[[Path, ConvertOptions], SnowPit]) -> Conversion:
    return lambda source, target, options: write_snowex_pit(_completed(read(source, options), options), target)


def _weather_as_csv(source: Path, target: Path, options: ConvertOptions) -> None:
    series = read_smet(source)
    write_weather_csv(series, target)
    omitted = [name for name in series.fields if name not in {field for field, *_ in QUANTITIES.values()}]
    if omitted and options.report is not None:
        options.report(f"{source}: {', '.join(omitted)} are not columns of a campaign and are omitted")


def _c3d_as_trc(source: Path, target: Path, options: ConvertOptions) -> None:
    markers = read_c3d(source)
    if markers.omitted and options.report is not None:
        names = ", ".join(markers.omitted)
        options.report(f"{source}: {len(markers.omitted)} points without a name or a place are omitted: {names}")
    write_trc(markers, target)


def _trc_as_c3d(source: Path, target: Path, options: ConvertOptions) -> None:
    write_c3d(read_trc(source), target, forces=None if options.forces is None else read_motion(options.forces))


Conversion: TypeAlias = Callable[[Path, Path, ConvertOptions], tuple[Path, ...] | None]
"""Reads the source and writes the target, or returns several files that it wrote instead."""

CONVERSIONS: Final[dict[tuple[str, str], Conversion]] = {
    (CAMPAIGN, "CAAML"): _to_caaml(_pit_of_campaign),
    (CAMPAIGN, CSV): _to_snowex(_pit_of_campaign),
    (CAMPAIGN, NETCDF): lambda source, target, _: write_campaign_netcdf(read_campaign(source), target),
    ("CAAML", "CAAML"): _to_caaml(lambda source, _: read_caaml(source)),
    ("CAAML", CSV): _to_snowex(lambda source, _: read_caaml(source)),
    ("SnowMicroPen", "CAAML"): _to_caaml(lambda source, _: _pit_of_recording(source)),
    ("SnowMicroPen", CSV): _recording_as_csv,
    ("SMET", "SMET"): lambda source, target, _: (write_smet(read_smet(source), target),),
    ("SMET", CSV): _weather_as_csv,
    ("OpenSim table", "OpenSim table"): lambda source, target, _: write_motion(read_motion(source), target),
    ("TRC markers", "TRC markers"): lambda source, target, _: write_trc(read_trc(source), target),
    ("TRC markers", "C3D markers"): _trc_as_c3d,
    ("C3D markers", "TRC markers"): _c3d_as_trc,
}
"""By the kinds of source and target."""
