"""The snow as MuJoCo's passive force: its callback asks the contact, and accepts a pose for each new time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ..._support.errors import ParameterError
from ...contact import SnowContact

FloatArray: TypeAlias = npt.NDArray[np.float64]


class SnowForces:
    """Forces of the snow on sites of a MuJoCo model, as its global callback ``mjcb_passive``.

    Parameters
    ----------
    model
        An ``mujoco.MjModel`` whose world's axes are those of the slope.
    contact
        Its runners are rigid. The callback takes it over.
    sites
        Name of a site for each runner: at its boot, x ahead, y left across the base, z off the base.

    Raises
    ------
    ParameterError
        MuJoCo is not installed, there is not one site for each runner, a site is not in the model, a runner bends, or
        the model's integrator evaluates forces between steps (RK4).

    Notes
    -----
    Explicit: the force at a step's beginning acts over the step, which MuJoCo's Euler takes to the new velocity at
    once. How long a step may be says docs/how-to/fmu.md. Other models of the process are left alone. Where the time
    goes back (a reset), the snow is as it was when this was made.
    """

    def __init__(self, model: Any, contact: SnowContact, sites: Sequence[str]) -> None:
        try:
            import mujoco
        except ImportError:
            raise ParameterError("MuJoCo is not installed: pip install mujoco") from None
        self._engine: Any = mujoco
        if len(sites) != len(contact.runners):
            raise ParameterError(f"SnowForces: {len(sites)} sites for {len(contact.runners)} runners; each needs one")
        if any(runner.nodes is not None for runner in contact.runners):
            raise ParameterError("SnowForces: a site has no beam; its runner has to be rigid")
        if model.opt.integrator == mujoco.mjtIntegrator.mjINT_RK4:
            raise ParameterError("SnowForces: RK4 asks for forces at times that are not accepted; take Euler")
        self._sites = [self._site(model, name) for name in sites]
        self.model, self.contact = model, contact
        self._fresh, self._accepted = contact.state(), None
        self.wrench: FloatArray = np.zeros((len(sites), 6))
        """Force (N) and moment (N m) of the snow about each site, in the world's axes, at the last call."""

    _accepted: float | None

    def _site(self, model: Any, name: str) -> int:
        found = int(self._engine.mj_name2id(model, self._engine.mjtObj.mjOBJ_SITE, name))
        if found < 0:
            names = ", ".join(model.site(i).name for i in range(model.nsite))
            raise ParameterError(f"SnowForces: there is no site {name}; there are {names or 'none'}")
        return found

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
        self.wrench = self.contact.force(position, rotation, self._velocities(data), since).wrench
        if self._accepted is None or since > 0.0:
            self.contact.update(position, rotation, since)
            self._accepted = float(data.time)
        for site, at, wrench in zip(self._sites, position, self.wrench, strict=True):
            body = model.site_bodyid[site]
            self._engine.mj_applyFT(model, data, wrench[:3], wrench[3:], at, body, data.qfrc_passive)

    def _velocities(self, data: Any) -> FloatArray:
        """Of the sites and about them, in the world's axes; MuJoCo gives the angular one first."""
        out, found = np.empty((len(self._sites), 6)), np.empty(6)
        for k, site in enumerate(self._sites):
            self._engine.mj_objectVelocity(self.model, data, self._engine.mjtObj.mjOBJ_SITE, site, found, 0)
            out[k, :3], out[k, 3:] = found[3:], found[:3]
        return out

    @contextmanager
    def installed(self) -> Iterator[SnowForces]:
        """MuJoCo calls this within the block; what it called before, it calls again behind it."""
        before = self._engine.get_mjcb_passive()
        self._engine.set_mjcb_passive(self)
        try:
            yield self
        finally:
            self._engine.set_mjcb_passive(before)
