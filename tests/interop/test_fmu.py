"""FMUs through their C functions: the bits of the library and of a run, states, instances, refusals."""

import ctypes
import platform
import re
import sys
import xml.etree.ElementTree as ET
import zipfile
from collections import Counter
from collections.abc import Callable, Sequence
from functools import cache, partial
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from skisnow import BootMoment, BootPose, load_scenario, simulate
from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow.contact import Runner, SnowContact, SnowField
from skisnow.geometry.surfaces import Grid
from skisnow.interop import write_contact_fmu, write_sledge_fmu
from skisnow.interop.fmu import (
    UNITS,
    Version,
    _require_builtin_laws,
    _snow_parameters,
    contact_model,
    sledge_model,
)
from skisnow.scenario.snow_map import SnowMap
from skisnow.simulation.run_setup import laid_out
from skisnow.simulation.sledge_body import rotation
from skisnow.skier import BalancedSkier, Command, Posture, Seen
from tests.coded import raises
from tests.present import present

from .fmi import Fmu, Instance

pytestmark = pytest.mark.skipif(
    not sys.platform.startswith("linux") or platform.machine() != "x86_64",
    reason="FMUs hold a library for Linux on x86-64 alone",
)

SCENARIO = load_scenario("carved-46m").with_(duration_s=0.1)
STEP = 0.01
SIDES = ("left", "right")
SLEDGE_OUTPUTS = tuple(
    f"{name}[{i}]"
    for name, count in (
        ("position", 3),
        ("quaternion", 4),
        ("velocity", 3),
        *((f"{side}.boot_{what}", 3) for side in ("left", "right") for what in ("force", "moment")),
    )
    for i in range(1, count + 1)
)
MOVING_OUTPUTS = (*SLEDGE_OUTPUTS[:10], *(f"angular_velocity[{i}]" for i in (1, 2, 3)), *SLEDGE_OUTPUTS[10:])
BOOT_INPUTS = tuple(
    f"{side}.boot_{what}[{i}]"
    for side in SIDES
    for what, count in (("position", 3), ("quaternion", 4), ("velocity", 3), ("angular_velocity", 3))
    for i in range(1, count + 1)
)


Made = Callable[[str, Version], Fmu]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Made:
    """Each model by each version of the standard, written once."""
    folder = tmp_path_factory.mktemp("fmus")
    writers = {"sledge": write_sledge_fmu, "pair": write_contact_fmu}

    @cache
    def make(name: str, fmi: Version) -> Fmu:
        return Fmu(writers[name](SCENARIO, folder / f"{name}{fmi}.fmu", fmi=fmi), folder)

    return make


@pytest.fixture(params=[2, 3])
def sledge(request: pytest.FixtureRequest, made: Made) -> Fmu:
    return made("sledge", request.param)


@pytest.fixture(params=[2, 3])
def pair(request: pytest.FixtureRequest, made: Made) -> Fmu:
    return made("pair", request.param)


def steps(instance: Instance, first: int, last: int) -> None:
    for number in range(first, last):
        instance.step(number * STEP, (number + 1) * STEP - number * STEP)


def test_a_sledge_goes_as_the_run_does(sledge: Fmu) -> None:
    run = simulate(SCENARIO)
    instance = sledge.instance()
    instance.begin()
    for number in range(len(run.time)):
        found = instance.get(SLEDGE_OUTPUTS)
        assert np.array_equal(found[:3], run.place[number])
        assert rotation(found[3:7]) == pytest.approx(run.attitude[number], abs=1e-13)
        assert found[7:10] == pytest.approx(run.velocity[number], abs=1e-12)
        own = np.concatenate([present(run.boots).own_force[number], present(run.boots).own_moment[number]], axis=1)
        assert np.array_equal(found[10:], own.ravel())
        if number + 1 < len(run.time):
            steps(instance, number, number + 1)


