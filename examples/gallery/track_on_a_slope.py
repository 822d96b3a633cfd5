"""From latitude and longitude onto the slope.

A receiver writes degrees. Told where the slope falls and how steep it is, the track is
turned into the slope's own frame: x down the fall line, y to the left, z out of the
snow. Here a run of one arc second to the south, straight down 20°.

Figure: the track in degrees, and the same in metres on the slope.
Known from: the ellipsoid WGS84: an arc second of latitude at 47°, 1500 m up, is 30.88
m, so 30.88 m/cos 20° along the slope.
"""

import math
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import skisnow

SLOPE = math.radians(20.0)
share = np.linspace(0.0, 1.0, 41)
latitude = 47.0 - share / 3600.0
height = 1500.0 - share * 30.884 * math.tan(SLOPE)
longitude = 11.0 + 4e-5 * np.sin(2 * np.pi * share)  # a swing to the left and right
rows = ["time,lat,lon,alt_m"]
for n, (lat, lon, up) in enumerate(zip(latitude, longitude, height, strict=True)):
    rows.append(f"2026-01-20T10:00:{n / 10:04.1f}Z,{lat:.9f},{lon:.9f},{up:.3f}")
Path("run.csv").write_text("\n".join(rows))

track = skisnow.read_track("run.csv")
on_slope = skisnow.in_slope_frame(track, fall_line_azimuth=math.pi, slope_angle=SLOPE)
x, y, z = on_slope.place.T
print(f"{x[-1] - x[0]:.2f} m down, at most {1e3 * np.ptp(z):.1f} mm out of the plane")

figure, (degrees, metres) = plt.subplots(1, 2)
degrees.plot(longitude, latitude, ".-")
degrees.set(xlabel="longitude (°)", ylabel="latitude (°)")
degrees.ticklabel_format(useOffset=False)
degrees.tick_params("x", rotation=30)
metres.plot(y, x, ".-")
metres.invert_xaxis()
metres.invert_yaxis()
metres.set(xlabel="y, to the left (m)", ylabel="x, down the fall line (m)")
figure.savefig("track_on_a_slope.png")
