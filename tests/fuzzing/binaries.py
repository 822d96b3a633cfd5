"""Mutations of binary files, and checksums that are right again afterwards."""

from random import Random
from typing import Final

from tests.track.readers.receivers import fit_checksum, sentence

from . import values
from .texts import Mutation

_SYNC: Final = b"\xb5\x62"


def bits(rng: Random, data: bytes) -> bytes:
    """Some bits flip."""
    changed = bytearray(data)
    for _ in range(rng.randrange(1, 6)):
        if changed:
            changed[rng.randrange(len(changed))] ^= 1 << rng.randrange(8)
    return bytes(changed)


def field(rng: Random, data: bytes) -> bytes:
    """A field becomes an extreme one; early ones, where heads are, more often."""
    size = rng.choice((1, 2, 4, 8))
    reach = len(data) if rng.random() < 0.5 else min(len(data), 600)
    at = rng.randrange(reach + 1)
    at -= at % size if rng.random() < 0.7 else 0
    return data[:at] + values.field(rng, size) + data[at + size :]


def block(rng: Random, data: bytes) -> bytes:
    """A block is cut out, doubled, moved, filled, or all behind it is missing."""
    begin = rng.randrange(len(data) + 1)
    end = min(len(data), begin + rng.choice((1, 2, 4, 16, 64, 512, 4096)))
    part, rest = data[begin:end], data[:begin] + data[end:]
    how = rng.randrange(6)
    if how == 0:
        return rest
    if how == 1:
        return data[:begin] + part * rng.choice((2, 3, 200)) + data[end:]
    if how == 2:
        at = rng.randrange(len(rest) + 1)
        return rest[:at] + part + rest[at:]
    if how == 3:
        return data[:begin] + rng.choice(values.FILL) * (end - begin) + data[end:]
    if how == 4:
        return data[:begin] + rng.randbytes(end - begin) + data[end:]
    return data[:begin]


BINARY: Final[tuple[Mutation, ...]] = (field, field, field, bits, block)


def sealed_fit(data: bytes) -> bytes:
    """A FIT file with right lengths and checksums."""
    if len(data) <= 16:
        return data
    body = data[14:-2]
    head = data[:4] + len(body).to_bytes(4, "little") + b".FIT"
    whole = head + fit_checksum(head).to_bytes(2, "little") + body
    return whole + fit_checksum(whole).to_bytes(2, "little")


def sealed_nmea(data: bytes) -> bytes:
    """Sentences with right checksums."""
    lines = [line.strip().lstrip(b"$").split(b"*")[0] for line in data.split(b"\n")]
    return b"".join(sentence(line.decode("ascii")) if line.isascii() else line for line in lines)


def sealed_ubx(data: bytes) -> bytes:
    """Frames with right checksums, as far as their lengths lead from one to the next."""
    whole, at = bytearray(data), 0
    while (at := whole.find(_SYNC, at)) >= 0 and at + 6 <= len(whole):
        end = at + 6 + int.from_bytes(whole[at + 4 : at + 6], "little")
        if end + 2 > len(whole):
            break
        a = b = 0
        for byte in whole[at + 2 : end]:
            a = (a + byte) & 255
            b = (b + a) & 255
        whole[end : end + 2] = bytes((a, b))
        at = end + 2
    return bytes(whole)