class Swaying:
    """Edges that swing, balance by the capture point, hips, shift and toes that move."""

    def command(self, seen: Seen, posture: Posture, dt: float) -> Command:
        del posture, dt
        edge, sway = 0.15 * np.sin(6.0 * seen.time), seen.aside + seen.aside_rate / 3.5
        aside, toe = 12.0 * (seen.aside - 1.7 * sway), 0.05 * min(1.0, seen.time)
        return Command(
            (edge, edge), hip_torque=-20.0 * edge, ahead=2.0 * edge, aside=aside, pressure=1.7 * sway, load=800.0,
            toe=(-toe, toe),
        )  # fmt: skip


@pytest.mark.parametrize("fmi", [pytest.param(2, marks=pytest.mark.slow), 3])
def test_a_controller_outside_moves_the_boots_as_it_does_in_a_run(fmi: Version, tmp_path: Path) -> None:
    """Steps of the control's period: the observations, speeds, loads and edges are the same up to rounding."""
    changes = {"solver.method": "fast", "start.heading_deg": 5.0}
    scenario = load_scenario("skier-10deg", changes=changes).with_(duration_s=0.5)
    within, outside = BalancedSkier(scenario, Swaying()), BalancedSkier(scenario, Swaying())
    simulate(scenario, boots=within)
    instance = Fmu(write_sledge_fmu(scenario, tmp_path / "skier.fmu", fmi=fmi), tmp_path).instance()
    instance.begin()
    poses: Sequence[BootPose] = outside.posture.poses()
    period = outside.period
    for number in range(len(within.records)):
        out = instance.get(MOVING_OUTPUTS)
        turned, now = rotation(out[3:7]), number * period
        velocity = np.concatenate([turned.T @ out[7:10], turned.T @ out[10:13]])
        boots = np.array([pose.numbers.reshape(6, 3) for pose in poses])
        poses = outside(BootMoment(now, now + period, 0.0, out[:3], turned, velocity, boots, out[13:].reshape(2, 6)))
        instance.set(dict(zip(BOOT_INPUTS, np.concatenate([inputs_of(pose) for pose in poses]), strict=True)))
        instance.step(now, period)
    for own, other in zip(within.records, outside.records, strict=True):
        for name in ("place", "speed", "left", "right", "edge", "heading", "body_heading", "moment", "pressure"):
            assert getattr(other.seen, name) == pytest.approx(getattr(own.seen, name), rel=1e-6, abs=1e-6), name
    assert abs(within.records[-1].seen.aside) > 1e-3
    with pytest.raises(AssertionError, match="bytes"):
        instance.to_bytes(instance.state())


def inputs_of(pose: BootPose) -> FloatArray:
    """Place, quaternion and rates of a boot, as an FMU has them."""
    quaternion = np.roll(Rotation.from_matrix(pose.axes.T).as_quat(), 1)
    return np.concatenate([pose.place, quaternion, pose.velocity, pose.turning])


def test_a_sledge_is_pushed_and_begins_when_and_as_fast_as_it_is_reported(sledge: Fmu) -> None:
    one, pushed = sledge.instance(), sledge.instance()
    one.begin(5.0, {"start.speed": 3.0})
    pushed.begin(5.0, {"start.speed": 3.0, "push.force[1]": 800.0})
    assert one.get(["velocity[1]", "time"]) == pytest.approx([3.0 * np.cos(np.radians(30.0)), 5.0], abs=1e-4)
    for instance in (one, pushed):
        instance.step(5.0, 0.1)
    gained = pushed.get(["velocity[1]"]) - one.get(["velocity[1]"])
    along = np.cos(np.radians(30.0)) ** 2  # the skis take what is across them
    assert gained == pytest.approx(along * 800.0 * 0.1 / 88.0, rel=0.1)  # about 88 kg


