"""What each case says: bodies, snow, motions and loads, in SI, a unit in each key; ``_1`` is the unit one."""

from __future__ import annotations

import math
from typing import Any, Final, TypeAlias

from .. import VERSION
from .laws import CARVE, FRICTION, PRESSURE, SHEAR
from .skis import carving_ski, turning_ski

Case: TypeAlias = dict[str, Any]


def _asked(**keys: tuple[int, str]) -> list[Case]:
    return [{"key": key, "count": count, "words": words} for key, (count, words) in keys.items()]


def _spread(asked: list[Case], key: str, group: int) -> list[Case]:
    """The spread over each so many numbers is told beside the error."""
    return [each | {"spread_over": group} if each["key"] == key else each for each in asked]


def _case(name: str, title: str, laws: list[str], asked: list[Case], **parts: Any) -> Case:
    return {"openbench": VERSION, "case": name, "title": title, "laws": laws, **parts, "asked": asked}


def plate() -> Case:
    """A plate pressed, lifted, pressed again."""
    depths = [0.0005, 0.0010, 0.0020, 0.0019, 0.00185, 0.0018, 0.0010, 0.0019, 0.0020, 0.0030, 0.0028, 0.0029]
    loads = [500.0, 2000.0, 1000.0, 100.0, 1500.0, 3000.0, 2900.0, 300.0]
    return _case(
        "01-plate",
        "A plate pressed, lifted, pressed again",
        [PRESSURE],
        _asked(
            force_N=(len(depths), "of the snow on the plate at each depth of the motion"),
            depth_m=(len(loads), "of the plate under each load, on fresh snow again"),
        ),
        body={"shape": "rectangle, level", "length_m": 0.2, "width_m": 0.06},
        snow={"snow_hardness_N_per_m3": 2e8, "unloading_ratio_1": 10.0},
        motion={"words": "depth of the plate, one after the other", "depth_m": depths},
        loads={"words": "on the plate, one after the other, on fresh snow", "load_N": loads},
    )


def edge() -> Case:
    """A rigid edge under load, and at headings."""
    angles, headings = [30.0, 45.0, 60.0], [0.0, 5.0, 10.0, 15.0, 22.5, 30.0, 45.0]
    loads = [50.0, 200.0, 400.0, 100.0]
    return _case(
        "02-edge",
        "A rigid edge under load, and at headings to a grid",
        [PRESSURE],
        _spread(
            _asked(
                depth_m=(
                    len(angles) * len(loads),
                    "of the edge under each load, edge angle after edge angle, each on fresh snow",
                ),
                force_by_heading_N=(
                    len(angles) * len(headings),
                    "at depth_by_heading_m on fresh snow, edge angle after edge angle, with the edge at each heading to the "
                    "x axis of whatever grid a program has; a program without a grid turns it all the same",
                ),
            ),
            "force_by_heading_N",
            len(headings),
        ),
        body={
            "shape": "wedge: a plane base, its lower edge straight and level, wide enough never to be wet over its width",
            "length_m": 0.4,
            "edge_angle_deg": angles,
        },
        snow={"snow_hardness_N_per_m3": 4e7, "unloading_ratio_1": 10.0},
        loads={"words": "one after the other", "load_N": loads},
        motion={
            "words": "pressed once, at each heading; the middle of the edge at x, y",
            "depth_by_heading_m": 0.005,
            "heading_deg": headings,
            "x_m": 0.0137,
            "y_m": 0.0071,
        },
    )


