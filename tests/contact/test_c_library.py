"""The contact from C: the example, compiled, gives the bits of Python; errors are codes and words."""

import ctypes
import math
import os
import shutil
import subprocess
from collections.abc import Callable, Iterator
from dataclasses import fields
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from skisnow._support.arrays import FloatArray
from skisnow.contact import Runner, SnowContact, SnowField, c_header, c_library
from skisnow.contact.snow_contact import SPACING

from .conftest import edged

ROOT = Path(__file__).parents[2]
STEPS = 10_000
COMPILER = next(filter(None, map(shutil.which, ("cc", "gcc", "clang"))), None)
SHAPE = np.array([0.8, 0.0, -0.8]), np.array([0.05, 0.033, 0.045]), np.array([0.01, 0.0, 0.004])
OK, BAD = 0, 1


@cache
def figure_of_eight() -> FloatArray:
    """24 m over itself: in the middle the ski crosses its own older track. Rows as the example reads them."""
    at = np.linspace(0.0, 2.0 * math.pi, STEPS)
    place = 4.0 * np.column_stack([np.sin(at), np.sin(at) * np.cos(at)])
    heading = np.unwrap(np.arctan2(np.cos(2.0 * at), np.cos(at)))
    angle = 0.6 * np.sin(at)  # left on one loop, right on the other
    height = 0.033 * np.abs(np.sin(angle)) - 2e-3
    dt = 1e-3
    velocity = np.zeros((STEPS, 6))
    velocity[:, :2], velocity[:, 5] = np.gradient(place, dt, axis=0), np.gradient(heading, dt)
    turned = np.array([edged(a, turn=h).ravel() for a, h in zip(angle, heading, strict=True)])
    return np.column_stack([place, height, turned, velocity, np.full(STEPS, dt)])


@pytest.mark.skipif(COMPILER is None, reason="no C compiler on this machine: the example is not compiled")
def test_the_example_gives_the_bits_of_python(tmp_path: Path) -> None:
    assert COMPILER is not None
    program, library = tmp_path / "contact_in_c", c_library()
    strict: list[str | Path] = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-I", c_header().parent]
    source = ROOT / "examples" / "contact_in_c.c"
    command = [COMPILER, *strict, source, library, f"-Wl,-rpath,{library.parent}", "-lm", "-o", program]
    subprocess.run(command, check=True)
    half = STEPS // 2
    rows = figure_of_eight()[: half + 200]
    rows.tofile(tmp_path / "motion")
    subprocess.run([program, tmp_path / "motion", tmp_path / "forces"], check=True)
    found = np.fromfile(tmp_path / "forces").reshape(-1, 6)

    expected = along(rows)
    assert np.array_equal(found, expected)
    # in the middle it meets its older track: less bears it than a ski that has only come from the last loop
    late = along(rows[half - 900 : half + 1])
    assert found[half, 2] / late[-1, 2] == pytest.approx(0.8916, abs=0.02)  # lines 5 and 2.5 mm apart, in Python


def along(rows: FloatArray) -> FloatArray:
    """What the same contact in Python feels."""
    contact = SnowContact(SnowField(2e8, 3e5, 10.0, 0.04), [Runner(*SHAPE)])
    wrenches = []
    for row in rows:
        pose = row[None, :3], row[3:12].reshape(1, 3, 3)
        wrenches.append(contact.force(*pose, row[None, 12:18], row[18]).wrench[0])
        contact.update(*pose, row[18])
    return np.array(wrenches)


class Snow(ctypes.Structure):
    _fields_ = (
        *((name, ctypes.c_double) for name in ("snow_hardness", "failure_shear_stress", "unloading_ratio")),
        ("friction_along_ski", ctypes.c_int),
        *((f"friction_{name}", ctypes.c_double) for name in ("constant", "linear", "square", "film", "film_speed")),
        *((name, ctypes.c_double) for name in ("stick_displacement", "shear_displacement")),
        ("compaction_resistance", ctypes.c_int),
        *((name, ctypes.c_double) for name in ("knot_area", "part_along", "part_across", "spacing")),
        ("surface", ctypes.POINTER(ctypes.c_double)),
        *((f"surface_{name}", ctypes.c_int) for name in ("nx", "ny")),
        *((f"surface_{name}", ctypes.c_double) for name in ("x0", "dx", "y0", "dy")),
    )