def test_states_go_back_and_forth_and_instances_share_nothing(sledge: Fmu) -> None:
    """The later state is taken after an earlier one, and by another instance."""
    instance, other = sledge.instance(), sledge.instance()
    instance.begin()
    other.begin(values={"start.speed": 2.0})
    early = instance.state()
    steps(instance, 0, 2)
    late = instance.state()
    steps(instance, 2, 4)
    end = instance.get(SLEDGE_OUTPUTS)
    instance.restore(early)
    steps(instance, 0, 4)
    assert np.array_equal(instance.get(SLEDGE_OUTPUTS), end)
    instance.restore(late)
    steps(instance, 2, 4)
    assert np.array_equal(instance.get(SLEDGE_OUTPUTS), end)
    assert other.get(["velocity[1]"]) == pytest.approx([2.0 * np.cos(np.radians(30.0))], abs=1e-4)
    other.restore(late)
    steps(other, 2, 4)
    assert np.array_equal(other.get(SLEDGE_OUTPUTS), end)
    instance.forget(early)
    instance.forget(late)


def test_the_state_of_a_sledge_as_bytes_serves_another_instance(sledge: Fmu) -> None:
    """150 steps of 0.2 ms after that, with a push that begins later."""
    assert next(sledge.description.iter("CoSimulation")).attrib[f"canSerializeFMU{'sS'[sledge.fmi - 2]}tate"] == "true"
    instance, other = sledge.instance(), sledge.instance()
    untouched = instance.to_bytes(instance.state())
    instance.begin(1.0, {"start.speed": 6.0})
    for number in range(5):
        instance.step(1.0 + number * STEP, STEP)
    data = instance.to_bytes(instance.state())
    assert data != untouched

    def further(of: Instance) -> list[float]:
        rows = []
        for number in range(150):
            of.set({"push.force[2]": 50.0 * (number > 75)})
            of.step(1.05 + number * 2e-4, 2e-4)
            rows += [*of.get(["time", *SLEDGE_OUTPUTS])]
        return rows

    expected = further(instance)
    other.begin()
    steps(other, 0, 2)
    other.restore(other.from_bytes(data))
    assert further(other) == expected
    other.restore(other.from_bytes(untouched))
    other.begin(1.0, {"start.speed": 6.0})


def test_the_state_of_a_contact_as_bytes_serves_another_instance_over_older_tracks(made: Made) -> None:
    """Ahead for 2.4 m, then turned by 90° and across the two tracks that were left, 600 steps of 3 mm."""
    pair = made("pair", 3)
    outputs = [f"{side}.{what}[{i}]" for side in ("left", "right") for what in ("force", "moment") for i in (1, 2, 3)]
    instance, other, dt = pair.instance(), pair.instance(), 2.5e-4
    level = poses(pair, 0)
    crosswise = {f"{side}.quaternion[{i}]": np.sqrt(0.5) * (i in (1, 4)) for side in SIDES for i in (1, 2, 3, 4)}

    def go(of: Instance, number: int, place: dict[str, float]) -> None:
        of.set({f"{side}.{name}": value for side in SIDES for name, value in place.items()})
        of.step(number * dt, dt)

    start, height = level["left.position[1]"], level["left.position[3]"] - 2e-3
    instance.begin(values={"snow.hardness": 1.5e8} | level)
    for number in range(1200):
        go(instance, number, {"position[1]": start + 2e-3 * number, "position[3]": height})
    data = instance.to_bytes(instance.state())

    def across(of: Instance) -> list[float]:
        rows: list[float] = []
        for number in range(600):
            of.set(crosswise | {"left.position[1]": start + 0.4, "right.position[1]": start + 0.9})
            go(of, 1200 + number, {"position[2]": 3e-3 * number - 1.2, "position[3]": 0.5 if number == 0 else -1e-3})
            rows += [*of.get(outputs)]
        return rows

    expected = across(instance)
    other.begin(values=level)
    other.restore(other.from_bytes(data))
    assert across(other) == expected
    found = np.array(expected).reshape(600, 12)[50:, 2]
    assert found.min() < 0.97 * np.median(found)  # the older tracks carry less


