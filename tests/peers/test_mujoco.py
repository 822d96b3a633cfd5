"""The snow in MuJoCo: a rigid sledge goes as in our own steps, the better the shorter MuJoCo's are; skis as MJCF."""

import ctypes
import math
import os
import runpy
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from benchmarks.turns.clamped_modes import first_frequencies, first_frequency
from scipy.spatial.transform import Rotation

from skisnow import read_ski
from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow.contact import Runner, SnowContact, SnowField, c_header, c_library
from skisnow.dynamics import Body, Dynamics, Ended, FlexibleSki, StepControl
from skisnow.geometry.vectors import axes_of
from skisnow.interop.mujoco import SnowForces, ski_mjcf

mujoco: Any = pytest.importorskip("mujoco", reason="MuJoCo is not installed: pip install 'skisnow[peers]'")

COMPILER = next(filter(None, map(shutil.which, ("cc", "gcc", "clang"))), None)
EXAMPLE: Any = runpy.run_path(str(Path(__file__).parents[2] / "examples" / "sledge_in_mujoco.py"))


def our_sledge(step: float, duration: float) -> FloatArray:
    """Where it is after a time (m), by skisnow's own implicit steps on rigid skis."""
    mass, inertia = EXAMPLE["MASS"], np.zeros((6, 6))
    centre = np.array([0.0, 0.0, EXAMPLE["HEIGHT"]])
    lever = np.cross(centre, np.eye(3)).T  # centre ×
    inertia[:3, :3], inertia[:3, 3:], inertia[3:, :3] = mass * np.eye(3), -mass * lever, mass * lever
    inertia[3:, 3:] = np.diag(EXAMPLE["INERTIA"]) - mass * lever @ lever
    none, shape = np.zeros((0, 6)), Runner.of(EXAMPLE["SKI"])
    skis = tuple(
        FlexibleSki(
            boot=np.array([0.0, side * EXAMPLE["STANCE"] / 2.0, 0.0]), axes=axes_of(EXAMPLE["EDGE"], 0.0, 0.0),
            unknown=np.array([-1.0, -1.0]), mass=none, stiffness=none, coupling=none, damping=0.0,
        )
        for side in (1.0, -1.0)
    )  # fmt: skip
    body = Body(inertia=inertia, mass=mass, first_moment=mass * centre, skis=skis, gravity=EXAMPLE["GRAVITY"])
    runner = Runner.of(EXAMPLE["SKI"], nodes=[shape.tip, shape.tail])
    contact = SnowContact(SnowField(2e8, 5e5, 10.0, friction=0.01), [runner, runner])
    axes = Rotation.from_euler("ZYX", [EXAMPLE[name] for name in ("HEADING", "PITCH", "ROLL")]).as_matrix()
    dynamics = Dynamics(body, contact, np.array(EXAMPLE["START"]), axes, StepControl(first=step, fixed=True))
    dynamics.begin(np.array([EXAMPLE["SPEED"], 0.0, 0.0, 0.0, 0.0, 0.0]))
    assert dynamics.advance(duration) == Ended.REACHED
    return dynamics.position


def test_a_step_in_mujoco_has_the_forces_of_the_contact() -> None:
    model, data, snow = EXAMPLE["sledge"]()
    start = data.qvel.copy()
    with snow.installed():
        mujoco.mj_forward(model, data)
        first = snow.wrench.copy()
        mujoco.mj_forward(model, data)  # the same time: nothing is accepted again
        assert np.array_equal(snow.wrench, first)
        total = first[:, :3].sum(axis=0)
        assert data.qfrc_passive[:3] == pytest.approx(total, rel=1e-12)
        assert total[2] == pytest.approx(-EXAMPLE["MASS"] * EXAMPLE["GRAVITY"][2], rel=1e-3)
        for _ in range(20):
            mujoco.mj_step(model, data)
        moved = data.qpos.copy()
        mujoco.mj_resetData(model, data)
        data.qvel[:] = start
        for _ in range(20):
            mujoco.mj_step(model, data)
        assert np.array_equal(data.qpos, moved)  # and in fresh snow
    assert mujoco.get_mjcb_passive() is None


@pytest.mark.slow
def test_a_rigid_sledge_goes_as_ours_the_better_the_shorter_the_steps() -> None:
    """7 m: within 3 mm at 0.2 ms; between first and second order, since groove and grip begin with kinks."""
    ours = our_sledge(5e-5, EXAMPLE["DURATION"])
    coarse = our_sledge(1e-4, EXAMPLE["DURATION"])
    off = {step: float(np.linalg.norm(EXAMPLE["glide"](step) - ours)) for step in (1e-3, 5e-4, 2e-4)}
    assert np.linalg.norm(ours[:2]) > 7.0
    assert np.linalg.norm(coarse - ours) < 0.5 * off[2e-4]
    assert off[2e-4] < 3e-3
    orders = [math.log(off[a] / off[b]) / math.log(a / b) for a, b in ((1e-3, 5e-4), (5e-4, 2e-4))]
    assert min(orders) > 0.8
    assert max(orders) < 2.5


