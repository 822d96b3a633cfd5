"""Enters with files alone: python plain_python.py CASE_FOLDER RESULT. Snow in strips, no library."""

import json
import math
import sys


def pressed(case, slope, strips, motion):
    """Force at each depth on strips (place, area) of a base that rises from its edge; each remembers its deepest."""
    hard, ratio = case["snow"]["snow_hardness_N_per_m3"], case["snow"]["unloading_ratio_1"]
    deepest = [0.0] * len(strips)
    for depth in motion:
        now = [depth - x * slope for x, _ in strips]
        deepest = [max(a, b) for a, b in zip(deepest, now)]
        yield sum(w * hard * max(0.0, m - ratio * (m - d)) for (_, w), d, m in zip(strips, now, deepest) if d > 0)


def under(case, slope, strips, loads):
    """Depth under each load, by halving; what was pressed before is pressed again."""
    found = []
    for load in loads:
        low, high = 0.0, 0.05
        for _ in range(40):
            middle = (low + high) / 2
            *_, force = pressed(case, slope, strips, [*found, middle])
            low, high = (low, middle) if force > load else (middle, high)
        found.append(low)
    return found


def solve(case):
    body, motion, loads = case["body"], case["motion"], case["loads"]["load_N"]
    if case["case"] == "01-plate":
        strips = [(0.0, body["length_m"] * body["width_m"])]
        forces = list(pressed(case, 0.0, strips, motion["depth_m"]))
        return {"force_N": forces, "depth_m": under(case, 0.0, strips, loads)}
    strips = [((i + 0.5) * 5e-5, body["length_m"] * 5e-5) for i in range(400)]
    slopes = [math.tan(math.radians(angle)) for angle in body["edge_angle_deg"]]
    depths = [depth for slope in slopes for depth in under(case, slope, strips, loads)]
    forces = [next(pressed(case, slope, strips, [motion["depth_by_heading_m"]])) for slope in slopes]
    # no grid: a heading changes nothing
    return {"depth_m": depths, "force_by_heading_N": [f for f in forces for _ in motion["heading_deg"]]}


case = json.load(open(sys.argv[1] + "/case.json"))
out = {"openbench": case["openbench"], "case": case["case"], "program": "plain-python"}
known = case["case"] in ("01-plate", "02-edge")
out |= {"values": solve(case)} if known else {"declined": "fifty lines know plates and edges alone"}
json.dump(out, open(sys.argv[2], "w"))
