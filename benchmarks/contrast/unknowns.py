"""What nobody knows of the published runs, how far it may reach, and the design over all of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from scipy.stats import qmc

from skisnow.parameters import Quantity

FloatArray = npt.NDArray[np.float64]

POINTS: Final = 1024
"""Of the whole design, a power of 2; each makes a pair with either ski."""
SEED: Final = 20261123


@dataclass(frozen=True, slots=True)
class Unknown:
    """One of them: evenly anywhere between two ends, or evenly in its logarithm."""

    name: str
    low: float
    high: float
    origin: str
    log: bool = False

    @property
    def key(self) -> Quantity:
        """Its column in a table."""
        return Quantity(self.name, self.origin)

    def at(self, share: FloatArray) -> FloatArray:
        """Its values at shares from 0 to 1 of its range."""
        if self.log:
            return np.exp(np.log(self.low) + np.log(self.high / self.low) * share)
        return self.low + (self.high - self.low) * share


UNKNOWNS: Final = (
    Unknown("slope.angle_deg", 4.0, 18.0, "an easy piste to one of medium inclination"),
    Unknown("snow.H_V_N_per_mm3", 0.02, 10.0, "Federolf's spring snow to hard winter snow", log=True),
    Unknown("snow.S_f_N_per_mm2", 0.04, 0.52, "fresh snow to Federolf's race piste", log=True),
    Unknown("snow.unloading_ratio", 2.0, 50.0, "k_u/H_V of the hypoplastic run; none is published", log=True),
    Unknown("snow.shear_displacement_mm", 0.02, 0.5, "u_y; not measured", log=True),
    Unknown("friction.mu_0", 0.023, 0.139, "over 200 runs of Wolfsperger and others (2021)"),
    Unknown("drag.drag_area_m2", 0.1, 0.66, "half a tuck to a skier upright (Supej and others 2022)"),
    Unknown("sledge.mass_kg", 40.0, 140.0, "a bare sledge to a loaded one"),
    Unknown("inertia_factor", 0.5, 2.0, "of the scenario's three moments of inertia", log=True),
    Unknown("sledge.centre_of_mass_height_m", 0.08, 0.3, "a low sledge"),
    Unknown("sledge.centre_of_mass_forward_m", -0.1, 0.1, "about the boots"),
    Unknown("sledge.stance_width_m", 0.3, 0.7, "two skis beside each other"),
    Unknown("sledge.edge_angle_deg", 5.0, 35.0, "from hardly edged to as far as such sledges are"),
    Unknown("ski.clamp_length_m", 0.0, 0.4, "from a point to a long plate"),
    Unknown("stiffness_factor", 0.7, 1.4, "of EI and GJ of the catalogue's ski", log=True),
    Unknown("sidecut_factor", 0.8, 1.25, "of the depth of that ski's sidecut", log=True),
    Unknown("start.speed_m_per_s", 3.0, 11.0, "so that a run of some seconds fits the lengths"),
    Unknown("start.heading_deg", -90.0, 0.0, "from a traverse to the fall line; the turn goes on to the left"),
)
"""All that is varied; ours, and stated beside every number that follows from it."""


def design() -> list[dict[str, Any]]:
    """Points of a Sobol sequence, Owen-scrambled: any number of the first ones fills the space evenly."""
    shares = qmc.Sobol(len(UNKNOWNS), scramble=True, rng=np.random.default_rng(SEED)).random(POINTS)
    columns = {each.name: each.at(shares[:, place]).tolist() for place, each in enumerate(UNKNOWNS)}
    return [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]
