"""Which law does the snow follow?

Nine laws F = H · (a A + b V) compete: the hardness H over depth, area or volume, with
or without terms in the edge angle. The simplest one within 5 % of the best is taken. On
groomed snow that is F = H_V V, without any fitted number.

Figure: how far each of the nine laws is from the readings, the chosen one in another
colour.
Known from: Mössner and others (2013) chose F = H_V V; the rmse follows from the
readings in one line of NumPy.
"""

import matplotlib.pyplot as plt

import skisnow

skisnow.write_reference("campaign", seed=1)
penetration = skisnow.analyse("campaign", n_resamples=100).results["penetration"]

chosen = penetration["selected"]["id"]
rmse = {row["id"]: row["rmse_N"] for row in penetration["models"]}
print(
    f"{chosen}: {rmse[chosen]:.2f} N; the best of nine has {min(rmse.values()):.2f} N"
)

names = {"none": "–", "one": "1", "constant": "constant", "linear": "linear in ϑ"}
labels = [
    f"{row['hardness']}   a: {names[row['a']]}, b: {names[row['b']]}"
    for row in penetration["models"]
]
colours = ["C1" if name == chosen else "C0" for name in rmse]
figure, axes = plt.subplots()
bars = axes.barh(labels, list(rmse.values()), color=colours)
axes.bar_label(bars, fmt="%.0f", padding=3)
axes.invert_yaxis()
axes.set(xlabel="root-mean-square error (N)", xlim=(0, 1.1 * max(rmse.values())))
figure.savefig("which_law.png")
