"""Files as receivers write them, packed by hand after the published formats."""

import struct
from collections.abc import Sequence
from functools import reduce

FIT_EPOCH = 631065600  # 1989-12-31T00:00:00Z in Unix seconds
FIT_FIELDS = {  # number, size, base type, struct code, value that means invalid
    "timestamp": (253, 4, 0x86, "I", 0xFFFFFFFF),
    "position_lat": (0, 4, 0x85, "i", 0x7FFFFFFF),
    "position_long": (1, 4, 0x85, "i", 0x7FFFFFFF),
    "altitude": (2, 2, 0x84, "H", 0xFFFF),
    "distance": (5, 4, 0x86, "I", 0xFFFFFFFF),
    "speed": (6, 2, 0x84, "H", 0xFFFF),
    "gps_accuracy": (31, 1, 0x02, "B", 0xFF),
    "enhanced_speed": (73, 4, 0x86, "I", 0xFFFFFFFF),
    "enhanced_altitude": (78, 4, 0x86, "I", 0xFFFFFFFF),
}


def fit_checksum(data: bytes) -> int:
    """CRC-16 with polynomial 0xA001, bit by bit (the FIT protocol gives a table for it)."""
    value = 0
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = (value >> 1) ^ 0xA001 if value & 1 else value >> 1
    return value


TIMER_START, TIMER_STOP = 0, 4
"""Values of event_type."""


def fit_file(
    records: Sequence[dict[str, int]], *, then: Sequence[int] = (), more: Sequence[dict[str, int]] = ()
) -> bytes:
    """A FIT file with messages ``record``, messages ``event`` of the timer, and more records.

    Numbers are raw; absent ones are written as invalid.
    """
    definition = struct.pack("<BBBHB", 0x40, 0, 0, 20, len(FIT_FIELDS))
    definition += b"".join(struct.pack("BBB", *field[:3]) for field in FIT_FIELDS.values())
    event = struct.pack("<BBBHB", 0x41, 0, 0, 21, 2) + bytes([0, 1, 0, 1, 1, 0])  # event and event_type, enums
    body = definition + event + _fit_records(records)
    body += b"".join(bytes([1, 0, event_type]) for event_type in then) + _fit_records(more)
    head = struct.pack("<BBHI4s", 14, 0x20, 2132, len(body), b".FIT")
    whole = head + struct.pack("<H", fit_checksum(head)) + body
    return whole + struct.pack("<H", fit_checksum(whole))


def _fit_records(records: Sequence[dict[str, int]]) -> bytes:
    return b"".join(
        b"\x00"
        + b"".join(
            struct.pack("<" + code, record.get(name, invalid)) for name, (*_, code, invalid) in FIT_FIELDS.items()
        )
        for record in records
    )


def ubx_frame(message: bytes, payload: bytes) -> bytes:
    """Class and id of a message, and its payload, with sync bytes and the 8-bit Fletcher checksum."""
    body = message + struct.pack("<H", len(payload)) + payload
    one = other = 0
    for byte in body:
        one = (one + byte) % 256
        other = (other + one) % 256
    return b"\xb5\x62" + body + bytes([one, other])


def nav_pvt(
    *,
    second: int = 14,
    nano: int = 0,
    valid: int = 0b111,
    fix: int = 3,
    fix_ok: int = 1,
    lat: int = 472345678,
    lon: int = 111234567,
    height: int = 1_500_123,
    accuracies: tuple[int, int, int] = (50, 80, 30),
    velocity: tuple[int, int, int] = (3000, -4000, 1200),
    carrier: int = 0,
    time_of_week: int = 229_892_000,
    invalid_place: int = 0,
) -> bytes:
    """UBX-NAV-PVT at 2022-12-27T15:51 UTC; raw numbers: 1e-7 degrees, mm, mm/s north east down."""
    north, east, down = velocity
    horizontal, vertical, speed = accuracies
    payload = struct.pack("<IHBBBBB", time_of_week, 2022, 12, 27, 15, 51, second)
    payload += struct.pack("<BIiBBBB", valid, 25, nano, fix, fix_ok | carrier << 6, 0, 12)
    payload += struct.pack("<iiii", lon, lat, height, height - 48_000)
    payload += struct.pack("<II", horizontal, vertical)
    payload += struct.pack("<iiiii", north, east, down, round((north**2 + east**2) ** 0.5), 0)
    payload += struct.pack("<IIHHIihH", speed, 100, 150, invalid_place, 0, 0, 0, 0)
    assert len(payload) == 92
    return ubx_frame(b"\x01\x07", payload)


def nav_hpposllh(
    *,
    time_of_week: int = 229_892_000,
    lat: tuple[int, int] = (472345678, 45),
    lon: tuple[int, int] = (111234567, -67),
    height: tuple[int, int] = (1_500_123, -4),
    accuracies: tuple[int, int] = (123, 201),
    invalid: int = 0,
) -> bytes:
    """UBX-NAV-HPPOSLLH; raw numbers: 1e-7 degrees and 1e-9 to add, mm and 0.1 mm to add, accuracies in 0.1 mm."""
    payload = struct.pack("<BBBBI", 0, 0, 0, invalid, time_of_week)
    payload += struct.pack("<iiii", lon[0], lat[0], height[0], height[0] - 48_000)
    payload += struct.pack("<bbbbII", lon[1], lat[1], height[1], 0, *accuracies)
    assert len(payload) == 36
    return ubx_frame(b"\x01\x14", payload)


def nav_cov(
    place: Sequence[float],
    velocity: Sequence[float],
    *,
    time_of_week: int = 229_892_000,
    valid: tuple[int, int] = (1, 1),
) -> bytes:
    """UBX-NAV-COV; each NN, NE, ND, EE, ED, DD in m² and m²/s²."""
    payload = struct.pack("<IBBB9x", time_of_week, 0, *valid) + struct.pack("<12f", *place, *velocity)
    assert len(payload) == 64
    return ubx_frame(b"\x01\x36", payload)


def sentence(content: str) -> bytes:
    """An NMEA sentence with its checksum, the exclusive or of its characters."""
    checksum = reduce(lambda so_far, character: so_far ^ ord(character), content, 0)
    return f"${content}*{checksum:02X}\r\n".encode("ascii")
