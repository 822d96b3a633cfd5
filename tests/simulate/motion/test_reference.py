"""The compiled loops against the plain implementation of the same equations."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.simulate.judge.run_record import Record
from skisnow.simulate.judge.run_setup import Setup, set_up
from skisnow.simulate.motion.equations import add_forces, channel_rows
from skisnow.simulate.motion.forces import FRICTION, NORMAL, SHEAR, feel
from skisnow.simulate.motion.lines import ANCHORED, CELLS, KEPT, TOUCHED, WINDOW, cells_of
from skisnow.simulate.motion.model import PADDING
from skisnow.simulate.motion.system import factor, new_vector
from skisnow.simulate.motion.tangent import CHANNELS
from skisnow.simulate.scenario import read_scenario

from .reference import felt, free_forces, motion_of
from .reference_run import ReferenceRun, body_of
from .reference_snow import lines_of

FloatArray = npt.NDArray[np.float64]
COARSE: Mapping[str, object] = {"solver.fixed": True, "solver.elements": 12, "solver.line_spacing_mm": 48.0}


def under_way(changes: Mapping[str, object], *, seconds: float = 0.03) -> Setup:
    """The built-in carved turn with changes, a few steps after its start."""
    setup = set_up(read_scenario("carved-46m", changes={**COARSE, **changes}))
    assert Record(setup).advance(np.array([seconds])) is None
    return setup


def stirred(setup: Setup, rng: np.random.Generator, *, roll: float = 0.0, lift: float = 0.0) -> Setup:
    """The same, with every velocity and deflection disturbed, rolled over (rad) and lifted (m)."""
    state = setup.memory.state
    state.velocity[:] += rng.normal(size=6) * np.array([0.5, 0.5, 0.1, 0.3, 0.3, 0.3])
    size = state.bend.shape[1] - 2 * PADDING
    kind = np.tile([2e-3, 5e-3, 3e-2], size // 3)
    state.bend[:, PADDING:-PADDING] += rng.normal(size=(2, size)) * kind
    state.bend_rate[:, PADDING:-PADDING] += rng.normal(size=(2, size)) * 10.0 * kind
    c, s = np.cos(roll), np.sin(roll)
    state.turn[:] = state.turn @ np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    state.place[2] += lift
    return setup


def with_older_track(setup: Setup, rng: np.random.Generator) -> Setup:
    """Ragged grooves on every line, beside, across and under where the ski stands."""
    lines = setup.lines
    for row in np.flatnonzero(lines.flag[:, TOUCHED]):
        if lines.flag[row, KEPT] == 0:
            continue
        cell, first, size = lines.value[row, 0], int(lines.flag[row, WINDOW]), CELLS
        for j in range(first, first + size):
            if rng.uniform() < 0.7:
                ends = np.sort(rng.uniform(j * cell, (j + 1) * cell, 2))
                cells_of(lines, int(row))[:3, j - first] = rng.uniform(0.0, 0.01), *ends
    return setup


SITUATIONS: Mapping[str, Callable[[np.random.Generator], Setup]] = {
    "carving": lambda _: under_way({}),
    "carving to the right": lambda _: under_way({"sledge.edge_angle_deg": -30.0, "start.heading_deg": 30.0}),
    "sliding": lambda rng: stirred(under_way({"snow.S_f_N_per_mm2": 0.05}), rng),
    "flat": lambda _: under_way({"sledge.edge_angle_deg": 0.0, "snow.H_V_N_per_mm3": 0.02}),
    "hardly edged": lambda rng: stirred(under_way({"sledge.edge_angle_deg": 1.0}), rng),
    "twisted": lambda rng: stirred(under_way({"sledge.edge_angle_deg": 45.0, "mu_1_s_per_m": 0.01}), rng),
    "one ski off": lambda rng: stirred(under_way({}), rng, roll=0.1, lift=0.02),
    "no compaction": lambda rng: stirred(under_way({"snow.compaction_resistance": False}), rng),
    "elastic": lambda rng: stirred(under_way({"snow.penetration": "elastic"}), rng),
    "older track": lambda rng: with_older_track(stirred(under_way({}), rng), rng),
    "older track, flat": lambda rng: with_older_track(under_way({"sledge.edge_angle_deg": 0.5}), rng),
}


def as_one(rigid: FloatArray, bend: FloatArray) -> FloatArray:
    """Rigid body and padded skis as one vector."""
    return np.concatenate([rigid, bend[:, PADDING:-PADDING].ravel()])


def close(found: FloatArray, known: FloatArray, *, share: float) -> bool:
    """Within a share of the largest force, moments of the largest moment or that force at a metre."""
    kinds = (slice(0, 3), slice(3, 6), slice(6, None, 3), slice(7, None, 3), slice(8, None, 3))
    largest = [float(np.max(np.abs(known[kind]))) for kind in kinds]
    largest[1] = max(largest[0], largest[1])
    return all(
        np.max(np.abs(found[kind] - known[kind])) <= share * size for kind, size in zip(kinds, largest, strict=True)
    )


@pytest.mark.parametrize("name", SITUATIONS)
def test_forces(name: str) -> None:
    setup = SITUATIONS[name](np.random.default_rng(4))
    body, motion, lines = body_of(setup), motion_of(setup.memory.state), lines_of(setup.lines)
    out = setup.memory.start
    feel(setup.model, setup.snow, setup.lines, setup.memory.state, True, True, out)
    known = felt(body, setup.snow, float(setup.lines.spacing[0]), lines, motion)
    touched = [line.touch is not None for side in lines for line in side]
    assert sum(touched) > 5
    assert sum(touched) == setup.lines.flag[:, TOUCHED].sum()
    # rounding: depths of 1 mm are differences of places of 1 m, known to 2e-16 m, and k_u = 10 H_V multiplies them
    assert close(as_one(out.rigid, out.bend), known.force, share=1e-11)
    assert out.power[SHEAR] == pytest.approx(known.shear, rel=1e-11, abs=1e-9)
    assert out.power[FRICTION] == pytest.approx(known.friction, rel=1e-11, abs=1e-9)
    if setup.snow.compaction == 1.0:
        whole = float(known.force @ motion.speeds())
        parts = out.power[SHEAR] + out.power[FRICTION] + out.power[NORMAL]
        assert parts == pytest.approx(whole, rel=1e-11, abs=1e-8)
    forces = new_vector(body.size // 2 - 3)
    add_forces(setup.model, setup.world, setup.memory.state, out, 1.0, forces)
    assert close(as_one(forces.rigid, forces.bend), known.force + free_forces(body, setup.world, motion), share=1e-11)


@pytest.mark.parametrize("lift", [-2e-5, 2e-5])
@pytest.mark.parametrize("name", SITUATIONS)
def test_system(name: str, lift: float) -> None:
    """W = M + a K + b C: the compiled factors multiplied out are the dense matrix; going deeper, or on the way up."""
    setup = SITUATIONS[name](np.random.default_rng(4))
    # just pressed, or just yielding, rounding would choose the branch
    setup.memory.state.place[1:] += lift
    body, motion, lines = body_of(setup), motion_of(setup.memory.state), lines_of(setup.lines)
    out = setup.memory.start
    feel(setup.model, setup.snow, setup.lines, setup.memory.state, True, True, out)
    rows = np.zeros((2, CHANNELS, 6))
    channel_rows(setup.model, setup.lines, setup.memory.state, rows)
    assert factor(setup.model, out, rows, 3e-8, 2e-8, setup.memory.system)
    known = felt(body, setup.snow, float(setup.lines.spacing[0]), lines, motion)
    whole = body.mass + 3e-8 * body.stiffness + 2e-8 * known.tangent
    built = product_of_factors(setup)
    scale = np.sqrt(np.outer(np.diag(whole), np.diag(whole)))
    assert np.max(np.abs(built - whole) / scale) < 1e-12


def product_of_factors(setup: Setup) -> FloatArray:
    """The matrix that a system's factors stand for, multiplied out."""
    system = setup.memory.system
    n = system.band.shape[1] - 2 * PADDING
    lower, pivot = np.eye(6 + 2 * n), np.ones(6 + 2 * n)
    order = np.r_[6 : 6 + 2 * n, 0:6]
    for k in range(2):
        for i in range(n):
            at = k * n + i
            pivot[at] = 1.0 / system.band[k, i + PADDING, 0]
            for d in range(1, min(i, 5) + 1):
                lower[at, at - d] = system.band[k, i + PADDING, d]
            lower[2 * n :, at] = system.border[k, i + PADDING] / pivot[at]
    corner = np.tril(system.corner)
    corner[np.diag_indices(6)] = 1.0 / np.diag(corner)
    lower[2 * n :, 2 * n :] = corner
    whole = lower @ np.diag(pivot) @ lower.T
    back = np.argsort(order)
    return np.asarray(whole[np.ix_(back, back)])


