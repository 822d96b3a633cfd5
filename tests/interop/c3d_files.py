"""A .c3d file packed by hand, after the C3D File Format User Guide (Motion Lab Systems, 2021)."""

import struct
from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

BLOCK = 512
INTEL, DEC, MIPS = 84, 85, 86


def c3d_bytes(
    points: npt.ArrayLike,
    texts: Mapping[str, Sequence[str]],
    *,
    rate: float = 50.0,
    first: int = 1,
    residual: npt.ArrayLike = 0.0,
    processor: int = INTEL,
    scale: float = -1.0,
) -> bytes:
    """A file without analogue values.

    Parameters
    ----------
    points
        (frames, points, 3) in the file's unit.
    texts
        Parameters of the group POINT by name, such as LABELS and UNITS.
    first
        Number of the first frame, from 1.
    residual
        Of each point in each frame; below 0 it was not seen.
    scale
        Below 0: floating-point numbers; above: the unit of whole ones.
    """
    order = ">" if processor == MIPS else "<"
    places = np.asarray(points, dtype=float)
    frames, count, _ = places.shape
    section = bytes([0, 0, 1, processor]) + struct.pack("bb", 5, -1) + b"POINT" + struct.pack(f"{order}hB", 3, 0)
    for name, words in texts.items():
        width = max(map(len, words), default=0)
        values = "".join(word.ljust(width) for word in words).encode("latin-1")
        body = struct.pack("bBBB", -1, 2, width, len(words)) + values + b"\0"
        section += struct.pack("bb", len(name), 1) + name.encode() + struct.pack(f"{order}h", 2 + len(body)) + body
    section += b"\0\0"
    section += b"\0" * (-len(section) % BLOCK)
    data_block = 2 + len(section) // BLOCK
    head = bytes([2, 0x50]) + struct.pack(f"{order}5H", count, 0, first, first + frames - 1, 10)
    head += (
        packed_floats([scale], processor) + struct.pack(f"{order}2H", data_block, 0) + packed_floats([rate], processor)
    )
    whole = np.concatenate([places, np.broadcast_to(residual, places.shape[:2])[..., None]], axis=2)
    if scale < 0.0:
        data = packed_floats(whole.ravel(), processor)
    else:
        whole[:, :, :3] /= scale
        data = np.rint(whole).astype(f"{order}i2").tobytes()
    return head.ljust(BLOCK, b"\0") + section + data


def packed_floats(values: npt.ArrayLike, processor: int) -> bytes:
    """Single precision of Intel, MIPS, or DEC: there the number times four with its halves exchanged."""
    numbers = np.asarray(values, dtype=float)
    if processor != DEC:
        return numbers.astype(">f4" if processor == MIPS else "<f4").tobytes()
    halves = (4.0 * numbers).astype("<f4").view("<u2").reshape(-1, 2)[:, ::-1]
    return np.ascontiguousarray(halves).tobytes()
