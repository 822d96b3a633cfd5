"""Values at the ends of what a cell, a key or a binary field can hold."""

import struct
from random import Random
from typing import Final

NUMBERS: Final = (
    "0", "-0.0", "-1", "1", "2", "0.5", "1e308", "-1e308", "1e309", "-1e309", "1e300", "-1e300", "1e200", "1e155",
    "1e18", "1e-9", "5e-324", "1e-320", "1e-300", "nan", "inf", "-inf", "NaN", "-nan(ind)", "99999", "-273.16", "90",
    "180.1", "-9999", "65536", "2147483648", "-2147483649", "4294967296", "9223372036854775808",
    "-9223372036854775809", "999999999", "1" + "0" * 400, "9" * 5000, "0." + "0" * 400 + "1", "1e99999999999", "0x1F",
    "1_000", "1,5", "1.5.2", "--1", "+1", "1e", "１２", "٣", "−1", "1 000", "1d5", "010", "1E+2",
)  # fmt: skip
WORDS: Final = (
    "", " ", "x", "true", "null", "None", "NA", "=1+1", "@x", "'", '"', '""', '"x', "\\", "#", ";", ",", "\t", "\0",
    "ä", "☃", "\u2028", "\ufeff", "\ud7ff", "a" * 3000, "a." * 300, "../../x", "/dev/zero", "/dev/null", ".", "/",
    "x\x00y", "\x85", "\x1c", "%s", "{}", "left", "outcome", "[", "]", "{", "}", "<", ">", "&amp;", "&#0;",
    "0001-01-01", "9999-12-31T23:59:60Z", "2026-02-30", "10:00:00", "2026-02-03T09:10", "0001-01-01T00:00:00+14:00",
    "9999-12-31T23:59:59-14:00", "24:61:61", "1970-01-01T00:00:00",
)  # fmt: skip
WHOLE: Final = (
    0, 1, -1, 2, 127, 128, 255, 256, 32767, -32768, 65535, 2**24, 2**31 - 1, -(2**31), 2**32 - 1, 2**40, 2**63 - 1,
    -(2**63),
)  # fmt: skip
FLOATS: Final = tuple(map(float, (
    "0", "-0.0", "1", "-1", "nan", "inf", "-inf", "1e308", "-1e308", "5e-324", "1e-300", "1e38", "-1e38", "9.969e36",
    "1e155", "1e10", "-1e-9",
)))  # fmt: skip
FILL: Final = (b"\x00", b"\xff", b"\x7f", b"\x80", b"\x01")


def word(rng: Random) -> str:
    """A cell's text: a number more often than another word."""
    return rng.choice(NUMBERS) if rng.random() < 0.65 else rng.choice(WORDS)


def field(rng: Random, size: int) -> bytes:
    """A binary field of 1, 2, 4 or 8 bytes, of either byte order."""
    order = rng.choice("<>")
    if size in (4, 8) and rng.random() < 0.4:
        value = rng.choice(FLOATS)
        try:
            return struct.pack(order + ("f" if size == 4 else "d"), value)
        except OverflowError:
            return struct.pack(order + "f", float("inf"))
    whole = rng.choice(WHOLE) % (1 << 8 * size)
    return whole.to_bytes(size, "little" if order == "<" else "big")
