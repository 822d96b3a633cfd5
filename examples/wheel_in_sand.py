"""Side force of a wheel in dry sand against its slip angle, as a regression with intervals.

    python examples/wheel_in_sand.py FILE

FILE is ``wheel_lateral_smooth.csv``: steady forces on a smooth wheel at slip angles of 0 to 90°, from github
robomechanics/3d-terramechanics (MIT). A slip angle is no edge angle: the machining law of a ski's edge does not apply.
"""

from __future__ import annotations

import argparse
import csv
from pathlib import Path

import numpy as np
import numpy.typing as npt

from skisnow.statistics import linear_fit


def wheel_side_force(path: Path) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Give slip angle (rad) and side force (N), one pair per steady run."""
    with path.open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    slip_angle = np.radians([float(row["slip_angle_deg"]) for row in rows])
    return slip_angle, np.array([float(row["Fx_N"]) for row in rows])


def main() -> None:
    """Fit and print."""
    parser = argparse.ArgumentParser(description="Regress the side force of a wheel on its slip angle.")
    parser.add_argument("file", type=Path)
    slip_angle, side_force = wheel_side_force(parser.parse_args().file)
    fit = linear_fit(side_force, slip_angle)
    low, high = fit.intervals[1]
    print(
        f"side force grows by {fit.coefficients[1]:.2f} N per rad of slip angle "
        f"(95 % interval {low:.2f} to {high:.2f}), R2 = {fit.r2:.3f}, n = {len(side_force)}"
    )


if __name__ == "__main__":
    main()
