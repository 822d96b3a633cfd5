"""Friction from three photo cells.

A sledge slides straight down 12°; three light beams tell when it passes 20, 60 and 120
m. With the drag area known from a wind tunnel, the times have one unknown left: the
friction coefficient. It comes with its interval.

Figure: time over the way: the three passages, and the run with the friction that was
found.
Known from: the times are made, with μ = 0.05 and no drag: s = v_0 t + ½ g (sin α - μ
cos α) t², rounded to 10 ms.
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import skisnow
from skisnow.identification import PhotoCellRun, PhotoCells

START, SLOPE = 3.0, math.radians(12.0)


def passages(station: np.ndarray, friction: float) -> np.ndarray:
    """Times (s) at stations (m) of a point that slides without drag."""
    pull = 9.81 * (math.sin(SLOPE) - friction * math.cos(SLOPE))
    return np.asarray((np.sqrt(START**2 + 2 * pull * station) - START) / pull)


station = np.array([20.0, 60.0, 120.0])
time = np.round(passages(station, 0.05), 2)
cells = PhotoCells("cells", (PhotoCellRun("run 1", station, time, np.full(3, 0.005)),))
known = {
    "slope.angle_deg": 12,
    "start.speed_m_per_s": START,
    "start.heading_deg": 0,
    "drag.drag_area_m2": 0,
}
found = skisnow.identify("carved-46m", cells, "mu_0", changes=known, workers=1)
friction = found["mu_0"].value or math.nan
low, high = found["mu_0"].interval or (math.nan, math.nan)
print(f"times {time} s: μ = {friction:.4f} (95 %: {low:.4f} to {high:.4f})")

way = np.linspace(0.0, 130.0, 131)
figure, axes = plt.subplots()
axes.plot(way, passages(way, friction), label=f"μ = {friction:.3f}")
axes.plot(way, passages(way, 0.0), "--", label="without friction")
axes.plot(station, time, "o", color="black", label="photo cells")
axes.set(xlabel="way (m)", ylabel="time (s)", xlim=(0, 130), ylim=(0, None))
axes.legend()
figure.savefig("friction_from_photo_cells.png")
