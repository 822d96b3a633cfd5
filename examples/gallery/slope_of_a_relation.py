"""Does the shear stress depend on the edge angle?

At one soft site of the campaign the edge angle of the blade was varied. A straight line
through the tests has a slope with a 95 % interval, and 0 lies outside. Five in a
hundred such intervals miss the true slope; this seed's is one of them.

Figure: failure shear stress over the edge angle at the soft site, with the line and the
paper's Eqn 13.
Known from: NumPy's `polyfit`. The snow is drawn about Eqn 13, whose slope is -0.059 ·
0.266 = -0.0157 N/mm² per rad.
"""

import matplotlib.pyplot as plt
import numpy as np

import skisnow

skisnow.write_reference("campaign", seed=1)
tests = skisnow.analyse("campaign", n_resamples=100).results["shear"]["experiments"]
soft = [test for test in tests if test["site"] == "site J"]
angle = np.radians([test["edge_angle_deg"] for test in soft])
stress = np.array([test["S_f_N_per_mm2"] for test in soft])

found = skisnow.regress(stress, np.column_stack([np.ones(len(angle)), angle]))
slope, (low, high) = found.b[1], found.bint[1]
print(
    f"slope {slope:.4f} N/mm² per rad (95 %: {low:.4f} to {high:.4f}), n = {len(soft)}"
)

along = np.radians([25.0, 95.0])
figure, axes = plt.subplots()
axes.plot(np.degrees(angle), stress, "o", label="tests")
axes.plot(
    np.degrees(along),
    found.b[0] + slope * along,
    label=f"slope {slope:.3f} N/mm² per rad",
)
axes.plot(np.degrees(along), 0.059 * (1 - 0.266 * along), "--", label="Eqn 13")
axes.set(xlabel="edge angle (°)", ylabel="failure shear stress (N/mm²)", ylim=(0, None))
axes.legend()
figure.savefig("slope_of_a_relation.png")
