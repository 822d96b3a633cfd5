"""States of a contact as bytes: another contact goes on with the same bits; what is damaged or foreign is refused."""

import copy
import ctypes
import pickle
import struct
from functools import cache

import numpy as np
import pytest

from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow.contact import ContactState, Runner, SnowContact, SnowField
from skisnow.geometry.surfaces import Grid
from tests.coded import raises

from .conftest import straight
from .test_c_library import BAD, OK, SHAPE, Made, figure_of_eight, library, made, numbers

__all__ = ["library", "made"]
LEVEL = [np.eye(3)]
EVERY = 5  # of the rows of the figure of eight
BEFORE, FURTHER = 950, 200  # steps up to the state and from there on; the ski crosses its own track at 1,000
HEAD, FOOT = 32, 8


@cache
def eight() -> FloatArray:
    """5 ms apart: 24 m in 2,000 steps."""
    rows = figure_of_eight()[::EVERY].copy()
    rows[:, 12:18] /= EVERY
    rows[:, 18] *= EVERY
    return rows


def gone(contact: SnowContact, rows: FloatArray) -> FloatArray:
    """Forces along the rows, each of which is accepted."""
    found = []
    for row in rows:
        pose = row[None, :3], row[3:12].reshape(1, 3, 3)
        found.append(contact.force(*pose, row[None, 12:18], row[18]).wrench[0])
        contact.update(*pose, row[18])
    return np.array(found)


def fresh() -> SnowContact:
    return SnowContact(SnowField(2e8, 3e5, 10.0), [Runner(*SHAPE)])


def sealed(payload: bytes, *, version: int = 6, kind: int = 1) -> bytes:
    """A head, the payload, and FNV-1a of both."""
    body = b"skisnow\n" + struct.pack("<QQQ", version, kind, len(payload)) + payload
    digest = 14695981039346656037
    for byte in body:
        digest = (digest ^ byte) * 1099511628211 % 2**64
    return body + struct.pack("<Q", digest)


def small() -> SnowContact:
    """A short runner that has left a track."""
    contact = SnowContact(SnowField(2e8, 3e5, 10.0), [straight(length=0.1)])
    for step in range(25):
        contact.update([[0.02 * step, 0.0, -1e-3]], LEVEL, 1e-3)
    return contact


def test_another_contact_goes_on_with_the_same_bits_over_its_older_track() -> None:
    rows = eight()
    contact = fresh()
    gone(contact, rows[:BEFORE])
    data = pickle.dumps(contact.state())
    expected = gone(contact, rows[BEFORE : BEFORE + FURTHER])

    other = fresh()
    gone(other, rows[1500:1600])  # what it has met is forgotten
    other.restore(pickle.loads(data))
    assert np.array_equal(gone(other, rows[BEFORE : BEFORE + FURTHER]), expected)
    assert np.array_equal(other.tracks(), contact.tracks())
    assert other.groove_energy == contact.groove_energy
    # the older track is there: without it the crossing has other forces
    alone = fresh()
    gone(alone, rows[BEFORE - 50 : BEFORE])
    assert not np.array_equal(gone(alone, rows[BEFORE : BEFORE + FURTHER])[50], expected[50])


def test_delayed_snow_that_varies_over_a_grid_and_two_contacts_in_it() -> None:
    """Written at one moment, and read into contacts that were made in the same order."""
    axis = np.linspace(-5.0, 5.0, 11)
    height = Grid(axis, axis, np.fromfunction(lambda i, j: 1e-3 * (i + j), (11, 11)))

    def both() -> list[SnowContact]:
        snow = SnowField(2e8, 3e5, 10.0, surface=height, delayed_share=0.5, retardation_time=0.05)
        return [SnowContact(snow, [Runner(*SHAPE)]) for _ in range(2)]

    rows = eight()[::2]
    pair, others = both(), both()
    for place, contact in enumerate(pair):
        gone(contact, rows[200 * place : 200 * place + 60])
    data = [contact.state().to_bytes() for contact in pair]
    for contact, each in zip(others, data, strict=True):
        contact.restore(ContactState.from_bytes(each))
    for place in range(2):
        ahead = rows[200 * place + 60 : 200 * place + 100]
        assert np.array_equal(gone(others[place], ahead), gone(pair[place], ahead))
    assert [each.delayed_energy for each in others] == [each.delayed_energy for each in pair]
    assert pair[0].delayed_energy > 0.0


def test_an_earlier_state_becomes_bytes_until_its_tracks_are_gone() -> None:
    rows = eight()
    contact = fresh()
    gone(contact, rows[:300])
    early, again = contact.state(), contact.state()
    expected = gone(contact, rows[300:400])
    late = contact.state()
    for each in (early, copy.deepcopy(again)):
        contact.restore(each)
        assert np.array_equal(gone(contact, rows[300:400]), expected)
    for forgotten in (late, early):  # what came from bytes has brought tracks of its own
        with raises(ParameterError, "invalid_state"):
            forgotten.to_bytes()
        with raises(ParameterError, "invalid"):
            contact.restore(forgotten)


