"""Does the snow hold the edge?

The more a ski is tilted, the more side force a turn asks of the snow: load times tan ϑ.
What the snow can give is its shear strength times the area of the edge in it. Where the
first passes the second, carving ends and skidding begins.

Figure: side force asked and side force possible over the edge angle, on three published
snows.
Known from: statics: a load of 800 N along the snow normal at 45° asks for 800 N · tan
45° = 800 N.
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import skisnow

ski = skisnow.read_ski("slalom")
angles = np.arange(5, 76, 5)
asked = {}

figure, axes = plt.subplots()
for name in ("race-piste", "recreational-piste", "spring-snow"):
    limit = []
    for angle in angles:
        answer = skisnow.carve(
            ski,
            skisnow.load_snow(name),
            edge_angle=math.radians(angle),
            load=800.0,
            unloading_ratio=10.0,
        )
        limit.append(answer.side_force_limit or math.nan)
        asked[int(angle)] = answer.side_force or math.nan
    axes.plot(angles, limit, "o-", label=f"{name} can hold")
    slips = [
        angle
        for angle, can in zip(angles, limit, strict=True)
        if asked[int(angle)] > can
    ]
    print(
        f"{name}: {f'slips from {slips[0]}° on' if slips else 'holds at every angle'}"
    )
axes.plot(angles, list(asked.values()), "--", color="black", label="asked: 800 N tan ϑ")
print(f"asked at 45°: {asked[45]:.1f} N")
axes.set(xlabel="edge angle (°)", ylabel="side force (N)", ylim=(0, 4000))
axes.legend()
figure.savefig("does_it_hold.png")
