"""What is kept of a run under way, moment by moment."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from skisnow.dynamics import Ended
from skisnow.scenario import Plane, load_scenario
from skisnow.simulation.moving_boots import StrengthDrive
from skisnow.simulation.run_record import Record
from skisnow.simulation.run_setup import Setup, set_up


def chords(record: Record) -> float:
    """Chord lengths in a turn of about 16 m radius, whose arcs of 0.1 m are two millionths longer."""
    return float(np.linalg.norm(np.diff(record.histories()["place"], axis=0), axis=1).sum())


def test_moments_are_kept_replaced_and_dropped() -> None:
    record = Record(set_up(load_scenario("carved-46m")))
    assert record.run_length == 0.0
    assert record.advance(0.01) is None
    record.advance(0.03)
    assert record.run_length == pytest.approx(chords(record), rel=1e-5)
    record.advance(0.035, replace=True)
    assert record.histories()["time"] == pytest.approx([0.0, 0.01, 0.035], abs=1e-12)
    assert record.run_length == pytest.approx(chords(record), rel=1e-5)
    record.advance(0.04)
    record.drop()
    assert record.run_length == pytest.approx(chords(record), rel=1e-5)
    record.drop()
    record.drop()
    assert record.histories()["time"].tolist() == [0.0]


def test_stored_and_lost_energies_are_separate() -> None:
    """Stored: kinetic, potential, skis, snow with what sticks, delayed depth; then losses and energies given."""
    dynamics: Any = SimpleNamespace(
        snow_energies=(5.0, 3.0, 0.25, 0.5), energies=(100.0, 200.0, 7.0), work=(10.0, 20.0, -30.0, 4.0, 5.0, 6.0),
        snow_losses=(19.5, 9.0, 19.75, 6.5, 0.0), work_given=(8.0, 9.0), body=SimpleNamespace(skis=()), time=0.0,
        position=np.zeros(3), rotation=np.eye(3), boots=None, boot_wrench=None, beam_dofs=np.zeros((0, 0)),
        pushes=np.zeros((0, 3)),
    )  # fmt: skip
    setup: Any = SimpleNamespace(dynamics=dynamics, place=np.zeros(3), attitude=np.eye(3), velocity=np.zeros(3))
    stored, lost = (100.0, 200.0, 7.0, 8.25, 0.5), (19.5, 9.0, 19.75, 4.0, 5.0, 6.5)
    assert Record(setup)._present().energies == (*stored, *lost, 8.0, 9.0)


def test_forces_of_friction_are_sums_over_the_sections() -> None:
    record = Record(set_up(load_scenario("carved-46m", changes={"friction.mu_0": 0.1})))
    record.advance(0.03)
    dynamics = record.setup.dynamics
    for ski, pushes in enumerate(dynamics.pushes):
        sections = dynamics.contact.sections(ski)
        sums = [float(force.sum()) for force in (sections.push, sections.push_across, sections.push_off)]
        assert sums[0] < -10.0
        assert pushes == pytest.approx(sums, rel=1e-12)


def test_what_is_told_of_the_skis_is_what_the_beams_and_boots_have() -> None:
    """Deflection and twist at the free nodes; a stance between the edges at the boots."""
    scenario = load_scenario("carved-46m", changes={"start.x_m": 3.0, "start.y_m": -2.0, "start.heading_deg": 0.0})
    setup = set_up(scenario)
    skis = Record(setup).histories()["skis"]
    free = setup.dynamics.body.skis[0].unknown >= 0
    dofs = setup.dynamics.beam_dofs.reshape(2, -1, 3)
    assert skis.bending[0][:, free].tolist() == dofs[:, :, 0].tolist()
    assert skis.twist[0][:, free].tolist() == dofs[:, :, 2].tolist()
    assert np.abs(dofs[:, :, 0]).max() > 1e-3
    left, right = skis.track[0]
    stance, width = scenario.sledge.stance_width, float(scenario.ski.at(0.0).width)
    assert left[1] - right[1] == pytest.approx(stance, rel=0.05)
    assert 0.5 * (left + right)[:2] == pytest.approx([3.0, -2.0 + 0.5 * width], abs=0.5 * width)
    assert (left[2], right[2]) == (0.0, 0.0)


def test_the_track_of_a_ski_is_its_lower_edge_and_its_middle_where_it_is_flat() -> None:
    """A ski 0.3 m to the left of its boots' middle, 0.06 m wide, rolled by 0.2 rad to either side about its way."""
    ski = SimpleNamespace(boot=np.array([0.0, 0.3, -0.05]), axes=np.eye(3))
    parts: Any = SimpleNamespace(
        scenario=SimpleNamespace(
            ski=SimpleNamespace(at=lambda _: SimpleNamespace(width=0.06, base_height=0.02)), slope=Plane(0.4)
        ),
        dynamics=SimpleNamespace(body=SimpleNamespace(skis=[ski])),
    )
    place = np.tile([5.0, 1.0, 0.03], (3, 1))
    attitude = Rotation.from_rotvec([[0.0, 0.0, 0.0], [0.2, 0.0, 0.0], [-0.2, 0.0, 0.0]]).as_matrix()
    found = Record._tracks(cast("Any", SimpleNamespace(setup=parts)), place, attitude)
    cos, sin = math.cos(0.2), math.sin(0.2)
    aside = [1.3, 1.0 + 0.27 * cos + 0.03 * sin, 1.0 + 0.33 * cos - 0.03 * sin]
    assert found[:, 0] == pytest.approx(np.array([[5.0, y, 0.0] for y in aside]), abs=1e-12)


class _Clock:
    """Dynamics that are a time and the outputs on the way to it."""

    def __init__(self) -> None:
        self.time, self.position, self.way = 0.0, np.zeros(3), [0.0]

    def advance(self, until: float) -> Ended:
        self.time = until
        self.way.append(until)
        return Ended.REACHED

    def state(self) -> tuple[float, list[float]]:
        return self.time, list(self.way)

    def restore(self, state: tuple[float, list[float]]) -> None:
        self.time, self.way = state[0], list(state[1])


def test_outputs_between_the_times_of_a_drive_leave_no_trace() -> None:
    """Called every 10 ms, whatever the outputs; after an output in between the steps begin at the state before it."""
    calls: list[float] = []

    def share(_: float) -> float:
        calls.append(dynamics.time)
        return 1.0

    dynamics, nothing = _Clock(), cast("Any", SimpleNamespace())
    setup = Setup(nothing, cast("Any", dynamics), nothing, np.zeros(3), {}, 0.0)
    snow = cast("Any", SimpleNamespace(compiled=SimpleNamespace()))
    setup.strength = StrengthDrive(share, snow)
    reached = []
    for output in (0.004, 0.008, 0.01, 0.025, 0.05):
        assert setup.advance(output, 0.0) is Ended.REACHED
        reached.append(dynamics.time)
    assert reached == pytest.approx([0.004, 0.008, 0.01, 0.025, 0.05])
    assert calls == pytest.approx([0.0, 0.01, 0.02, 0.03, 0.04])
    assert dynamics.way == pytest.approx([0.0, 0.01, 0.02, 0.03, 0.04, 0.05])
