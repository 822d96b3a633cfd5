"""A board on snow is a beam on an elastic foundation.

A flat, straight board of one width and stiffness, pressed down in its middle, lies on
snow whose resistance grows with the depth. That is Winkler's beam: k w + EI w'''' = 0
on both sides of the force, with free ends.

Figure: depth along the board, deepest under the force and less towards both ends, with
the closed form as dots.
Known from: Hetényi (1946), Beams on Elastic Foundation: P λ/(2k) (2 + cosh λL + cos
λL)/(sinh λL + sin λL) in the middle.
"""

import matplotlib.pyplot as plt
import numpy as np

import skisnow

LENGTH, WIDTH, EI, HARDNESS, LOAD = 0.6, 0.06, 600.0, 0.022e9, 400.0
station = np.linspace(LENGTH / 2, -LENGTH / 2, 601)
one, ends = np.ones(station.shape), 0.99 * LENGTH
tables = station, WIDTH * one, 0 * one, EI * one, 100 * one, one
board = skisnow.Ski("board", "made up", *tables, ends, ends)
snow = skisnow.SnowProperties(HARDNESS, None, source="made up")
answer = skisnow.rest(board, snow, edge_angle=0.0, load=LOAD, clamp_length=0.0)
depth = np.asarray(answer.edge_depth)

wave = (HARDNESS * WIDTH / (4 * EI)) ** 0.25  # λ (1/m), k = H_V W
# w = c · (cosh cos, sinh sin, cosh sin, sinh cos)(λx); this matrix derives it by λx
slope = np.array([[0, 0, 1, 1], [0, 0, 1, -1], [-1, 1, 0, 0], [1, 1, 0, 0]], float)


def shapes(x: float) -> list[float]:
    """The four functions at λx."""
    C, S = np.cosh(wave * x), np.sinh(wave * x)
    c, s = np.cos(wave * x), np.sin(wave * x)
    return [C * c, S * s, C * s, S * c]


middle, end = np.array(shapes(0.0)), np.array(shapes(LENGTH / 2))
twice, thrice = slope @ slope, slope @ slope @ slope
conditions = [middle @ slope, middle @ thrice, end @ twice, end @ thrice]
constants = np.linalg.solve(conditions, [0.0, LOAD / (2 * EI * wave**3), 0.0, 0.0])
dots = np.linspace(0.0, LENGTH / 2, 9)
exact = np.array([shapes(x) for x in dots]) @ constants

print(f"in the middle {1e3 * depth.max():.4f} mm; closed form {1e3 * exact[0]:.4f} mm")
figure, axes = plt.subplots()
axes.plot(answer.station, 1e3 * depth, label="rest")
axes.plot(
    [*-dots, *dots],
    1e3 * np.array([*exact, *exact]),
    ".",
    color="black",
    label="closed form",
)
axes.set(xlabel="position along the ski (m)", ylabel="depth (mm)")
axes.invert_yaxis()
axes.legend()
figure.savefig("beam_on_snow.png")
