"""How far apart are two tracks?

"Half a metre off" can mean three things: the line is another, the shape is, or the
motion is. The comparison tells all three: distance to the nearest place, at equal arc
length, and at equal time.

Figure: two arcs from above; below, the three distances along the measured one.
Known from: geometry: circles of 12.5 m and 12 m about one centre are 0.5 m apart
everywhere.
"""

import matplotlib.pyplot as plt
import numpy as np

import skisnow


def arc(name: str, radius: float, duration: float) -> skisnow.Track:
    """A quarter turn about the origin at an even speed."""
    time = np.linspace(0.0, duration, 601)
    angle = np.linspace(0.0, np.pi / 2, 601)
    place = radius * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(601)])
    return skisnow.Track(name, time, place, np.full(601, np.nan), "local", "made up")


simulated, measured = arc("simulated", 12.5, 3.0), arc("measured", 12.0, 3.3)
found = skisnow.compare(simulated, measured)

figure, (above, beside) = plt.subplots(1, 2)
for track in (simulated, measured):
    above.plot(track.place[:, 0], track.place[:, 1], label=track.name)
above.set(xlabel="x (m)", ylabel="y (m)", aspect="equal")
above.legend()
largest = {}
kinds = {
    "nearest place": found.nearest,
    "equal arc length": found.arc_length,
    "equal time": found.time,
}
for name, one in kinds.items():
    if (
        one.apart is None or one.numbers is None
    ):  # nothing to compare: one.reason says why
        continue
    beside.plot(one.apart.arc_length, one.apart.distance, label=name)
    largest[name] = one.numbers.max
    print(f"{name:17} largest {one.numbers.max:.3f} m, mean {one.numbers.mean:.3f} m")
beside.set(xlabel="along the measured track (m)", ylabel="distance (m)", ylim=(0, None))
beside.legend()
figure.savefig("two_tracks.png")