def test_bytes_of_another_fmu_and_damaged_ones_are_rejected(pair: Fmu, made: Made) -> None:
    instance = pair.instance()
    instance.begin()
    data = instance.to_bytes(instance.state())
    same = made("pair", 3 if pair.fmi == 2 else 2).instance()  # by the other version of the standard
    same.restore(same.from_bytes(data))
    assert same.to_bytes(same.state()) == data
    for wrong, words in (
        (data[:-1], "damaged or not complete"),
        (data[:100] + b"?" + data[101:], "damaged or not complete"),
        (b"", "begin as none does"),
    ):
        with pytest.raises(AssertionError, match=words):
            instance.from_bytes(wrong)
    runs = made("sledge", 2).instance()
    with pytest.raises(AssertionError, match="another model"):
        runs.from_bytes(data)
    with pytest.raises(AssertionError, match="is NULL"):
        instance.to_bytes(ctypes.c_void_p())
    instance.set({"left.quaternion[1]": 3.0})
    with pytest.raises(AssertionError, match="a quaternion"):
        instance.step(0.0, 1e-3)
    with pytest.raises(AssertionError, match="has failed"):
        instance.to_bytes(instance.state())


def poses(fmu: Fmu, number: int) -> dict[str, float]:
    """Both skis ahead by 2 mm a step in a slight curve, deeper and deeper, from where they are at first."""
    values = {name: start for name, start in fmu.starts.items() if name.startswith(("left", "right"))}
    for side in ("left", "right"):
        values[f"{side}.position[1]"] += 2e-3 * number
        values[f"{side}.position[3]"] -= 2e-6 * number
        values[f"{side}.quaternion[1]"] += 1e-5 * number  # not quite a unit: it is made one
        values[f"{side}.velocity[1]"] = 8.0
    return {name: value for name, value in values.items() if not np.isnan(value)}


def test_a_contact_has_the_bits_of_the_library(pair: Fmu) -> None:
    setup = laid_out(SCENARIO)
    runner = Runner.of(SCENARIO.ski)
    contact = SnowContact(setup.snow, [runner, runner], spacing=setup.numbers["line_spacing_m"])
    outputs = [f"{side}.{what}[{i}]" for side in ("left", "right") for what in ("force", "moment") for i in (1, 2, 3)]
    instance = pair.instance()
    dt, accepted = 2.5e-4, 0.0
    instance.begin(values=poses(pair, 0))
    for number in range(150):
        values = poses(pair, number)
        instance.set(values)
        instance.step(number * dt, dt)
        rows = np.array(list(values.values())).reshape(2, 13)
        turned = np.array([rotation(q / np.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]))
                           for q in rows[:, 3:7]])  # fmt: skip
        if number == 0:
            contact.force(rows[:, :3], turned, rows[:, 7:], 0.0)
            contact.update(rows[:, :3], turned, 0.0)
        since = number * dt - accepted
        expected = contact.force(rows[:, :3], turned, rows[:, 7:], since).wrench
        contact.update(rows[:, :3], turned, since)
        accepted = number * dt
        assert np.array_equal(instance.get(outputs), expected.ravel()), number
    assert expected[0, 2] > 1000.0


def test_one_ski_in_snow_that_is_set(tmp_path: Path) -> None:
    fmu = Fmu(write_contact_fmu(SCENARIO, tmp_path / "ski.fmu", skis=1), tmp_path)
    forces = []
    for factor in (1.0, 2.0):
        instance = fmu.instance()
        instance.begin(values={"snow.hardness": factor * fmu.starts["snow.hardness"]})
        forces.append(instance.get(["ski.force[3]"])[0])
    assert fmu.starts["snow.hardness"] == 2e8
    assert forces[1] == pytest.approx(2.0 * forces[0], rel=0.01)  # but for the compaction resistance, which S_f has