HILL = "x,y\n" + "\n".join(f"{x},{-0.2 * x + 0.3 * np.sin(x / 3.0):.6f}" for x in np.arange(0.0, 40.0, 1.0))
RUNS: Mapping[str, Mapping[str, object]] = {
    "carved": {},
    "elastic": {"snow.penetration": "elastic"},
    "flat": {"sledge.edge_angle_deg": 0.0, "start.heading_deg": 10.0},
    "skidding": {"snow.S_f_N_per_mm2": 0.05, "mu_1_s_per_m": 0.003},
    "profile": {"slope.kind": "profile", "start.x_m": 5.0},
}


@pytest.mark.slow
@pytest.mark.parametrize("name", RUNS)
def test_run(name: str, tmp_path: Path) -> None:
    """Fifty steps of 0.5 ms: 17 cm of path, lines laid before the tip and left behind the tail."""
    changes = dict(RUNS[name])
    if name == "profile":
        (tmp_path / "hill.csv").write_text(HILL, encoding="utf-8")
        changes["slope.profile"] = str(tmp_path / "hill.csv")
    setup = set_up(read_scenario("carved-46m", changes={**COARSE, **changes}))
    reference = ReferenceRun(setup)
    for _ in range(50):
        reference.step(0.5e-3)
    Record(setup).advance(np.array([0.025]))
    assert setup.memory.clock.counts[0] == 50
    found, known = motion_of(setup.memory.state), reference.motion
    assert np.linalg.norm(found.place - setup.scenario.start.x) > 0.1
    # rounding of forces, 1e-12 of 400 N on parts of 10 g, times 25 ms: the skis' ends may differ by some 1e-13 m
    assert np.max(np.abs(found.place - known.place)) < 1e-10
    assert np.max(np.abs(found.turn - known.turn)) < 1e-10
    assert np.max(np.abs(found.bend - known.bend)) < 1e-9
    assert np.max(np.abs(found.velocity - known.velocity)) < 1e-8
    grooves = lines_of(setup.lines)
    for mine, theirs in zip(
        (line for side in reference.lines for line in side), (*grooves[0], *grooves[1]), strict=True
    ):
        assert np.allclose(mine.origin, theirs.origin, rtol=0.0, atol=1e-10)
        assert set(mine.cells) == set(theirs.cells)
        for j, cell in mine.cells.items():
            assert cell.deepest == pytest.approx(theirs.cells[j].deepest, abs=1e-9)
    assert any(line.anchor is not None for line in reference.lines[0])
    assert setup.lines.flag[:, ANCHORED].any()
