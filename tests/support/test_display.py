"""Objects as they are displayed, and arrays."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from typing import Any

import numpy as np
import pytest

import skisnow
from skisnow import SnowProperties, Track
from skisnow._support.messages import Message
from skisnow._support.units import Facts, Shown, field_facts
from skisnow.campaign.reference import reference_campaign
from skisnow.geometry.surfaces import Grid
from skisnow.geometry.vectors import applied, combined, cross, unit
from skisnow.identification import Identified, Parameter
from skisnow.report.turn.chain import EnsembleRun
from skisnow.report.turn.figures import TimedTrack
from skisnow.track.course import MovingPoint, passages

from ..report.runs import circle_run


def course_and_result() -> tuple[object, ...]:
    time = np.arange(0.0, 3.0, 0.1)
    gates = tuple(skisnow.Gate(name=str(i), turning=(8.0 * i, 1.0), side="right") for i in (1, 2))
    course = skisnow.Course(gates=gates)
    line = MovingPoint(time, np.column_stack([10.0 * time, np.zeros(len(time))]))
    return gates[0], course, passages(course, line, {})


def identified() -> skisnow.Identification:
    key = Parameter(key="friction.mu_0", name="mu_0", size=0.1, start=0.01, lower=0.0, upper=0.5)
    one = Identified(parameter=key, value=0.02, interval=(0.015, 0.025))
    many = np.zeros((400, 400))
    return skisnow.Identification(
        outcome="converged",
        reason=Message(""),
        scenario="carved-46m",
        parameters=(one,),
        correlation=many,
        covariance=many,
    )


def equilibrium() -> skisnow.Equilibrium:
    along = np.linspace(0.9, -0.9, 161)
    return skisnow.Equilibrium(
        "equilibrium", "", True, 800.0, 900.0, 12.5, 12.6, 12.7, 1.5, 1.4, 0.9, 420.0, 380.0, 0.0, along,
        0.002 * along, along, along, along, along, 1e-9, 1e-9, (), 8,
    )  # fmt: skip


@pytest.fixture(scope="module")
def objects(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """One of each public class, by its name."""
    folder = tmp_path_factory.mktemp("shown")
    campaign = reference_campaign(1).campaign()
    analysis = skisnow.analyse(campaign, n_resamples=100)
    run, scenario = circle_run(), skisnow.load_scenario("carved-46m")
    snow = analysis.snow("C", unloading_ratio=10)
    (folder / "study.toml").write_text('out = "t.csv"\nscenario = "carved-46m"\n[grid]\nmu_0 = [0.01, 0.02]\n')
    field = skisnow.SnowField(2e8, 5e5, 10.0)
    runner = skisnow.Runner(np.array([0.9, 0.0, -0.9]), np.full(3, 0.03), np.zeros(3))
    contact = skisnow.SnowContact(field, [runner])
    measured = replace(run.track, place=run.track.place + 0.01, name="measured")
    ensemble = [EnsembleRun(snow, "finished", TimedTrack(run.time, run.place[:, 0], run.place[:, 1]))] * 3
    made = (
        campaign, analysis, snow, scenario.ski, scenario, scenario.slope, scenario.contact, scenario.air,
        scenario.sledge, scenario.start, scenario.stop, scenario.solver, run,
        skisnow.Profile(np.arange(60.0), -0.2 * np.arange(60.0)),
        skisnow.Terrain(np.arange(9.0), np.arange(3.0), np.zeros((9, 3)), smoothing=2.0),
        *course_and_result(),
        skisnow.SnowMap(hardness=Grid.along([0.0, 9.0], [1e8, 2e8])),
        skisnow.Refinement("solver.step_ms", 1.0, 2.0, 0.1, "finished"), run.track, skisnow.GeodeticPoint(47.5, 11.25),
        skisnow.TurnChain(campaign="mine", site="site C", synthetic=True, snow=snow, runs={"one": run, "two": run},
                          ensemble=ensemble, seed=1),
        skisnow.track_summary(run.track), skisnow.compare(run.track, measured, fit=["start"]),
        skisnow.read_study(folder / "study.toml"), field, runner, contact,
        skisnow.StudyTable(("mu_0", "outcome"), [{"mu_0": 0.01, "outcome": "finished"}], ("mu_0",)),
        contact.force(np.zeros((1, 3)), np.eye(3)[None], np.zeros((1, 6)), 1e-3), identified(), equilibrium(),
        skisnow.BootPose.of(np.zeros(3), 0.5), skisnow.BootMoment(0.0, 0.01, 0.0, np.zeros(3), np.eye(3), np.zeros(6),
                                                                  np.zeros((2, 6, 3)), np.zeros((2, 6))),
        skisnow.Boots(np.arange(4.0), np.zeros((4, 2, 3)), np.tile(np.eye(3), (4, 2, 1, 1))),
        skisnow.race(skisnow.load_scenario("slalom-20-gates"), model="point", evaluations=1, workers=1),
        skisnow.Store(folder / "store", None),  # type: ignore[arg-type]
        skisnow.Design(scenario.ski, scenario.ski, {}, {}, {"sidecut_mm": -5.8}, (), True, (), (), 40),
    )  # fmt: skip
    return {type(each).__name__: each for each in made}


def test_every_public_class_is_looked_at(objects: dict[str, Any]) -> None:
    classes = {name: getattr(skisnow, name) for name in skisnow.__all__}
    shown = {name for name, each in classes.items() if isinstance(each, type) and not issubclass(each, Exception)}
    assert shown <= set(objects)


def test_every_public_object_and_its_parts_are_shown_below_ten_lines(objects: dict[str, Any]) -> None:
    for name, thing in objects.items():
        parts = [getattr(thing, each.name) for each in fields(thing)] if is_dataclass(thing) else []
        for each in (thing, *(part for part in parts if type(part).__module__.startswith("skisnow"))):
            lines = repr(each).splitlines()
            assert len(lines) < 10, (name, type(each))
            assert max(map(len, lines)) <= 200, (name, type(each))
            assert "array(" not in repr(each), (name, type(each))
        if isinstance(thing, Shown):
            html = thing._repr_html_()
            assert html.startswith("<table><caption ")
            assert html.split(">")[2].startswith(name)


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("Run", ["32 m in 4 s", "8 to 8 m/s", "12 m (median)", "mm"]),
        ("Scenario", ["30°", "80 kg", "N/mm³", "7 m/s"]),
        ("Analysis", ["H_V", "N/mm³", "S_f", "N/mm²", "experiments used"]),
        ("SnowProperties", ["N/mm³ (", "N/mm² (", "k_u/H_V 10"]),
        ("Comparison", ["m", "largest", "start: moved by"]),
        ("Equilibrium", ["800 N of 900 N: holds", "12.5 m", "at most 1.8 mm"]),
        ("Identification", ["0.02 (0.015 to 0.025)"]),
        ("Plane", ["angle_deg = 10"]),
        ("Solver", ["step_ms = 0.5", "tolerance_mm"]),
        ("Refinement", ["moves by 10 cm"]),
        ("Campaign", ["gauge step", "mm", "experiments"]),
    ],
)
def test_numbers_are_shown_with_their_units(name: str, told: list[str], objects: dict[str, Any]) -> None:
    shown = repr(objects[name])
    assert [each for each in told if each not in shown] == [], shown


def test_what_a_user_wrote_is_escaped_in_a_notebook() -> None:
    shown = SnowProperties(1e8, 2e5, source="<b>mine</b>")._repr_html_()
    assert "&lt;b&gt;mine" in shown
    assert "<b>" not in shown


class Rows(Shown):
    """As many rows as asked for."""

    def __init__(self, count: int, text: str = "x") -> None:
        self.count, self.text = count, text

    def _repr_facts(self) -> Facts:
        return Facts("", tuple((f"r{number}", self.text) for number in range(self.count)))


def test_eight_rows_are_shown_and_of_more_seven_and_the_names_of_the_rest() -> None:
    assert repr(Rows(8)).splitlines()[1:] == [f"  r{number}  x" for number in range(7)] + ["  r7  x>"]
    assert repr(Rows(10)).splitlines()[7:] == ["  r6    x", "  also  r7, r8, r9>"]


def test_a_line_has_up_to_120_letters() -> None:
    assert repr(Rows(1, "x" * 114)).splitlines()[1] == "  r0  " + "x" * 114 + ">"
    assert repr(Rows(1, "x" * 115)).splitlines()[1] == "  r0  " + "x" * 113 + "…>"


def test_lists_and_texts_are_shown_up_to_a_length() -> None:
    @dataclass
    class Thing:
        few: tuple[int, ...] = (1, 2, 3)
        many: tuple[int, ...] = (1, 2, 3, 4)
        by_name: Mapping[str, int] = field(default_factory=lambda: {"a": 1})
        fits: str = "x" * 60
        runs_over: str = "x" * 61
        share: float = 0.123456

    assert dict(field_facts(Thing(), {"share": "m"}).rows) == {
        "few": "(1, 2, 3)",
        "many": "4 entries",
        "by_name": "1 entries",
        "fits": "x" * 60,
        "runs_over": "x" * 59 + "…",
        "share": "0.1235 m",
    }


def test_a_track_of_many_points_is_shown_short() -> None:
    far = Track("far", np.arange(1e5), np.zeros((100_000, 3)), np.zeros(100_000), "UTC", "local")
    assert len(repr(far).splitlines()) < 10


def test_single_vectors_are_those_of_numpy() -> None:
    """Also the sign of the product: ahead by left is up."""
    random = np.random.default_rng(1)
    first, second, axes = random.normal(size=3), random.normal(size=3), random.normal(size=(3, 3))
    assert cross(first.tolist(), second.tolist()) == tuple(np.cross(first, second).tolist())
    assert combined(first.tolist(), axes.tolist()) == pytest.approx(first @ axes, abs=1e-15)
    assert applied(axes.tolist(), first.tolist()) == pytest.approx(axes @ first, abs=1e-15)
    assert unit(first.tolist()) == pytest.approx(first / np.linalg.norm(first), abs=1e-15)


def test_a_notebook_shows_values_of_snow_ski_run_and_answer(objects: dict[str, Any]) -> None:
    for name in ("Analysis", "Run", "Ski", "SnowProperties", "Equilibrium"):
        html = objects[name]._repr_html_()
        assert html.count("<tr>") >= 4, name
