"""Edge angle and turn radius.

Tilt a ski on hard snow and press until its whole edge touches: the edge lies on a
circle of about the sidecut radius times the cosine of the edge angle. In softer snow
the ski sinks in, and the circle is another.

Figure: turn radius over edge angle on a glacier in late summer and on a recreational
piste, with R_sc cos ϑ.
Known from: geometry of the edge, Howe (2001) and Lind and Sanders (2004): R = R_sc cos
ϑ.
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import skisnow

ski = skisnow.read_ski("giant-slalom")
angles = range(10, 66, 5)


def radius(snow: str, degrees: int) -> float:
    """Through boot and ends of the contact (m)."""
    answer = skisnow.carve(
        ski,
        skisnow.published_snow(snow),
        edge_angle=math.radians(degrees),
        load=800.0,
        unloading_ratio=10.0,
        clamp_length=0.0,
    )
    return answer.turn_radius_chord or math.nan


hard = [radius("glacier", angle) for angle in angles]
soft = [radius("recreational-piste", angle) for angle in angles]
rule = ski.sidecut_radius_of_three_widths * np.cos(np.radians(angles))
print(
    f"30°: glacier {hard[4]:.2f} m, R_sc cos ϑ = {rule[4]:.2f} m, piste {soft[4]:.2f} m"
)

figure, axes = plt.subplots()
axes.plot(angles, rule, "--", color="black", label="R_sc cos ϑ")
axes.plot(angles, hard, "o-", label="glacier, 90 N/mm³")
axes.plot(angles, soft, "s-", label="recreational piste, 0.16 N/mm³")
axes.set(xlabel="edge angle (°)", ylabel="turn radius (m)", ylim=(0, None))
axes.legend()
figure.savefig("sidecut_and_angle.png")