class CRunner(ctypes.Structure):
    _fields_ = (
        ("positions", ctypes.c_int),
        *((name, ctypes.POINTER(ctypes.c_double)) for name in ("position", "half_width", "base_height")),
        ("nodes", ctypes.c_int),
        ("node", ctypes.POINTER(ctypes.c_double)),
        *((name, ctypes.c_double) for name in ("base_bevel", "edge_width", "side_edge", "edge_radius")),
    )


def numbers(values: npt.ArrayLike) -> ctypes.Array[ctypes.c_double]:
    flat = np.ravel(np.asarray(values, float))
    return (ctypes.c_double * flat.size)(*flat)


def shape(**change: object) -> CRunner:
    given = {name: numbers(each) for name, each in zip(("position", "half_width", "base_height"), SHAPE, strict=True)}
    given |= {name: numbers(each) for name, each in change.items() if name in given}  # type: ignore[arg-type]
    out = CRunner(positions=3, nodes=0, node=None)
    for name, each in given.items():
        setattr(out, name, ctypes.cast(each, ctypes.POINTER(ctypes.c_double)))
    return out


Made = Callable[..., tuple[int, str, ctypes.c_void_p]]


@pytest.fixture(scope="module")
def library() -> ctypes.CDLL:
    found = ctypes.CDLL(os.fspath(c_library()))
    found.skisnow_contact_message.restype = ctypes.c_char_p
    return found


@pytest.fixture
def made(library: ctypes.CDLL) -> Iterator[Made]:
    """A contact of one runner, its code and what it says."""
    kept: list[ctypes.c_void_p] = []

    def make(
        runner: CRunner | None = None, *, beside: ctypes.c_void_p | None = None, **change: float
    ) -> tuple[int, str, ctypes.c_void_p]:
        snow, contact, words = Snow(), ctypes.c_void_p(), ctypes.create_string_buffer(200)
        library.skisnow_snow_defaults(ctypes.byref(snow))
        for name, value in {
            "snow_hardness": 2e8,
            "failure_shear_stress": 3e5,
            "unloading_ratio": 10.0,
            **change,
        }.items():
            setattr(snow, name, value)
        shapes = ctypes.byref(runner or shape())
        end = (shapes, 1, ctypes.byref(contact), words, ctypes.c_size_t(len(words)))
        if beside is None:
            code = library.skisnow_contact_new(ctypes.byref(snow), *end)
        else:
            code = library.skisnow_contact_join(beside, *end)
        kept.append(contact)
        return code, words.value.decode(), contact

    yield make
    for contact in kept:
        library.skisnow_contact_free(contact)


def test_what_c_takes_for_granted_is_what_python_does(library: ctypes.CDLL) -> None:
    snow = Snow()
    library.skisnow_snow_defaults(ctypes.byref(snow))
    usual = {each.name: each.default for each in fields(SnowField)}
    ways = ("shear_displacement", "stick_displacement", "part_along", "part_across")
    for name in (*ways, "compaction_resistance", "knot_area"):
        assert getattr(snow, name) == usual[name], name
    assert snow.spacing == SPACING
    assert (snow.friction_constant, bool(snow.surface)) == (usual["friction"], False)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"snow_hardness": 0.0}, "snow_hardness is 0; it must be above 0"),
        ({"unloading_ratio": 0.5}, "unloading_ratio is 0.5; it must be at least 1"),
        ({"spacing": math.nan}, "spacing is nan; it must be above 0"),
        ({"position": [0.0, 0.8, -0.8]}, "runner 0: positions must fall from tip to tail"),
        ({"half_width": [0.05, 0.0, 0.05]}, "runner 0: half_width is 0; it must be above 0"),
        ({"base_height": [0.0, math.inf, 0.0]}, "runner 0: base_height holds a number that is not finite, at place 1"),
    ],
)
def test_what_cannot_be_is_refused_in_words(made: Made, change: dict[str, float], words: str) -> None:
    of_runner = {name: value for name, value in change.items() if name in {"position", "half_width", "base_height"}}
    code, said, contact = made(shape(**of_runner), **{k: v for k, v in change.items() if k not in of_runner})
    assert (code, said, contact.value) == (BAD, words, None)