def test_damaged_bytes_are_refused_and_nothing_changes() -> None:
    contact = small()
    data = contact.state().to_bytes()
    contact.update([[0.52, 0.0, -2e-3]], LEVEL, 1e-3)
    before = contact.tracks()
    generator = np.random.default_rng(7)
    damaged = [data[:size] for size in (0, 7, 8, HEAD, HEAD + FOOT, *generator.integers(0, len(data), 50))]
    damaged += [data + b"\0", data[:-1] + bytes([data[-1] ^ 1])]
    for _ in range(200):
        flipped = bytearray(data)
        for place in generator.integers(0, len(data), generator.integers(1, 4)):
            flipped[place] ^= 1 << int(generator.integers(0, 8))
        damaged.append(bytes(flipped))
    for each in damaged:
        if each == data:
            continue
        with raises(ParameterError, "invalid_state"):
            ContactState.from_bytes(each)
        with pytest.raises(ValueError, match="no state"):
            contact.compiled.take_bytes(each)
    assert np.array_equal(contact.tracks(), before)


def test_bytes_that_are_sealed_but_wrong_are_refused_or_lead_nowhere_bad() -> None:
    """Whatever a word is replaced by, no read goes beyond its borders, and what is accepted can be gone on with."""
    contact, generator = small(), np.random.default_rng(11)
    payload = contact.state().to_bytes()[HEAD:-FOOT]
    numbers = struct.unpack("<5Q", struct.pack("<5d", 1e9, -1e-3, np.nan, np.inf, 1e300))
    words = (0, 1, 2**62, 2**63, 2**64 - 1, *numbers)
    refused = 0
    for place in generator.choice(len(payload) // 8, 80, replace=False):
        word = struct.pack("<Q", words[int(generator.integers(len(words)))])
        other = small()
        try:
            other.restore(ContactState.from_bytes(sealed(payload[: 8 * place] + word + payload[8 * place + 8 :])))
        except ParameterError:
            refused += 1
            assert np.array_equal(other.tracks(), contact.tracks())
        other.force([[0.5, 0.0, -2e-3]], LEVEL, np.zeros((1, 6)), 1e-3)
        other.update([[0.5, 0.0, -2e-3]], LEVEL, 1e-3)
    assert refused > 20
    for cut in range(0, len(payload), 40):
        with raises(ParameterError, "invalid"):
            contact.restore(ContactState.from_bytes(sealed(payload[:cut])))


def test_bytes_of_another_are_refused_in_words() -> None:
    data = small().state().to_bytes()
    payload = data[HEAD:-FOOT]
    assert sealed(payload) == data
    with raises(ParameterError, "invalid_state"):
        ContactState.from_bytes(sealed(payload, version=3))
    with raises(ParameterError, "invalid_state"):
        ContactState.from_bytes(sealed(payload, kind=2))
    with raises(ParameterError, "invalid"):
        small().restore(ContactState.from_bytes(sealed(payload + bytes(8))))
    for other in (
        SnowContact(SnowField(2.1e8, 3e5, 10.0), [straight(length=0.1)]),
        SnowContact(SnowField(2e8, 3e5, 10.0), [straight(length=0.101)]),
        SnowContact(SnowField(2e8, 3e5, 10.0), [straight(length=0.1)], spacing=0.01),
        SnowContact(SnowField(2e8, 3e5, 10.0), [straight(length=0.1)] * 2),
    ):
        with raises(ParameterError, "invalid"):
            other.restore(ContactState.from_bytes(data))


def test_python_writes_what_c_reads_and_c_what_python_reads(library: ctypes.CDLL, made: Made) -> None:
    rows = eight()
    contact = fresh()
    gone(contact, rows[:40])
    data = contact.state().to_bytes()
    *_, in_c = made()
    assert library.skisnow_contact_state_read(in_c, data, ctypes.c_size_t(len(data))) == OK
    size = ctypes.c_size_t()
    assert library.skisnow_contact_state_size(in_c, ctypes.byref(size)) == OK
    assert size.value == len(data)
    room = ctypes.create_string_buffer(len(data))
    assert library.skisnow_contact_state_write(in_c, room, ctypes.c_size_t(len(data) - 1)) == BAD
    assert room.raw == bytes(len(data))
    assert library.skisnow_contact_state_write(in_c, room, size) == OK
    assert room.raw == data
    wrench, row = numbers(np.zeros(6)), rows[40]
    pose = numbers(row[:3]), numbers(row[3:12]), numbers(row[12:18]), ctypes.c_double(row[18])
    assert library.skisnow_contact_force(in_c, *pose, None, None, wrench, None) == OK
    assert np.array_equal(np.array(wrench), gone(contact, rows[40:41])[0])
    assert library.skisnow_contact_state_read(in_c, data[:-1], ctypes.c_size_t(len(data) - 1)) == BAD
    said = library.skisnow_contact_message(in_c)
    assert said == b"the bytes are no state: they are damaged or not complete"
