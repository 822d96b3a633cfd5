"""A ski as MJCF: rigid segments on hinges with its compliance in bending and torsion, or a rigid one to look at."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from typing import Any, Final
from xml.sax.saxutils import quoteattr

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError, require_range
from .._support.staging import require_ending, write_file
from ..contact import SnowContact
from ..ski import Ski
from ..ski.beam import CLAMP_LENGTH

SEGMENTS: Final = 20
"""Number of segments of a ski, without the part that the binding holds."""
THICKNESS: Final = 0.01
"""Thickness of the boxes that are drawn (m); nothing is computed with it."""
POINTS: Final = 400
"""Number of points of the integrals along a segment."""


def ski_mjcf(ski: Ski, *, segments: int = SEGMENTS, free: bool = True) -> str:
    """MJCF text (MuJoCo's format) of a ski as a chain of rigid segments with elastic hinges.

    ski: its shape, EI, GJ and mass are taken.
    segments: number of segments of the chains before and behind the binding together, ≥ 4.
    free: whether the middle is free in space, or fixed to it.
    Raises ParameterError: a number is out of its range.

    Axes: x ahead, y left, z up; the site ``boot`` is on the base. Each hinge has the compliance of the ski between
    the middles of the segments that it joins. The free shape (camber, shovel) has no stress. Boxes are to be seen
    alone: they collide with nothing.
    """
    require_range("segments", segments, 4)
    length = float(ski.station[0] - ski.station[-1])
    half, (tip, tail) = CLAMP_LENGTH / 2.0, (float(ski.station[0]), float(ski.station[-1]))
    front = round(segments * (tip - half) / (length - CLAMP_LENGTH))
    chains = (
        _half_ski_xml(ski, "front", np.linspace(half, tip, front + 1)),
        _half_ski_xml(ski, "rear", np.linspace(-half, tail, segments - front + 1)),
    )
    return f"""<mujoco model={quoteattr(ski.name)}>
 <compiler angle="radian" autolimits="true"/>
 <option integrator="implicitfast"/>
 <worldbody>
  <light pos="0 0 3"/>
  <body name="ski" pos="0 0 0.5">
   {"<freejoint/>" if free else ""}
   <site name="boot" size="0.01"/>
   {_inertial(ski, -half, half)}
   {_box_xml(ski, -half, half)}
   {"".join(chains)}
  </body>
 </worldbody>
</mujoco>
"""


def write_ski_mjcf(ski: Ski, path: str | Path, *, segments: int = SEGMENTS) -> Path:
    """Write `ski_mjcf` of a ski as a file that MuJoCo opens.

    Raises ParameterError: the name does not end in .xml, or the number is out of its range.
    Raises OutputError: the place cannot be written.
    """
    require_ending(path, ".xml")
    write_file(path, ski_mjcf(ski, segments=segments))
    return Path(path)


def rigid_ski_geoms(ski: Ski, *, segments: int = SEGMENTS) -> str:
    """MJCF boxes of an unbent ski around its boot, without mass, to show it on a body of the user's model."""
    places = np.linspace(float(ski.station[0]), float(ski.station[-1]), segments + 1)
    return "\n".join(_box_xml(ski, near, far) for near, far in pairwise(places.tolist()))


def _half_ski_xml(ski: Ski, name: str, end: FloatArray) -> str:
    """XML of nested bodies, from the binding outwards, between the stations `end` (m) of one ski half."""
    middle = (end[:-1] + end[1:]) / 2.0
    opened, before = "", (0.0, 0.0)
    for i, (near, far) in enumerate(pairwise(end.tolist())):
        inner = end[0] if i == 0 else middle[i - 1]
        at = ski.at(_points(inner, middle[i]))
        place = near, float(ski.at(near).base_height)
        opened += f'<body name="{name} {i}" pos="{place[0] - before[0]!r} 0 {place[1] - before[1]!r}">\n'
        before = place
        for what, axis, along in (("bend", "0 1 0", at.bending_stiffness), ("twist", "1 0 0", at.torsional_stiffness)):
            stiffness = 1.0 / (abs(float(middle[i] - inner)) * float(np.mean(1.0 / along)))
            opened += f'<joint name="{name} {i} {what}" axis="{axis}" stiffness="{stiffness!r}" damping="0.0"/>\n'
        opened += _inertial(ski, near, far, place) + _box_xml(ski, near, far, place)
    return opened + "</body>" * len(middle)


def _inertial(ski: Ski, near: float, far: float, origin: tuple[float, float] = (0.0, 0.0)) -> str:
    """XML of mass, centre and inertia of the ski between two stations, relative to `origin`: (x, z) (m)."""
    place = _points(near, far)
    at = ski.at(place)
    mass = at.mass_per_length * abs(far - near) / POINTS
    whole = float(mass.sum())
    middle, height = float(mass @ place / whole), float(mass @ at.base_height / whole)
    roll = float(mass @ at.width**2 / 12.0)
    pitch = float(mass @ (place - middle) ** 2)
    return (
        f'<inertial pos="{middle - origin[0]!r} 0 {height - origin[1]!r}" mass="{whole!r}" '
        f'diaginertia="{roll!r} {pitch!r} {pitch + roll!r}"/>\n'
    )


def _box_xml(ski: Ski, near: float, far: float, origin: tuple[float, float] = (0.0, 0.0)) -> str:
    """MuJoCo geometry of a box that follows the ski's base from `near` to `far` (m); only to be shown."""
    low, high = sorted((near, far))
    middle = (low + high) / 2.0
    at = ski.at(np.array([low, middle, high]))
    heights, width = at.base_height, float(at.width[1])
    pitch = -float(np.arctan2(heights[2] - heights[0], high - low))
    up = float(heights[0] + heights[2]) / 2.0 + THICKNESS / 2.0 - origin[1]
    return (
        f'<geom type="box" contype="0" conaffinity="0" mass="0" pos="{middle - origin[0]!r} 0 {up!r}" '
        f'euler="0 {pitch!r} 0" size="{(high - low) / 2.0!r} {width / 2.0!r} {THICKNESS / 2.0!r}" '
        'rgba="0.75 0.2 0.15 1"/>\n'
    )


def _points(near: float, far: float) -> FloatArray:
    """Midpoints (m) of equal pieces between two stations."""
    return np.asarray(near + (np.arange(POINTS) + 0.5) / POINTS * (far - near))


class SnowForces:
    """Forces of the snow on sites of a MuJoCo model, as its global callback ``mjcb_passive``.

    model: an ``mujoco.MjModel`` whose world axes are those of the slope.
    contact: its runners are rigid. The callback takes it over.
    sites: name of a site for each runner: at its boot, x ahead, y left across the base, z off the base.
    Raises ParameterError: MuJoCo is not installed, there is not one site for each runner, a site is not in the model, a
        runner bends, or the model's integrator evaluates forces between steps (RK4).

    Explicit: the force at the beginning of a step acts over the whole step, and MuJoCo's Euler method applies it to the
    new velocity at once. docs/how-to/other-programs.md gives the largest step. Other models of the process are not
    affected. A reset of the time restores the snow to the state at construction.
    """

    def __init__(self, model: Any, contact: SnowContact, sites: Sequence[str]) -> None:
        try:
            import mujoco
        except ImportError:
            raise ParameterError("MuJoCo is not installed: pip install mujoco").tag("wrong_kind") from None
        self._engine: Any = mujoco
        if len(sites) != len(contact.runners):
            raise ParameterError("SnowForces: {n_sites} sites for {n_runners} runners; each needs one").tag(
                "wrong_shape", n_sites=len(sites), n_runners=len(contact.runners)
            )
        if any(runner.nodes is not None for runner in contact.runners):
            raise ParameterError("SnowForces: a site has no beam; its runner has to be rigid").tag("no_data")
        if model.opt.integrator == mujoco.mjtIntegrator.mjINT_RK4:
            raise ParameterError("SnowForces: RK4 requires forces at times that are not accepted; use Euler").tag(
                "not_supported"
            )
        self._sites = [int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, name)) for name in sites]
        if -1 in self._sites:
            known = ", ".join(model.site(i).name for i in range(model.nsite))
            raise ParameterError("SnowForces: unknown site {name}; the sites are {known}").tag(
                "unknown_name", name=sites[self._sites.index(-1)], known=known or "-"
            )
        self.model, self.contact = model, contact
        self._fresh = contact.state()
        self._accepted: float | None = None
        self.wrench: FloatArray = np.zeros((len(sites), 6))
        """Force (N) and moment (N m) of the snow about each site, in the world's axes, at the last call."""

    def __call__(self, model: Any, data: Any) -> None:
        """Add the forces at the present pose to the passive ones; a pose at a new time enters the snow's history."""
        if model is not self.model:
            return
        if self._accepted is not None and data.time < self._accepted:
            self.contact.restore(self._fresh)
            self._accepted = None
        since = 0.0 if self._accepted is None else data.time - self._accepted
        position = data.site_xpos[self._sites].copy()
        rotation = data.site_xmat[self._sites].reshape(-1, 3, 3).copy()
        velocities = np.empty((len(self._sites), 6))
        for site, velocity in zip(self._sites, velocities, strict=True):  # MuJoCo gives the angular velocity first
            self._engine.mj_objectVelocity(model, data, self._engine.mjtObj.mjOBJ_SITE, site, velocity, 0)
        self.wrench = self.contact.force(position, rotation, np.roll(velocities, 3, axis=1), since).wrench
        if self._accepted is None or since > 0.0:
            self.contact.update(position, rotation, since)
            self._accepted = float(data.time)
        for site, at, wrench in zip(self._sites, position, self.wrench, strict=True):
            body = model.site_bodyid[site]
            self._engine.mj_applyFT(model, data, wrench[:3], wrench[3:], at, body, data.qfrc_passive)

    @contextmanager
    def installed(self) -> Iterator[SnowForces]:
        """MuJoCo calls this object within the block; afterwards the previous callback is installed again."""
        before = self._engine.get_mjcb_passive()
        self._engine.set_mjcb_passive(self)
        try:
            yield self
        finally:
            self._engine.set_mjcb_passive(before)
