"""What machining theory would make of an edge.

Metal is cut along a shear plane, and a flatter tool needs more force. Applied to snow,
the theory lets the stress at small edge angles grow far beyond what was measured: the
soft snow of the paper hardly depends on the angle.

Figure: shear stress over the edge angle: the measured line, and the theory with and
without friction on the blade.
Known from: Mössner and others (2013): a vertical blade without friction has S_f = 2 S;
Eqn 13 gives 0.0343 N/mm² there.
"""

import math

import matplotlib.pyplot as plt
import numpy as np

from skisnow.forces.cutting import cutting_stress
from skisnow.forces.shear import AngleShear

measured = AngleShear.soft_snow()  # Eqn 13
angle = np.radians(np.linspace(30.0, 90.0, 61))
upright = float(measured.failure_stress(0.005, math.pi / 2))
strength = upright / 2  # S, so that theory and measurement agree for the vertical blade

figure, axes = plt.subplots()
axes.plot(
    np.degrees(angle),
    1e-6 * measured.failure_stress(0.005, angle),
    label="measured, Eqn 13",
)
for friction in (0.0, 0.2):
    stress = cutting_stress(strength, angle, transverse_friction=friction)
    axes.plot(
        np.degrees(angle),
        1e-6 * stress,
        "--",
        label=f"machining theory, μ_t = {friction:g}",
    )
axes.set(xlabel="edge angle (°)", ylabel="stress F_t/(L e) (N/mm²)", ylim=(0, None))
axes.legend()

ratio = float(cutting_stress(strength, math.pi / 2, transverse_friction=0.0)) / strength
flatter = (
    float(cutting_stress(strength, math.radians(30), transverse_friction=0.0)) / upright
)
print(
    f"upright {1e-6 * upright:.4f} N/mm² = {ratio:.3f} S; 30°: {flatter:.2f} times that"
)
figure.savefig("machining.png")
