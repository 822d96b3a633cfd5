"""Two skis at two angles.

A skier's skis need not be parallel. Each runner in `SnowContact` has a pose of its own:
here two boards at one depth, one at 30° and one turned from 10° to 70°. The flatter one
carries more, because more of its base is in the snow.

Figure: force of the snow on each of the two boards over the edge angle of the second,
with the closed form as dots.
Known from: closed form: the wedge of Eqn 2, F = H_V L e²/(2 tan ϑ).
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import skisnow

HARDNESS, LENGTH, DEPTH, HALF = 2e8, 1.6, 2e-3, 0.03
board = skisnow.Runner(
    np.array([LENGTH / 2, -LENGTH / 2]), np.full(2, HALF), np.zeros(2)
)


def edged(angle: float) -> list[list[float]]:
    """Columns: ahead, left across the base, off the base; the left edge is down."""
    s, c = math.sin(angle), math.cos(angle)
    return [[1, 0, 0], [0, c, s], [0, -s, c]]


def forces(second: float) -> tuple[float, float]:
    """On both boards (N), the first at 30°."""
    pair = skisnow.SnowContact(skisnow.SnowField(HARDNESS, 3e5, 10.0), [board, board])
    angles = (math.radians(30.0), second)
    place = [
        [0.0, side, HALF * math.sin(angle) - DEPTH]
        for side, angle in zip((0.2, -0.2), angles, strict=True)
    ]
    found = pair.force(place, [edged(angle) for angle in angles], np.zeros((2, 6)), 0.0)
    return float(found.wrench[0, 2]), float(found.wrench[1, 2])


angle = np.radians(np.arange(10.0, 71.0, 5.0))
found = np.array([forces(each) for each in angle])
exact = HARDNESS * LENGTH * DEPTH**2 / (2.0 * np.tan(angle))
ratio = found[0, 0] / found[10, 1]
print(f"at 30° {found[0, 0]:.2f} N, at 60° {found[10, 1]:.2f} N: {ratio:.3f} to one")

figure, axes = plt.subplots()
axes.plot(np.degrees(angle), found[:, 0], label="first, at 30°")
axes.plot(np.degrees(angle), found[:, 1], label="second")
axes.plot(np.degrees(angle), exact, ".", color="black", label="H_V L e²/(2 tan ϑ)")
axes.set(
    xlabel="edge angle of the second (°)",
    ylabel="force along the snow normal (N)",
    ylim=(0, None),
)
axes.legend()
figure.savefig("two_angles.png")
