"""A rigid sledge in MuJoCo on skisnow's snow: MuJoCo moves it, the contact says what the snow does to its skis.

    python examples/sledge_in_mujoco.py [--view] [--scene FILE]

MuJoCo calls the contact as its passive force, once a step. Printed is where the sledge is after a second and how long
it took; --view opens MuJoCo's viewer and lets it run, --scene writes the scene, which MuJoCo opens without the snow:
python -m mujoco.viewer --mjcf=FILE. It needs MuJoCo (pip install mujoco).
"""

from __future__ import annotations

import argparse
import math
import time
from pathlib import Path
from typing import Any

import numpy as np

from skisnow import read_ski
from skisnow.contact import Runner, SnowContact, SnowField
from skisnow.interop.mujoco import SnowForces, rigid_ski_geoms

SKI = read_ski("giant-slalom")
MASS, INERTIA, HEIGHT, STANCE = 88.0, (3.0, 6.0, 8.0), 0.2, 0.5
SLOPE, EDGE, HEADING, SPEED = math.radians(10.0), math.radians(30.0), math.radians(-30.0), 7.0
STEP, DURATION = 2e-4, 1.0
GRAVITY = 9.81 * np.array([math.sin(SLOPE), 0.0, -math.cos(SLOPE)])  # x down the slope, z out of the snow
START, PITCH, ROLL = (0.0, 0.0, 0.027189309), -2.0784154e-3, 4.708869e-4  # of the boots' middle: at rest in this snow


def scene(step: float = STEP) -> str:
    """The sledge, its skis with a site at each boot, and a plane that is only seen."""
    skis = "\n".join(
        f'<body name="{side} ski" pos="0 {y} 0" euler="0 0 {-EDGE}"><site name="{side}" size="0.01"/>'
        f"{rigid_ski_geoms(SKI)}</body>"
        for side, y in (("left", STANCE / 2.0), ("right", -STANCE / 2.0))
    )
    return f"""<mujoco model="sledge on snow">
<compiler angle="radian" eulerseq="zyx"/>
<option timestep="{step}" gravity="{GRAVITY[0]} {GRAVITY[1]} {GRAVITY[2]}"/>
<visual><headlight ambient="0.3 0.3 0.3" diffuse="0.3 0.3 0.3" specular="0 0 0"/></visual>
<asset><texture name="grid" type="2d" builtin="checker" rgb1="0.8 0.84 0.9" rgb2="0.72 0.77 0.85"
width="300" height="300"/>
<material name="snow" texture="grid" texrepeat="1 1" texuniform="true"/></asset>
<worldbody><light dir="-0.4 0.3 -1" directional="true" castshadow="false" diffuse="0.5 0.5 0.5" specular="0 0 0"/>
<geom name="snow" type="plane" size="100 100 1" material="snow" contype="0" conaffinity="0"/>
<body name="sledge" pos="{START[0]} {START[1]} {START[2]}" euler="{HEADING} {PITCH} {ROLL}"><freejoint/>
<camera name="behind" pos="-3 0 1.5" xyaxes="0 -1 0 0.45 0 0.9" mode="track"/>
<inertial pos="0 0 {HEIGHT}" mass="{MASS}" diaginertia="{INERTIA[0]} {INERTIA[1]} {INERTIA[2]}"/>
<geom type="box" contype="0" conaffinity="0" mass="0" pos="0 0 0.15" size="0.3 0.25 0.05" rgba="0.2 0.35 0.6 1"/>
{skis}
</body></worldbody></mujoco>
"""


def sledge(step: float = STEP) -> tuple[Any, Any, SnowForces]:
    """MuJoCo's model and data at the start, and the snow's forces on it."""
    import mujoco

    engine: Any = mujoco
    model = engine.MjModel.from_xml_string(scene(step))
    data = engine.MjData(model)
    engine.mj_kinematics(model, data)
    data.qvel[:3] = SPEED * data.body("sledge").xmat[::3]  # ahead
    runner = Runner.of(SKI)
    contact = SnowContact(SnowField(2e8, 5e5, 10.0, friction=0.01), [runner, runner])
    return model, data, SnowForces(model, contact, ["left", "right"])


def glide(step: float = STEP, duration: float = DURATION) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Where the boots' middle is after a time (m)."""
    import mujoco

    engine: Any = mujoco
    model, data, snow = sledge(step)
    with snow.installed():
        for _ in range(round(duration / step)):
            engine.mj_step(model, data)
    return np.array(data.qpos[:3])


def view() -> None:
    """Let it run in MuJoCo's viewer, as fast as time goes by."""
    import mujoco
    import mujoco.viewer

    engine: Any = mujoco
    model, data, snow = sledge()
    with snow.installed(), engine.viewer.launch_passive(model, data) as window:
        while window.is_running():
            begun = time.perf_counter()
            for _ in range(round(0.02 / STEP)):
                engine.mj_step(model, data)
            window.sync()
            time.sleep(max(0.0, 0.02 - (time.perf_counter() - begun)))


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--view", action="store_true")
    parser.add_argument("--scene", type=Path)
    given = parser.parse_args()
    if given.scene is not None:
        given.scene.write_text(scene(), encoding="utf-8")
    elif given.view:
        view()
    else:
        start = time.perf_counter()
        x, y, z = glide()
        print(f"after {DURATION:g} s at ({x:.3f}, {y:.3f}, {z:.3f}) m, in {time.perf_counter() - start:.1f} s")