def cycles() -> Case:
    """Cyclic loading."""
    peaks, amplitudes = [0.002, 0.003, 0.003, 0.004], [0.0003, 0.0006, 0.0012]
    return _case(
        "03-cycles",
        "Cyclic loading: energy lost per cycle",
        [PRESSURE, SHEAR],
        _asked(
            energy_lost_per_cycle_J=(
                len(peaks),
                "work of each cycle down to its peak depth and up until nothing presses",
            ),
            energy_lost_per_shear_cycle_J=(
                len(amplitudes),
                "work across the edge of one closed cycle aside, from + amplitude to - amplitude and back, on fresh snow "
                "for each amplitude, the edge held at shear_depth_m; by the shear alone",
            ),
        ),
        body={
            "shape": "wedge: a plane base, its lower edge straight and level",
            "length_m": 0.4,
            "edge_angle_deg": 45.0,
        },
        snow={
            "snow_hardness_N_per_m3": 1e8,
            "unloading_ratio_1": 8.0,
            "failure_shear_stress_N_per_m2": 3e5,
            "shear_displacement_m": 0.0005,
        },
        motion={
            "words": "down to each peak and up until free, one after the other on the same place; then the cycles aside, "
            "0 to + amplitude, to - amplitude, to + amplitude",
            "peak_depth_m": peaks,
            "shear_depth_m": 0.002,
            "shear_amplitude_m": amplitudes,
        },
    )


def glide() -> Case:
    """A straight glide of 10 m."""
    places = [2.0, 4.0, 6.0, 8.0, 10.0]
    return _case(
        "04-glide",
        "A straight glide of 10 m and the groove it leaves",
        [PRESSURE, FRICTION],
        _asked(
            speed_squared_m2_per_s2=(len(places), "at each of the places way_m"),
            groove_depth_m=(1, "largest depth, in the steady glide"),
            groove_residual_depth_m=(1, "what is left of it behind the runner"),
            groove_energy_J_per_m=(
                1,
                "pressed into the snow for each metre of groove, less what the snow would give back on unloading",
            ),
        ),
        body={
            "shape": "runner of constant width: level from tail to bend, then straight up to the tip",
            "tail_m": -0.8,
            "bend_m": 0.6,
            "tip_m": 0.8,
            "tip_height_m": 0.04,
            "width_m": 0.06,
            "mass_kg": 40.0,
            "drag_kg_per_m": 0.36,
            "words": "drag force = drag_kg_per_m * v^2. A guide keeps it level and on its line; it is free along the "
            "slope and off the snow, and starts at its static depth",
        },
        snow={"snow_hardness_N_per_m3": 4e5, "unloading_ratio_1": 10.0, "friction_1": 0.04},
        motion={"slope_deg": 12.0, "gravity_m_per_s2": 9.81, "start_speed_m_per_s": 4.0, "way_m": places},
    )


def sand() -> Case:
    """Plates and wheels in sand; the measured numbers come beside this file from the data."""
    return _case(
        "05-sand",
        "Discs and a wheel in sand: predict the half that is held back",
        ["Measured. No law is given: any program may fit its own to the given half."],
        [
            {"key": "load_N", "count": 35, "words": "on each disc of held_back_plates in given.json"},
            {"key": "side_force_N", "count": 81, "words": "on the wheel in each run of held_back_wheel in given.json"},
        ],
        data={
            "words": "given.json lies beside this file when the set is run with --data FOLDER: plates and wheel with "
            "their forces, held_back_plates and held_back_wheel without. Discs of 60 and 100 mm are given (two trials "
            "each), their third trials and all of 80 mm are held back; of the wheel the slip angles 0, 30, 60 and 90 "
            "degrees are given, 15, 45 and 75 held back.",
            "source": "github robomechanics/3d-terramechanics, commit 55a6e92, Copyright 2022 Catherine Pavlov, "
            "Carnegie Mellon University, MIT licence; the numbers are not part of this set",
            "files": ["plates_large_box_7level.csv", "wheel_lateral_smooth.csv"],
            "given_plate_trials_1": [1, 2, 4, 5],
            "given_slip_angle_deg": [0.0, 30.0, 60.0, 90.0],
        },
    )


