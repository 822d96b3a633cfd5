"""Conversion between file formats, chosen by the endings of the files (``skisnow convert``).

A further conversion is one more entry in `CONVERSIONS`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
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
from ..campaign.snow_micro_pen import SnowMicroPenSettings, snow_surface
from ..campaign.snow_pit import ForceProfile, SnowPit
from ..parameters import suggest_and_list
from .caaml import write_caaml
from .campaign_netcdf import write_campaign_netcdf
from .opensim import read_c3d, read_motion, read_trc, write_motion, write_trc
from .site_pit import site_pit, sites_of

CAMPAIGN: Final = "campaign"
CSV: Final = "CSV"
NETCDF: Final = "NetCDF"
ENDINGS: Final[Mapping[str, str]] = {
    ".caaml": "CAAML",
    ".xml": "CAAML",
    ".pnt": "SnowMicroPen",
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
    time: ISO 8601, if the source does not state it.
    layers_to: depth (m) to which a recording becomes layers of a run (``snow.layers_file``).
    report: called with each note about the source, such as the points of a .c3d file that were omitted.
    """

    site: str | None = None
    time: str | None = None
    layers_to: float | None = None
    report: Callable[[str], None] | None = None


def convert(source: str | Path, target: str | Path, options: ConvertOptions | None = None) -> None:
    """Read one file or campaign and write another; the kinds follow from the endings.

    Raises ParameterError: the conversion is unknown (the message lists the known ones), or the target's format requires
        data that the source does not contain.
    Raises FieldDataError: the source cannot be read.
    Raises OutputError: the target is the source, or cannot be written.
    """
    source, target = Path(source), Path(target)
    kinds = _kind_of_file(source), _kind_of_file(target)
    made = CONVERSIONS.get(kinds)
    if made is None:
        known = "; ".join(f"{read} to {written}" for read, written in CONVERSIONS)
        raise ParameterError("{source} to {target} is not known. Known are {known}").tag(
            "unknown_name", source=kinds[0], target=kinds[1], known=known
        )
    if source.resolve() == target.resolve():
        raise OutputError("{target} is the file that is read; give the new one another name").tag(
            "same_file", target=target
        )
    options = options or ConvertOptions()
    if options.layers_to is not None and kinds != ("SnowMicroPen", CSV):
        raise ParameterError(
            "layers of a run come from a .pnt file and go into a .csv file. Remove --layers-to-mm"
        ).tag("wrong_ending")
    made(source, target, options)


def _kind_of_file(path: Path) -> str:
    """Format of a file by its ending, a folder is a campaign; rejects an unknown ending."""
    if path.is_dir():
        return CAMPAIGN
    ending = path.suffix.lower()
    if ending not in ENDINGS:
        problem = Message("the ending of {path} states no format; a folder is a campaign.", path=path)
        raise ParameterError(joined([problem, suggest_and_list(ending, ENDINGS)])).tag("wrong_ending")
    return ENDINGS[ending]


def _pit_of_campaign(source: Path, options: ConvertOptions) -> SnowPit:
    """Snow pit of a campaign's site, with its means; rejects several sites unless the options name one."""
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
    """Snow pit of a SnowMicroPen recording, with its forces (N) over the depth; pull counts as 0."""
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


def _recording_as_layers(source: Path, target: Path, options: ConvertOptions) -> None:
    """Write mean forces (N) of a SnowMicroPen recording in layers of 1 mm below the surface as CSV."""
    if options.layers_to is None:
        raise ParameterError("layers need a depth: give --layers-to-mm").tag("missing")
    profile = read_snow_micro_pen(source)
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


def _to_caaml(read: Callable[[Path, ConvertOptions], SnowPit]) -> Conversion:
    """Conversion that reads a snow pit and writes it as CAAML, with the options' time if the pit has none."""

    def made(source: Path, target: Path, options: ConvertOptions) -> None:
        pit = read(source, options)
        write_caaml(replace(pit, time=pit.time or options.time or ""), target)

    return made


def _c3d_as_trc(source: Path, target: Path, options: ConvertOptions) -> None:
    """Write the markers of a C3D file as TRC, and report omitted points."""
    markers = read_c3d(source)
    if markers.omitted and options.report is not None:
        names = ", ".join(markers.omitted)
        options.report(f"{source}: {len(markers.omitted)} points without a name or a place are omitted: {names}")
    write_trc(markers, target)


Conversion: TypeAlias = Callable[[Path, Path, ConvertOptions], None]
"""Reads the source and writes the target."""

CONVERSIONS: Final[dict[tuple[str, str], Conversion]] = {
    (CAMPAIGN, "CAAML"): _to_caaml(_pit_of_campaign),
    (CAMPAIGN, NETCDF): lambda source, target, _: write_campaign_netcdf(read_campaign(source), target),
    ("CAAML", "CAAML"): _to_caaml(lambda source, _: read_caaml(source)),
    ("SnowMicroPen", "CAAML"): _to_caaml(lambda source, _: _pit_of_recording(source)),
    ("SnowMicroPen", CSV): _recording_as_layers,
    ("OpenSim table", "OpenSim table"): lambda source, target, _: write_motion(read_motion(source), target),
    ("TRC markers", "TRC markers"): lambda source, target, _: write_trc(read_trc(source), target),
    ("C3D markers", "TRC markers"): _c3d_as_trc,
}
"""By the kinds of source and target."""