def test_a_contact_from_c_forces_tangents_states_and_neighbours(library: ctypes.CDLL, made: Made) -> None:
    _, _, contact = made()
    python = SnowContact(SnowField(2e8, 3e5, 10.0), [Runner(*SHAPE)])
    rows = figure_of_eight()[:40]
    wrench, stiffness, damping, state = (
        numbers(np.zeros(6)),
        numbers(np.zeros(36)),
        numbers(np.zeros(36)),
        ctypes.c_void_p(),
    )

    def forces(of: ctypes.c_void_p, row: FloatArray) -> FloatArray:
        pose = numbers(row[:3]), numbers(row[3:12]), numbers(row[12:18]), ctypes.c_double(row[18])
        assert library.skisnow_contact_force(of, *pose, None, None, wrench, None) == OK
        return np.array(wrench)

    def accept(of: ctypes.c_void_p, row: FloatArray) -> None:
        assert (
            library.skisnow_contact_update(of, numbers(row[:3]), numbers(row[3:12]), ctypes.c_double(row[18]), None)
            == OK
        )

    for row in rows[:20]:
        accept(contact, row)
        python.update(row[None, :3], row[3:12].reshape(1, 3, 3), row[18])
    assert library.skisnow_contact_save(contact, ctypes.byref(state)) == OK
    first = forces(contact, rows[30])
    pose = numbers(rows[30, :3]), numbers(rows[30, 3:12]), numbers(rows[30, 12:18]), ctypes.c_double(rows[30, 18])
    assert library.skisnow_contact_tangent(contact, *pose, None, None, stiffness, damping) == OK
    expected = python.tangent(rows[30:31, :3], rows[30, 3:12].reshape(1, 3, 3), rows[30:31, 12:18], rows[30, 18])
    assert np.array_equal(np.array(stiffness).reshape(6, 6), expected[0][0])
    assert np.array_equal(np.array(damping).reshape(6, 6), expected[1][0])
    for row in rows[20:30]:
        accept(contact, row)
    assert not np.array_equal(forces(contact, rows[30]), first)
    assert library.skisnow_contact_load(contact, state) == OK
    assert np.array_equal(forces(contact, rows[30]), first)
    _, _, other = made(beside=contact)
    assert library.skisnow_contact_load(other, state) == BAD
    assert library.skisnow_contact_message(other) == b"state is another contact's"
    library.skisnow_state_free(state)


def test_a_pose_that_cannot_be_changes_nothing(library: ctypes.CDLL, made: Made) -> None:
    _, _, contact = made()
    wrench, row = numbers(np.full(6, 7.0)), figure_of_eight()[0]
    good = [numbers(row[:3]), numbers(row[3:12]), numbers(row[12:18]), ctypes.c_double(row[18])]
    for place, bad, words in (
        (0, numbers([0.0, math.nan, 0.0]), b"position holds a number that is not finite, at place 1"),
        (1, numbers(1.1 * row[3:12]), b"rotation of runner 0 is none"),
        (1, None, b"rotation is NULL"),
        (3, ctypes.c_double(-1.0), b"dt is -1; it must be at least 0"),
    ):
        given = [*good[:place], bad, *good[place + 1 :]]
        assert library.skisnow_contact_force(contact, *given, None, None, wrench, None) == BAD
        assert library.skisnow_contact_message(contact) == words
    assert list(wrench) == [7.0] * 6
    assert library.skisnow_contact_force(None, *good, None, None, wrench, None) == BAD
    assert library.skisnow_contact_message(None) == b"contact is NULL"
