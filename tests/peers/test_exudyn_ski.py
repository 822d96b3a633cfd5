"""The same ski statically in Exudyn: deflection and depth within 1 %."""

import math

import numpy as np
import pytest

from skisnow.carving.equilibrium import carve, rest
from skisnow.ski import read_ski

from ..carving.synthetic import boot_pose, snow, weights

pytest.importorskip("exudyn", reason="Exudyn is not installed: pip install 'skisnow[peers]'")

from benchmarks.exudyn_contact import cantilever_deflection, on_snow

from skisnow._support.arrays import FloatArray
from tests.present import present

WITHIN = 0.01


@pytest.mark.parametrize("name", ["slalom", "giant-slalom", "carver"])
@pytest.mark.parametrize(("scale", "agreement"), [(1e-3, 0.001), (1.0, WITHIN)])
def test_clamped_ski_under_the_load_of_a_turn(name: str, scale: float, agreement: float) -> None:
    """EI(x), clamp of 0.3 m, f cos ϑ + τ e sin ϑ of a carved turn: linear to 0.1 %, geometrically exact to 1 %."""
    ski, angle, load, clamp = read_ski(name), math.radians(45.0), 800.0, 0.3
    found = carve(ski, snow(0.2), edge_angle=angle, load=load, unloading_ratio=10.0, clamp_length=clamp)
    weight = weights(ski, clamp)
    bite = np.maximum(present(found.edge_depth), 0.0)
    stress = load * math.tan(angle) / float(weight @ bite)
    normal = present(found.force_per_length) * math.cos(angle) + stress * bite * math.sin(angle)
    for sign, end in ((1.0, float(ski.station[0])), (-1.0, float(ski.station[-1]))):
        place, deflection = cantilever_deflection(
            ski, sign * clamp / 2.0, end, found.station, normal * weight, scale=scale
        )
        part = sign * found.station > clamp / 2.0
        theirs = np.interp(sign * found.station[part], sign * place, deflection)
        ours: FloatArray = present(found.bending)[part]
        assert ours.max() > 0.02  # m: a bend to speak of
        assert theirs == pytest.approx(ours, abs=agreement * float(ours.max()))


@pytest.mark.parametrize("name", ["slalom", "giant-slalom", "carver"])
@pytest.mark.parametrize("hardness", [0.02, 0.2, 2.0])
def test_flat_ski_on_snow_that_does_not_pull(name: str, hardness: float) -> None:
    """EI(x), camber, shovel and width of the ski, a point load: depth and contact of both programs."""
    ski, load = read_ski(name), 800.0
    found = rest(ski, snow(hardness), edge_angle=0.0, load=load, clamp_length=0.0, elements=320)
    assert found.edge_depth is not None
    model = on_snow(ski, hardness * 1e9, load, elements=320)
    theirs, _ = model.depth()
    place = model.beam.place
    depth, slope = boot_pose(found, ski, 0.0)
    bending = np.interp(place, found.station[::-1], present(found.bending)[::-1])
    ours = depth + slope * place - model.base_height - bending
    greatest = float(theirs.max())
    below = (ours > 0.0) | (theirs > 0.0)
    assert theirs[below] == pytest.approx(ours[below], abs=WITHIN * greatest)
    assert depth == pytest.approx(float(np.interp(0.0, place, theirs)), abs=WITHIN * greatest)
    pressed = place[theirs > 0.0]
    assert found.contact_length == pytest.approx(float(pressed[-1] - pressed[0]), abs=0.01)  # two springs
    # deflection: what is left of the depth when the boot's own depth and slope are taken away
    bent = depth + slope * place - theirs - model.base_height
    assert bent == pytest.approx(bending, abs=WITHIN * float(np.ptp(bending)))