def carve() -> Case:
    """A flexible ski in a steady carve."""
    points = [
        (hardness, load, angle)
        for hardness, load in ((4e7, 800.0), (2e8, 800.0), (2e8, 1500.0), (1e9, 800.0))
        for angle in (30.0, 45.0, 60.0)
    ]
    hardness, load, angle = zip(*points, strict=True)
    return _case(
        "06-carve",
        "A flexible ski carving steadily, 12 points",
        [
            PRESSURE,
            *CARVE,
        ],
        _asked(
            turn_radius_at_boot_m=(12, "of each point"),
            edge_depth_at_boot_m=(12, "of each point"),
            contact_length_m=(12, "of each point"),
        ),
        body={
            "shape": "ski, straight between its stations; s from the boot, positive ahead",
            "clamp_length_m": 0.3,
            **carving_ski(),
        },
        snow={"snow_hardness_N_per_m3": list(hardness), "unloading_ratio_1": 10.0},
        loads={"load_N": list(load), "edge_angle_deg": list(angle)},
    )


def turn() -> Case:
    """A single turn of a sledge on two rigid skis, on two snows."""
    angle, depth, waist = 35.0, 0.00185, 0.033
    lift = 0.15
    return _case(
        "07-turn",
        "A single turn on hypoplastic and on elastic snow, with shear that yields",
        [
            PRESSURE,
            SHEAR + " At the start the anchors are where the edges are.",
            FRICTION,
            "The wet base at a section is plane: straight across, and along as the edge's line goes there.",
        ],
        _asked(
            place_m=(16, "x, y of the origin at each time, on the first snow, then on the second"),
            heading_rad=(
                8,
                "of the sledge at each time: the angle from x to its forward axis in the surface; first, then second snow",
            ),
            speed_m_per_s=(8, "of the origin at each time; first, then second snow"),
        ),
        body={
            "shape": "rigid sledge on two rigid skis; its origin is its centre of mass; skis are straight between stations",
            "mass_kg": 80.0,
            "inertia_kg_m2": [6.0, 8.0, 10.0],
            "drag_kg_per_m": 0.3,
            "boots_m": [[0.0, 0.2, -lift], [0.0, -0.2, -lift]],
            "edge_angle_deg": angle,
            "words": "axes: ahead, left, up. Each ski is turned about its forward axis so that its left edge is down by "
            "edge_angle_deg. Drag -drag_kg_per_m |v| v acts at the origin",
            **turning_ski(math.radians(angle)),
        },
        snow={
            "snow_hardness_N_per_m3": 1e8,
            "unloading_ratio_1": [10.0, 1.0],
            "failure_shear_stress_N_per_m2": 1.5e5,
            "shear_displacement_m": 0.0005,
            "friction_1": 0.03,
        },
        motion={
            "words": "x down the fall line, z off the snow; the start: level, no rotation, velocity along the heading",
            "slope_deg": 10.0,
            "gravity_m_per_s2": 9.81,
            "start_place_m": [0.0, 0.0, waist * math.sin(math.radians(angle)) - depth + lift],
            "start_heading_deg": -45.0,
            "start_speed_m_per_s": 7.0,
            "time_s": [0.5, 1.0, 1.5, 2.0],
        },
    )


def crossing() -> Case:
    """An older track crossed."""
    angles = [90.0, 60.0, 30.0, 15.0]
    return _case(
        "08-crossing",
        "An older track crossed at 90, 60, 30 and 15 degrees",
        [PRESSURE],
        _asked(
            energy_lost_J=(
                len(angles),
                "in the snow by the second runner over its way, at each angle; the snow of its start counts",
            ),
            depth_m=(
                len(angles),
                "of the second runner, level and at rest in the middle of the crossing, under the load",
            ),
        ),
        body={
            "shape": "level runners, rectangles; walls of the older track are straight",
            "first_width_m": 0.06,
            "second_width_m": 0.06,
            "second_length_m": 0.8,
        },
        snow={"snow_hardness_N_per_m3": 1e7, "unloading_ratio_1": 10.0},
        motion={
            "words": "the first runner went straight along x, far before and behind, at first_depth_m. The second goes "
            "straight through at second_depth_m at each crossing_angle_deg to it, its middle from -way_m/2 to way_m/2",
            "first_depth_m": 0.006,
            "second_depth_m": 0.008,
            "way_m": 1.2,
            "crossing_angle_deg": angles,
        },
        loads={"words": "pressed down once, on another crossing of the same kind", "load_N": 2000.0},
    )


CASES: Final = (plate, edge, cycles, glide, sand, carve, turn, crossing)