def frequencies(model: Any) -> tuple[float, float]:
    """First of bending and of torsion (Hz)."""
    data, mass = mujoco.MjData(model), np.zeros((model.nv, model.nv))
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, mass)
    stiffness = np.diag(np.asarray(model.jnt_stiffness).reshape(model.njnt, -1)[:, 0])
    bends = model.jnt_axis[:, 1] != 0.0
    return first_frequency(stiffness, mass, bends), first_frequency(stiffness, mass, ~bends)


@pytest.mark.parametrize("name", ["slalom", "giant-slalom", "carver"])
def test_a_ski_as_mjcf_swings_and_weighs_as_ours(name: str) -> None:
    """Twenty hinges, without the height of shovel and camber, which adds to the inertia of a segment that twists."""
    ski = read_ski(name)
    model = mujoco.MjModel.from_xml_string(ski_mjcf(ski, free=False))
    found = frequencies(model)
    model.body_pos[:, 2] = model.body_ipos[:, 2] = 0.0
    level = frequencies(model)
    for of_ours, with_height, without in zip(first_frequencies(ski), found, level, strict=True):
        assert without == pytest.approx(of_ours, rel=0.01)
        assert 0.9 * of_ours < with_height < 1.01 * of_ours
    along = np.linspace(ski.station[-1], ski.station[0], 20_001)
    assert model.body_mass.sum() == pytest.approx(np.trapezoid(ski.at(along).mass_per_length, along), rel=1e-6)


def test_impossible_input_is_rejected() -> None:
    model, _, snow = EXAMPLE["sledge"]()
    with pytest.raises(ParameterError, match=r"middle.*left, right"):
        SnowForces(model, snow.contact, ["left", "middle"])
    with pytest.raises(ParameterError, match="1 sites for 2 runners"):
        SnowForces(model, snow.contact, ["left"])
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    with pytest.raises(ParameterError, match="RK4"):
        SnowForces(model, snow.contact, ["left", "right"])


def test_the_scene_that_lies_there_is_the_example_s() -> None:
    scene = (Path(__file__).parents[2] / "examples" / "sledge_on_snow.xml").read_text(encoding="utf-8")
    assert scene == EXAMPLE["scene"]()


@pytest.mark.slow
def test_the_page_says_how_exact_it_is() -> None:
    page = (Path(__file__).parents[2] / "docs" / "how-to" / "other-programs.md").read_text(encoding="utf-8")
    ours = our_sledge(5e-5, EXAMPLE["DURATION"])
    for step, said in ((1e-3, "1 ms"), (5e-4, "0.5 ms"), (2e-4, "0.2 ms")):
        off = 1e3 * float(np.linalg.norm(EXAMPLE["glide"](step) - ours))
        assert f"| {said} | {off:.2f} mm |" in page


@pytest.mark.skipif(COMPILER is None, reason="no C compiler")
def test_the_callback_in_c_has_the_bits_of_python(tmp_path: Path) -> None:
    """MuJoCo calls it without Python in between; 5 % of a second."""
    folder = Path(str(mujoco.__file__)).parent
    library, headers, own = next(folder.glob("libmujoco.*")), folder / "include", c_library()
    source, made = Path(__file__).parents[2] / "examples" / "snow_in_mujoco.c", tmp_path / "snow_in_mujoco.so"
    command: list[str | Path] = [str(COMPILER), "-std=c99", "-O2", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC"]
    command += [source, "-I", headers, "-I", c_header().parent, own, library, "-lm", "-o", made]
    subprocess.run([*command, f"-Wl,-rpath,{own.parent}:{folder}"], check=True)
    native = ctypes.CDLL(os.fspath(made))
    model, data, _ = EXAMPLE["sledge"]()
    shape = Runner.of(EXAMPLE["SKI"])
    numbers = (
        (ctypes.c_double * len(each))(*each)
        for each in ([2e8, 5e5, 10.0, 0.01], shape.position, shape.half_width, shape.base_height)
    )
    sites = (ctypes.c_int * 2)(*(model.site(name).id for name in ("left", "right")))
    assert native.snow_open(*numbers, len(shape.position), sites, 2) == 0
    mujoco.set_mjcb_passive(native.snow_passive)
    try:
        mujoco.mj_step(model, data, 250)
    finally:
        mujoco.set_mjcb_passive(None)
        native.snow_close()
    assert np.array_equal(data.qpos[:3], EXAMPLE["glide"](EXAMPLE["STEP"], 0.05))
