"""`carve` against the equilibrium written down again without elements, `openbench.entries.numpy_reference.slow_carve`.

With 320 elements: what the default 160 add is in `test_mesh.py`.
"""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from openbench.entries.numpy_reference import slow_carve as reference
from openbench.entries.numpy_reference.slow_carve import Case

from skisnow.carving.equilibrium import carve, rest
from skisnow.carving.result import Equilibrium
from skisnow.forces.penetration import MeanPressurePoint, PointLaw, VolumeWithAnglePoint
from skisnow.forces.shear import AngleShear, ShearLaw
from skisnow.ski import Ski, read_ski

from .laws import Deepening, Power
from .synthetic import boot_pose, circular_sidecut, plain_ski, shovel, snow

AGREE = 1e-3
"""Of radius, depth and contact: 30 knots of curvature on each end and 160 points across are good to half of it."""


def compare(case: Case) -> None:
    theirs = reference.solved(case)
    ski, shear, penetration = case.ski, case.shear, case.penetration
    assert isinstance(ski, Ski)
    assert shear is None or isinstance(shear, ShearLaw)
    assert penetration is None or isinstance(penetration, PointLaw)
    ours = carve(
        ski,
        snow(case.hardness / 1e9),
        edge_angle=case.edge_angle,
        load=case.load,
        moment=case.moment,
        unloading_ratio=case.unloading_ratio if case.penetration is None else None,
        shear=shear,
        penetration=penetration,
        clamp_length=case.clamp_length,
        side_force_bending=case.side_force_bending,
        side_force_spread="base-reaction" if case.by_reaction else "depth",
        moment_balance="free" if case.boot_is_free else "boot",
        twist=case.twist,
        elements=320,
    )
    assert ours.edge_depth is not None
    assert ours.turn_radius_boot == pytest.approx(theirs.radius_at_boot(), rel=AGREE)
    front, rear = theirs.contact_ends()
    assert ours.contact_length == pytest.approx(front - rear, rel=AGREE)
    # the chord's end moves with the contact's, where the sidecut is no circle any more
    assert ours.turn_radius_chord == pytest.approx(theirs.radius_through(front, rear), rel=2.0 * AGREE)
    waist = float(ski.at(0.0).width) / 2.0 * math.sin(case.edge_angle)
    depth = boot_pose(ours, ski, case.edge_angle)[0] + waist
    assert depth == pytest.approx(theirs.boot_depth + waist, abs=2.0 * AGREE * float(ours.edge_depth.max()))

    def at_ours(values: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> object:
        return np.interp(ours.station[::-1], theirs.station[::-1], values[::-1])[::-1]

    below = ours.edge_depth > 0.0
    inner = np.abs(ours.station) < 0.6
    scale = float(ours.edge_depth.max())
    off = np.abs(np.asarray(at_ours(theirs.edge_depth)) - ours.edge_depth)
    assert ours.bending is not None
    assert np.max(off[below & inner]) < 5.0 * AGREE * scale
    # towards the ends depth is the small difference of deflection and base height
    assert np.max(off[below]) < AGREE * float(ours.bending.max())
    assert at_ours(theirs.deflection) == pytest.approx(ours.bending, abs=AGREE * float(ours.bending.max()))
    assert ours.twist is not None
    assert at_ours(theirs.twist) == pytest.approx(ours.twist, abs=2.0 * AGREE * math.radians(3.0))


def base() -> Case:
    return Case(
        ski=read_ski("slalom"), hardness=0.2e9, edge_angle=math.radians(45.0), load=800.0,
        unloading_ratio=10.0, clamp_length=0.3,
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [1.0, 10.0])
@pytest.mark.parametrize("angle_deg", [30.0, 60.0])
@pytest.mark.parametrize("clamp", [0.0, 0.3])
@pytest.mark.parametrize(("twist", "side_force_bending"), [(True, True), (False, True), (True, False)])
def test_all_choices(ratio: float, angle_deg: float, clamp: float, twist: bool, side_force_bending: bool) -> None:
    compare(
        replace(
            base(),
            unloading_ratio=ratio,
            edge_angle=math.radians(angle_deg),
            clamp_length=clamp,
            twist=twist,
            side_force_bending=side_force_bending,
        )
    )


PLAIN = plain_ski(width=circular_sidecut(13.0), base_height=shovel(1.4, 0.05, 1.6), running_length=1.4)
CASES: dict[str, dict[str, Any]] = {
    **{
        f"{hardness:g} N/m³ and {moment:g} N m": {"hardness": hardness, "moment": moment, "unloading_ratio": 5.0}
        for hardness in (0.04e9, 1e9)
        for moment in (-30.0, 30.0)
    },
    "a plain ski with a shovel": {"ski": PLAIN},
    "a boot that takes no moment of the side force": {"boot_is_free": True},
    "such a boot and a moment": {"boot_is_free": True, "moment": 40.0},
    "a side force that goes as the force on the base": {"by_reaction": True},
    "such a side force and such a boot": {"by_reaction": True, "boot_is_free": True},
    # p = 2 A ε + B beyond the ramp, which bends where the groove does, too
    "Federolf's law": {"hardness": 0.15e9, "penetration": MeanPressurePoint(0.034e9, 0.35e6, 10.0)},
    "a pressure as the 0.6th power": {"penetration": Power(1e6 / 5e-3**0.6, 0.6, unloading_ratio=8.0)},
    "a pressure as the 1.7th power": {"penetration": Power(1e6 / 5e-3**1.7, 1.7, unloading_ratio=8.0)},
    "a hardness that grows with the edge angle": {"penetration": VolumeWithAnglePoint(0.2e9, 10.0)},
    # where the ski twists, and where it is deeper, it draws as much more or less of the side force
    "a strength by the angle": {"shear": AngleShear(0.35e6, 0.6)},
    "a strength by the depth": {"shear": Deepening(0.1e6, 1e-3)},
}


@pytest.mark.slow
@pytest.mark.parametrize("changes", CASES.values(), ids=CASES)
def test_other_snow_skis_boots_and_laws(changes: dict[str, Any]) -> None:
    compare(replace(base(), **changes))


FORMER: list[dict[str, Any]] = json.loads((Path(__file__).parent / "former_solver.json").read_text("utf-8"))
ROUNDING = 1e-7
"""Of the greatest: equations of 160 elements lose six digits, and Newton's method ends at 10⁻¹¹ m."""
NONE = {"edge_depth": 1e-3, "force_per_length": 1e3, "twist": 1e-3, "boot_pitch_moment": 1.0}
"""Sizes (m, N/m, rad, N m) below which the rounding of others shows."""


def found(*, ski: str, H: float, S: float, angle: float, ratio: Any, bevel: float = 0.0, **asked: Any) -> Equilibrium:
    shape, given = replace(read_ski(ski), base_bevel=bevel), snow(H, S)
    if asked.pop("at_rest", False):
        return rest(shape, given, edge_angle=math.radians(angle), **asked)
    return carve(shape, given, edge_angle=math.radians(angle), unloading_ratio=float(ratio), **asked)


@pytest.mark.parametrize("former", FORMER, ids=lambda former: "-".join(str(v) for v in former["asked"].values()))
def test_the_same_is_found(former: dict[str, Any]) -> None:
    now = found(**former["asked"])
    for name, value in former["found"].items():
        computed = getattr(now, name)
        if value is None or isinstance(value, str):
            assert computed == value
        elif isinstance(value, list):
            places = len(now.station)
            room = ROUNDING * max(NONE[name], *(abs(each) for each in value))
            assert computed[places // 16 :: places // 8] == pytest.approx(value, rel=0.0, abs=room), name
        else:
            assert computed == pytest.approx(value, rel=ROUNDING, abs=ROUNDING * NONE.get(name, 0.0)), name
