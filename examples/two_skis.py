"""Two skis side by side on hard snow, and how much wider the one turns than the other.

    python examples/two_skis.py [SKI SKI]

SKI is a ski of the catalogue or a ski file. On a glacier in late summer (H_V = 90 N/mm³) a ski hardly sinks in: held at
one section, both bend until their edges lie on the snow, and the circle through boot and ends of the contact is nearly
R_sc cos ϑ. So the two radii are nearly as the two sidecut radii.
"""

from __future__ import annotations

import argparse
import math

from skisnow import carve, load_snow, read_ski

EDGE_ANGLE = math.radians(30.0)
LOAD_N = 400.0
UNLOADING_RATIO = 10.0  # k_u/H_V is not published: a parameter


def chord_radius(name: str) -> float:
    """Radius (m) of the circle through boot and ends of the contact, the ski held at one section."""
    answer = carve(
        read_ski(name),
        load_snow("glacier"),
        edge_angle=EDGE_ANGLE,
        load=LOAD_N,
        unloading_ratio=UNLOADING_RATIO,
        clamp_length=0.0,
    )
    if answer.turn_radius_chord is None:
        raise SystemExit(f"{name} does not carve here: {answer.outcome}: {answer.remedy}")
    return answer.turn_radius_chord


def main() -> None:
    """Print the ratio of the radii."""
    parser = argparse.ArgumentParser(description="Hold the turn radii of two skis against each other.")
    parser.add_argument("skis", nargs="*", metavar="SKI", default=["slalom", "giant-slalom"])
    skis = parser.parse_args().skis
    if len(skis) != 2:
        parser.error("two skis are needed")
    first, second = (chord_radius(name) for name in skis)
    print(f"{skis[1]} turns {second / first:.3f} times as wide as {skis[0]}")


if __name__ == "__main__":
    main()
