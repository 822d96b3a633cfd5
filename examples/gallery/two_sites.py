"""Two sites: is B harder?

Thirty tests at each of two sites scatter by a third. The analysis compares the
geometric means of the snow hardness and gives the ratio with its 95 % interval: that
1 lies outside says yes, and by how much.

Figure: the hardness of each test at both sites with the geometric means, and the ratio
between them in the title.
Known from: SciPy's `ttest_ind` on the same values, in the test of this example; skisnow
pools the scatter of all sites, so the interval differs by some percent of its width.
"""

import matplotlib.pyplot as plt
import numpy as np

import skisnow

skisnow.write_reference("campaign", seed=1)  # a synthetic one; yours has this form
analysis = skisnow.analyse("campaign", n_resamples=100)
results = analysis.results

pair = results["group_comparisons"][0]  # A with B
ratio, (low, high) = pair["ratio"], pair["interval"]
print(f"A is {ratio:.2f} times as hard as B (95 %: {low:.2f} to {high:.2f})")

figure, axes = plt.subplots()
hardness = {}
for place, site in enumerate(("site A", "site B")):
    tests = results["penetration"]["experiments"]
    own = np.array([each["H_V_N_per_mm3"] for each in tests if each["site"] == site])
    axes.plot(place + np.linspace(-0.15, 0.15, len(own)), own, "o")
    hardness[site] = own
    mean = float(np.exp(np.log(hardness[site]).mean()))
    axes.plot([place - 0.25, place + 0.25], [mean, mean], color="black")
axes.set(
    yscale="log",
    ylabel="snow hardness H_V (N/mm³)",
    xticks=(0, 1),
    xticklabels=hardness,
)
axes.set_yticks((0.04, 0.1, 0.2, 0.3), labels=("0.04", "0.1", "0.2", "0.3"))
axes.minorticks_off()
axes.set_title(
    f"B is {1 / ratio:.1f} times as hard, 95 % interval {1 / high:.1f} to {1 / low:.1f}"
)
figure.savefig("two_sites.png")
