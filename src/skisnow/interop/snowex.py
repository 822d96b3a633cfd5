"""Snow pits and penetrometer forces as CSV with the column names of the NASA SnowEx campaigns.

Heights count from the ground in cm, as there; -9999 means what is not known.
"""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import TYPE_CHECKING, Final

from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.staging import write_file
from .._support.units import CM, MM

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ..campaign.snow_micro_pen import SnowMicroPenProfile
    from ..campaign.snow_pit import SnowPit

NO_DATA: Final = "-9999"
DENSITY: Final = ("# Top (cm)", "Bottom (cm)", "Density A (kg/m3)", "Density B (kg/m3)", "Density C (kg/m3)")
TEMPERATURE: Final = ("# Depth (cm)", "Temperature (deg C)")
STRATIGRAPHY: Final = (
    "# Top (cm)", "Bottom (cm)", "Grain Size (mm)", "Grain Type", "Hand Hardness", "Manual Wetness", "Comments",
)  # fmt: skip
FORCE: Final = ("Depth (mm)", "Force (N)")


def write_snowex_pit(pit: SnowPit, path: str | Path) -> tuple[Path, ...]:
    """Write the tables of a pit: ``NAME_density.csv``, ``NAME_temperature.csv`` and ``NAME_stratigraphy.csv``.

    Parameters
    ----------
    pit
        With the height of the snow: SnowEx counts from the ground.
    path
        ``NAME.csv``; tables without a row are not written.

    Returns
    -------
    The files.

    Raises
    ------
    ParameterError
        The height of the snow is not known, or the pit has none of the three.
    OutputError
        A file cannot be written.
    """
    path = Path(path)
    height = pit.snow_height
    if height is None:
        raise ParameterError(
            Message(
                "SnowEx counts heights from the ground, and the snow height of {name!r} is not known: "
                "give it with --snow-height-cm",
                name=pit.name,
            ),
            code="unknown_name",
        )
    tables = {name: (columns, rows) for name, columns, rows in _tables(pit, height) if rows}
    if not tables:
        raise ParameterError(
            Message("{name!r} has no layers, densities or temperatures; nothing was written", name=pit.name),
            code="no_data",
        )
    written = []
    for name, (columns, rows) in tables.items():
        written.append(path.with_name(f"{path.stem}_{name}.csv"))
        write_file(written[-1], _csv((*_header(pit), columns, *rows)))
    return tuple(written)


def write_snowex_force(profile: SnowMicroPenProfile, path: str | Path) -> Path:
    """Write a recording of a SnowMicroPen as depth and force, from the first sample on.

    Raises
    ------
    OutputError
        The file cannot be written.
    """
    depth, force = (profile.depth / MM).tolist(), profile.force.tolist()
    rows = ((f"{where:.6f}", f"{newtons:.6f}") for where, newtons in zip(depth, force, strict=True))
    head = [("# Name", profile.name), ("# Date", profile.recorded_on.isoformat() if profile.recorded_on else NO_DATA)]
    head += [("# Latitude", _known(profile.latitude_deg)), ("# Longitude", _known(profile.longitude_deg))]
    write_file(path, _csv((*head, FORCE, *rows)))
    return Path(path)


def _header(pit: SnowPit) -> Iterable[Sequence[str]]:
    yield "# Location", pit.region or NO_DATA
    yield "# Site", pit.name
    yield "# PitID", pit.name
    yield "# Date/Local Time", pit.time or NO_DATA
    yield "# Latitude", _known(pit.latitude_deg)
    yield "# Longitude", _known(pit.longitude_deg)
    yield "# HS (cm)", _cm(pit.snow_height)


def _tables(pit: SnowPit, height: float) -> Iterable[tuple[str, Sequence[str], list[Sequence[str]]]]:
    yield (
        "density",
        DENSITY,
        [
            (*_limits(height, density.top, density.thickness), f"{density.snow_density:g}", NO_DATA, NO_DATA)
            for density in pit.densities
        ],
    )
    yield (
        "temperature",
        TEMPERATURE,
        [(_cm(height - temperature.depth), f"{temperature.temperature_C:g}") for temperature in pit.temperatures],
    )
    yield (
        "stratigraphy",
        STRATIGRAPHY,
        [
            (
                *_limits(height, layer.top, layer.thickness),
                NO_DATA if layer.grain_size is None else f"{layer.grain_size / MM:g}",
                layer.grain_form or NO_DATA,
                "/".join(filter(None, (layer.hardness, layer.hardness_bottom))) or NO_DATA,
                NO_DATA,
                layer.comment,
            )
            for layer in pit.layers
        ],
    )


def _limits(height: float, top: float, thickness: float | None) -> tuple[str, str]:
    return _cm(height - top), NO_DATA if thickness is None else _cm(height - top - thickness)


def _cm(length: float | None) -> str:
    return NO_DATA if length is None else f"{length / CM:.10g}"


def _known(value: float | None) -> str:
    return NO_DATA if value is None else f"{value:.10g}"


def _csv(rows: Iterable[Sequence[str]]) -> str:
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerows(rows)
    return stream.getvalue()