def test_impossible_input_is_rejected(pair: Fmu, made: Made) -> None:
    assert pair.instance("{another}").at.value is None
    instance = pair.instance()
    with pytest.raises(AssertionError, match="not allowed"):
        instance.step(0.0, 1e-3)
    with pytest.raises(AssertionError, match="cannot be set"):
        instance.set({"left.force[1]": 1.0})
    with pytest.raises(AssertionError, match="not finite"):
        instance.set({"left.position[1]": float("nan")})
    with pytest.raises(AssertionError, match=r"snow\.hardness"):
        instance.begin(values={"snow.hardness": -1.0})
    instance.call("Reset")
    instance.begin()
    with pytest.raises(AssertionError, match="cannot be set"):
        instance.set({"snow.hardness": 1e8})
    instance.set({"left.quaternion[1]": 3.0})
    with pytest.raises(AssertionError, match="a quaternion"):
        instance.step(0.0, 1e-3)
    runs = made("sledge", 2).instance()
    runs.begin()
    with pytest.raises(AssertionError, match=r"at 1\.0+ s; .* at 0\.0+ s"):
        runs.step(1.0, 0.1)


def test_of_other_kinds_there_are_no_variables_and_of_what_is_not_offered_words(sledge: Fmu) -> None:
    instance = sledge.instance()
    nothing = ctypes.c_size_t(0)
    instance.call("GetBoolean", None, nothing, None, nothing)
    with pytest.raises(AssertionError, match="all variables"):
        instance.call("GetBoolean", None, ctypes.c_size_t(1), None, nothing)
    with pytest.raises(AssertionError, match="is not offered"):
        instance.call("GetDirectionalDerivative", None, nothing, None, nothing, None, None)


def test_an_fmu_has_the_same_bytes_and_no_python(tmp_path: Path) -> None:
    first = write_sledge_fmu(SCENARIO, tmp_path / "a.fmu")
    assert first.read_bytes() == write_sledge_fmu(SCENARIO, tmp_path / "b.fmu").read_bytes()
    with zipfile.ZipFile(first) as archive:
        names = {Path(name).suffix for name in archive.namelist()}
    assert names == {".xml", ".so", ".txt"}


def test_units_are_those_of_their_names() -> None:
    """Read off the name: a product of units, over another."""
    base = {"N": {"kg": 1, "m": 1, "s": -2}, "rad": {"rad": 1}, "kg": {"kg": 1}, "m": {"m": 1}, "s": {"s": 1}, "1": {}}
    for name, exponents in UNITS.items():
        above, _, below = name.partition("/")
        found: Counter[str] = Counter()
        for sign, text in ((1, above), (-1, below)):
            for unit, power in re.findall(r"([a-zA-Z]+|1(?=$))(\d?)", text):
                for each, exponent in base[unit].items():
                    found[each] += sign * int(power or 1) * exponent
        assert {each: power for each, power in found.items() if power} == exponents, name


def test_the_description_defines_every_unit_by_base_units(tmp_path: Path) -> None:
    with zipfile.ZipFile(write_sledge_fmu(SCENARIO, tmp_path / "a.fmu")) as archive:
        root = ET.fromstring(archive.read("modelDescription.xml"))
    told = {
        unit.attrib["name"]: {base: int(power) for base, power in unit[0].attrib.items()}
        for unit in root.iter("Unit")
        if unit[0].tag == "BaseUnit"
    }
    assert told == UNITS


def test_an_importer_that_is_reported_nothing_begins_at_0_in_steps_that_suit_the_model(tmp_path: Path) -> None:
    """A contact is read at a fifth of a millisecond, the outputs of a sledge are 10 ms apart."""
    for write, step in ((write_contact_fmu, "0.0002"), (write_sledge_fmu, "0.01")):
        with zipfile.ZipFile(write(SCENARIO, tmp_path / "a.fmu")) as archive:
            root = ET.fromstring(archive.read("modelDescription.xml"))
        experiment = present(root.find("DefaultExperiment"))
        assert experiment.attrib == {"startTime": "0", "stepSize": step}


