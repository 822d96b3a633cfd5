"""Points and parameters of a .c3d file, the format of motion capture."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError

Values: TypeAlias = Sequence[str] | Sequence[float]

BLOCK: Final = 512
_KEY: Final = 0x50
_DEC: Final = 85
_ORDERS: Final = {84: "<", _DEC: "<", 86: ">"}
"""Byte order by the processor's number: Intel, DEC (whose floating-point numbers differ), MIPS."""
_CODES: Final = {-1: "u1", 1: "u1", 2: "u2", 4: "f4"}
"""NumPy's codes by the type of a parameter: characters, bytes, whole numbers, floating-point numbers."""
_MOST_DIMENSIONS: Final = 7
_COORDINATES: Final = 4
_LAST_COUNTED: Final = 65_535
"""Number of the last frame that the header can state."""


@dataclass(frozen=True, slots=True)
class C3dContent:
    """Points and parameters read from the bytes of a C3D file.

    parameters: values by group and name, both in capitals.
    rate: frames a second (Hz).
    first_frame: number of the first one, counted from 0; the file counts from 1.
    points: (frames, points, 3) in the file's units, NaN where a point was not seen.
    """

    parameters: Mapping[tuple[str, str], Values]
    rate: float
    first_frame: int
    points: FloatArray


def c3d_content(data: bytes) -> C3dContent:
    """Parse the bytes of a C3D file.

    Raises ParameterError: the file is damaged, cut off, or not in this format; the message does not name it.
    """
    try:
        start = BLOCK * (data[0] - 1)
        if data[1] != _KEY or start < BLOCK:
            raise ParameterError("the file does not begin as a .c3d file does").tag("wrong_kind")
        processor = data[start + 3]
        if processor not in _ORDERS:
            raise ParameterError("the processor has the number {processor}; it must be 84, 85 or 86").tag(
                "out_of_range", processor=processor
            )
        parameters = dict(_read_parameters(data, start + 4, processor))
        order = _ORDERS[processor]
        count, analogs, first, last = struct.unpack_from(f"{order}4H", data, 2)
        (begin,) = struct.unpack_from(f"{order}H", data, 16)
        scale, rate = _floats(data[12:16] + data[20:24], processor).tolist()
        frames = last - first + 1
        if last == _LAST_COUNTED:  # a longer capture states its length in a parameter
            stated = parameters.get(("POINT", "FRAMES"), ())
            if len(stated) == 1 and isinstance(stated[0], float) and math.isfinite(stated[0]):
                frames = max(frames, int(stated[0]))
        points = _points(data, BLOCK * (begin - 1), (frames, count, analogs), scale, processor)
        return C3dContent(parameters, rate, max(first - 1, 0), points)
    except (struct.error, IndexError) as error:
        raise ParameterError("the file is cut off within its head").tag("damaged") from error


def _read_parameters(data: bytes, at: int, processor: int) -> Iterator[tuple[tuple[str, str], Values]]:
    """Values of the parameters of a C3D file, each by group and name; rejects a damaged entry."""
    groups: dict[int, str] = {}
    parameters: list[tuple[int, str, Values]] = []
    while True:
        length, group = struct.unpack_from("bb", data, at)
        if length == 0:
            break
        ends = at + 2 + abs(length)
        name = data[at + 2 : ends].decode("latin-1").upper()
        (distance,) = struct.unpack_from(f"{_ORDERS[processor]}h", data, ends)
        if group == 0 or distance < 0 or ends + distance > len(data):
            raise ParameterError("the entry {name!r} of the parameters is damaged").tag("damaged", name=name[:20])
        if group < 0:
            groups[-group] = name
        else:
            parameters.append((group, name, _values(data, name, ends + 2, processor)))
        if distance == 0:
            break
        at = ends + distance
    return (((groups.get(group, ""), name), values) for group, name, values in parameters)


def _values(data: bytes, name: str, at: int, processor: int) -> Values:
    """The values of a parameter; characters as texts along its first dimension."""
    kind, count = struct.unpack_from("bB", data, at)
    if kind not in _CODES or count > _MOST_DIMENSIONS:
        raise ParameterError("the parameter {name!r} is damaged (type {kind}, {count} dimensions)").tag(
            "damaged", name=name[:20], kind=kind, count=count
        )
    dimensions = struct.unpack_from(f"{count}B", data, at + 2)
    begin, code = at + 2 + count, _ORDERS[processor] + _CODES[kind]
    size = np.dtype(code).itemsize * math.prod(dimensions)
    content = data[begin : begin + size]
    if len(content) < size:
        raise ParameterError("the parameter {name!r} has {size} bytes, more than there are").tag(
            "damaged", name=name[:20], size=size
        )
    if kind == -1:
        width = dimensions[0] if dimensions else 1
        texts = content.decode("latin-1")
        return [texts[i : i + width].strip() for i in range(0, size, width or 1)]
    if kind == 4:
        return [float(number) for number in _floats(content, processor)]
    return [float(number) for number in np.frombuffer(content, code)]


def _floats(content: bytes, processor: int) -> FloatArray:
    """Floating-point numbers; those of DEC have their halves exchanged and are four times as large."""
    if processor != _DEC:
        return np.frombuffer(content, f"{_ORDERS[processor]}f4").astype(np.float64)
    halves = np.frombuffer(content, "<u2").reshape(-1, 2)[:, ::-1]
    return np.ascontiguousarray(halves).view("<f4").ravel().astype(np.float64) / 4.0


def _points(data: bytes, begin: int, counts: tuple[int, int, int], scale: float, processor: int) -> FloatArray:
    """Places of `counts` frames, points, analogue values; whole numbers are multiplied by a positive scale."""
    frames, count, analogs = counts
    bytes_each = 4 if scale < 0.0 else 2
    width = _COORDINATES * count + analogs
    size = bytes_each * width * frames
    if frames < 1 or begin < BLOCK or begin + size > len(data):
        raise ParameterError("{frames} frames of {width} numbers need {size} bytes, more than there are").tag(
            "damaged", frames=frames, width=width, size=size
        )
    content = data[begin : begin + size]
    with np.errstate(invalid="ignore"):  # a damaged number may be a signalling NaN
        if scale < 0.0:
            numbers = _floats(content, processor)
        else:
            numbers = np.frombuffer(content, f"{_ORDERS[processor]}i2").astype(np.float64)
    points = numbers.reshape(frames, width)[:, : _COORDINATES * count].reshape(frames, count, _COORDINATES)
    places = points[:, :, :3] if scale < 0.0 else scale * points[:, :, :3]
    return np.where(points[:, :, 3:] < 0.0, np.nan, places)
