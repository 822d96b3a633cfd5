"""What radius did the skier turn?

A receiver writes a place ten times a second, off by a centimetre. The track is smoothed
with a local cubic, and curvature, turns and radii come out with intervals from the
scatter alone.

Figure: the points of the track and its turn from above, and the radius along it with
its 95 % band.
Known from: the track is made: an arc of 15 m at 8 m/s, with normal errors of 10 mm in
each coordinate.
"""

import matplotlib.pyplot as plt
import numpy as np

import skisnow

RADIUS, SPEED = 15.0, 8.0
time = np.arange(0.0, 5.05, 0.1)
angle = SPEED * time / RADIUS
exact = np.stack(
    [
        RADIUS * np.sin(angle),
        RADIUS * (1.0 - np.cos(angle)),
        np.full(time.shape, np.nan),
    ],
    axis=1,
)
place = exact + np.random.default_rng(1).normal(0.0, 0.01, exact.shape)
track = skisnow.Track(
    "arc", time, place, np.full(time.shape, np.nan), "local", "made up"
)

summary = skisnow.track_summary(track)
[turn] = summary.turns
print(
    f"{turn.direction}, mean radius {turn.mean_radius:.2f} m over {turn.length:.1f} m"
)

figure, (left, right) = plt.subplots(1, 2)
left.plot(place[:, 0], place[:, 1], ".")
left.set(xlabel="x (m)", ylabel="y (m)", aspect="equal")
motion = summary.motion
band = 1.96 * motion.turn_radius_sd
right.fill_between(
    motion.time,
    motion.turn_radius - band,
    motion.turn_radius + band,
    alpha=0.3,
    label="95 %",
)
right.plot(motion.time, motion.turn_radius, label="from the track")
right.axhline(RADIUS, color="black", linestyle="--", linewidth=0.8, label="true")
right.set(xlabel="time (s)", ylabel="radius (m)", ylim=(10, 20))
right.legend()
figure.savefig("radius_of_a_track.png")
