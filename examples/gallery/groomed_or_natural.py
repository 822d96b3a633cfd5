"""Groomed or natural: the same density, seventy times the strength.

Two published relations give the shear strength of snow from its density: one measured
on groomed slopes, one on natural snow covers. Each warns outside the densities that it
was measured on. Snow that was milled and has sintered is another material.

Figure: failure shear stress over the density on groomed slopes and in natural snow, on
a logarithmic scale.
Known from: Mössner and others (2013) print 0.11 and 0.0015 N/mm² for 500 kg/m³, with
Eqn 14 and Domine and others (2011).
"""

import matplotlib.pyplot as plt
import numpy as np

from skisnow.forces.shear import DensityShear, NaturalDensityShear

groomed = np.linspace(420, 740, 65)
natural = np.linspace(150, 500, 71)
of_groomed = [1e-6 * DensityShear(density).failure_shear_stress for density in groomed]
of_natural = [
    1e-6 * NaturalDensityShear(density).failure_shear_stress for density in natural
]

at_500 = (
    1e-6 * DensityShear(500.0).failure_shear_stress,
    1e-6 * NaturalDensityShear(500.0).failure_shear_stress,
)
print(f"at 500 kg/m³: {at_500[0]:.3f} N/mm² groomed, {at_500[1]:.4f} N/mm² natural")

figure, axes = plt.subplots()
axes.semilogy(groomed, of_groomed, label="groomed slopes, Mössner and others 2013")
axes.semilogy(natural, of_natural, label="natural snow, Domine and others 2011")
axes.plot([500, 500], at_500, "o", color="black")
axes.annotate(f"{at_500[0] / at_500[1]:.0f} times", (500, 0.012), (515, 0.012))
axes.set(xlabel="snow density (kg/m³)", ylabel="failure shear stress S_f (N/mm²)")
axes.legend(loc="lower right")
figure.savefig("groomed_or_natural.png")
