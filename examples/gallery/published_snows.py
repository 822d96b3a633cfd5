"""Five snows of the literature.

Where nobody has measured the snow of a slope, a published one stands in. Three come
from tests with a piece of ski pressed in along its own normal, p = A e + B, which H_V =
2A/cos²ϑ and S_f = B/sin²ϑ turn into the two numbers of this package.

Figure: failure shear stress against snow hardness of the published snows, both on
logarithmic scales.
Known from: Mössner and others (2013) print 0.21, 0.16 and 0.022 N/mm³ and 0.52, 0.086
and 0.094 N/mm² for the three.
"""

import matplotlib.pyplot as plt

import skisnow

snows = {name: skisnow.published_snow(name) for name in skisnow.published_names()}
figure, axes = plt.subplots()
for name, snow in snows.items():
    if snow.failure_shear_stress is None:
        continue
    point = 1e-9 * snow.snow_hardness, 1e-6 * snow.failure_shear_stress
    print(f"{name:19} H_V {point[0]:.2g} N/mm³, S_f {point[1]:.2g} N/mm²")
    axes.loglog(*point, "o")
    axes.annotate(name, point, xytext=(6, 6), textcoords="offset points")
axes.set(xlabel="snow hardness H_V (N/mm³)", ylabel="failure shear stress S_f (N/mm²)")
axes.set(xlim=(0.01, 400), ylim=(0.03, 0.8))
axes.set_yticks((0.04, 0.1, 0.2, 0.5), labels=("0.04", "0.1", "0.2", "0.5"))
axes.minorticks_off()
figure.savefig("published_snows.png")