def test_a_description_has_a_guid_and_says_which_variables_are_outputs(pair: Fmu) -> None:
    """By their places in the list in 2.0, from 1; by their references in 3.0."""
    hexadecimal = "[0-9a-f]"
    assert re.fullmatch(r"\{%s{8}(-%s{4}){3}-%s{12}\}" % ((hexadecimal,) * 3), pair.token)
    outputs = [name for name in pair.references if re.fullmatch(r"(left|right)\.(force|moment)\[[123]\]", name)]
    assert len(outputs) == 12
    names = list(pair.references)
    at = {str(names.index(name) + 1 if pair.fmi == 2 else pair.references[name]) for name in outputs}
    structure = present(pair.description.find("ModelStructure"))
    if pair.fmi == 2:
        told = {each.tag: [unknown.attrib["index"] for unknown in each] for each in structure}
        assert list(told) == ["Outputs", "InitialUnknowns"]
    else:
        told = {}
        for each in structure:
            told.setdefault(each.tag, []).append(each.attrib["valueReference"])
        assert list(told) == ["Output", "InitialUnknown"]
    assert [set(each) for each in told.values()] == [at, at]


def test_what_varies_over_the_place_is_not_offered() -> None:
    grid = Grid.along(np.arange(4.0), np.array([4e5, 5e5, 4e5, 5e5]))
    over = {"hardness": SnowMap(hardness=grid), "failure_shear_stress": SnowMap(failure_shear_stress=grid)}
    for name, snow_map in over.items():
        variables = _snow_parameters(laid_out(SCENARIO.with_(snow_map=snow_map)).snow)
        assert {each.name for each in variables if not each.offered} == {f"snow.{name}"}
    assert all(each.offered for each in _snow_parameters(laid_out(SCENARIO).snow))


@pytest.mark.parametrize("own", ["penetration", "friction_in_python", "shear_in_python"])
def test_laws_of_python_are_rejected(own: str) -> None:
    snow = SimpleNamespace(penetration=None, friction_in_python=None, shear_in_python=None)
    _require_builtin_laws(cast("SnowField", snow))
    setattr(snow, own, lambda: None)
    with raises(ParameterError, "no_data"):
        _require_builtin_laws(cast("SnowField", snow))


def test_every_variable_has_a_unit_that_is_defined_and_says_what_it_is() -> None:
    for model in (contact_model(SCENARIO, skis=2, step=STEP), sledge_model(SCENARIO, step=STEP)):
        assert {each.unit for each in model.variables} <= set(UNITS)
        assert all(each.about and each.about not in UNITS for each in model.variables)


@pytest.mark.parametrize("model", [partial(contact_model, skis=2), sledge_model])
def test_no_model_is_made_of_laws_in_python(model: Callable[..., object], monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(_: SnowField) -> None:
        raise ParameterError("an FMU has no Python in it")

    monkeypatch.setattr("skisnow.interop.fmu._require_builtin_laws", refused)
    with pytest.raises(ParameterError, match="no Python"):
        model(SCENARIO, step=STEP)


def test_wrong_names_numbers_and_scenarios_are_rejected(tmp_path: Path) -> None:
    with raises(ParameterError, "wrong_ending", ending=".fmu"):
        write_sledge_fmu(SCENARIO, tmp_path / "sledge.zip")
    with raises(ParameterError, "unknown_name", fmi=1):
        write_sledge_fmu(SCENARIO, tmp_path / "sledge.fmu", fmi=1)  # type: ignore[arg-type]
    with raises(ParameterError, "out_of_range", skis=3):
        write_contact_fmu(SCENARIO, tmp_path / "contact.fmu", skis=3)
    assert not list(tmp_path.iterdir())
