"""A blade, a moment, a shear stress.

A blade on a lever arm is turned through the snow until the snow fails. Moment over
lever arm is the force, and the force over length and depth of the blade is the failure
shear stress S_f. Deeper tests need more force, at the same stress.

Figure: failure shear force against the cross section L e of the blade; the slope of the
line is S_f.
Known from: by hand with Eqns 7 and 9 of Mössner and others (2013): 12 N m over 0.25 m ·
100 mm · 6 mm is 0.080 N/mm².
"""

from pathlib import Path

import matplotlib.pyplot as plt

import skisnow

tests = {
    "S1": (3.0, 6.1),
    "S2": (4.5, 8.8),
    "S3": (6.0, 12.0),
    "S4": (8.0, 16.3),
    "S5": (10.0, 19.6),
}  # mm, N m

campaign = Path("shear")
campaign.mkdir()
(campaign / "campaign.toml").write_text(
    'name = "shear"\n[[plate]]\nname = "blade"\nlength_mm = 100\n'
)
header = "experiment,site,plate,edge_angle_deg,depth_mm,lever_arm_mm,moment_Nm"
rows = [
    f"{name},slope,blade,90,{depth},250,{moment}"
    for name, (depth, moment) in tests.items()
]
(campaign / "shear.csv").write_text("\n".join([header, *rows]))

analysis = skisnow.analyse(campaign)
found = analysis.results["shear"]["experiments"]
stress = {row["experiment"]: row["S_f_N_per_mm2"] for row in found}
mean = analysis.own_stress.value
print(f"S3: S_f = {stress['S3']:.3f} N/mm²; mean of five {mean:.4f} N/mm²")

section = [100 * depth for depth, _ in tests.values()]
figure, axes = plt.subplots()
axes.plot(section, [row["F_t_N"] for row in found], "o", label="tests")
axes.plot([0, 1000], [0, 1000 * mean], label=f"S_f = {mean:.3f} N/mm²")
axes.set(
    xlabel="cross section L e of the blade (mm²)",
    ylabel="failure shear force F_t (N)",
    xlim=(0, 1050),
    ylim=(0, None),
)
axes.legend()
figure.savefig("shear_blade.png")
