"""A ski pushed by hand through snow.

You say where the ski is, `SnowContact` says what the snow does: here a board with a
bent-up tip, 3 mm deep, pushed 2 m ahead without friction. What it pushes against is the
work of pressing the snow down; nine tenths of it stay in the groove.

Figure: force against the push over the way; below, the work of the push and the energy
that the groove has taken.
Known from: closed form: pressing costs ½ H_V e² per area, so 72 N over 80 mm; (1 -
H_V/k_u) of it stay: 64.8 J per metre.
"""

import matplotlib.pyplot as plt
import numpy as np

import skisnow

snow = skisnow.SnowField(
    snow_hardness=2e8, failure_shear_stress=3e5, unloading_ratio=10.0
)
board = skisnow.Runner(
    np.array([1.00, 0.70, -0.70]),  # from the tip to the tail (m)
    np.full(3, 0.04),  # half the width (m)
    np.array([0.012, 0.0, 0.0]),  # the tip bends up (m)
)
contact = skisnow.SnowContact(snow, [board], spacing=0.005)

step, upright = 0.004, np.eye(3)[None]
way, force, groove = [], [], []
for n in range(501):
    place = np.array([[n * step, 0.0, -0.003]])
    found = contact.force(place, upright, [[1.0, 0, 0, 0, 0, 0]], step)  # at 1 m/s
    contact.update(place, upright, step)
    way.append(n * step)
    force.append(-float(found.wrench[0, 0]))
    groove.append(contact.groove_energy)

steady = float(np.mean(force[250:]))
per_metre = (groove[-1] - groove[250]) / (way[-1] - way[250])
print(f"push {steady:.1f} N; energy of the groove {per_metre:.1f} J for each metre")

figure, (upper, lower) = plt.subplots(2, sharex=True)
upper.plot(way, force)
upper.set(ylabel="push (N)", ylim=(0, 100))
lower.plot(way, np.cumsum(force) * step, label="work of the push")
lower.plot(way, np.array(groove) - groove[0], "--", label="taken by the groove")
lower.set(xlabel="way (m)", ylabel="energy (J)", ylim=(0, None))
lower.legend()
figure.savefig("pushed_by_hand.png")
