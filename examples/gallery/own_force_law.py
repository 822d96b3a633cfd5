"""Your own force law.

A friction law is a class with one method: the coefficient over the speed. Give it to
the snow, and the contact asks it at every place of the ski. This one sticks at low
speed and lets go as the ski gets faster.

Figure: friction force over normal force that the contact finds, over the speed, and the
law itself.
Known from: the law by hand: 0.03 + 0.05 exp(-2) = 0.0368 at 2 m/s.
"""

from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt

import skisnow
from skisnow.forces.friction import FrictionLaw


@dataclass(frozen=True)
class Sticky(FrictionLaw):
    """μ = μ_fast + μ_stick exp(-v/v_0)."""

    fast: float = 0.03
    stick: float = 0.05
    speed: float = 1.0  # m/s

    def _coefficient(self, speed: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        return np.asarray(self.fast + self.stick * np.exp(-speed / self.speed))


def found_share(law: FrictionLaw, speeds: npt.NDArray[np.float64]) -> list[float]:
    """Friction over normal force of a board 0.1 mm deep that glides straight ahead."""
    board = skisnow.Runner(np.array([0.8, -0.8]), np.full(2, 0.03), np.zeros(2))
    snow = skisnow.SnowField(2e8, 3e5, 10.0, friction=law)
    contact = skisnow.SnowContact(snow, [board])
    place, upright = [[0.0, 0.0, -1e-4]], np.eye(3)[None]
    wrenches = [
        contact.force(place, upright, [[speed, 0, 0, 0, 0, 0]], 0.0).wrench[0]
        for speed in speeds
    ]
    return [float(-wrench[0] / wrench[2]) for wrench in wrenches]


law, speeds = Sticky(), np.linspace(0.1, 6.0, 60)
share = found_share(law, speeds)
at_two = float(np.interp(2.0, speeds, share))
print(f"friction over normal force at 2 m/s: {at_two:.4f}")

figure, axes = plt.subplots()
axes.plot(speeds, law.coefficient(speeds), label="the law")
axes.plot(speeds[::4], share[::4], "o", label="what the contact finds")
axes.set(
    xlabel="speed (m/s)", ylabel="friction coefficient", xlim=(0, 6), ylim=(0, None)
)
axes.legend()
figure.savefig("own_force_law.png")
