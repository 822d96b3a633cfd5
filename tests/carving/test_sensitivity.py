"""Derivatives of a carve against differences of refined equilibria, at points that were drawn beforehand."""

import functools
import math
from dataclasses import dataclass, fields, replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow.carving.equilibrium import carve, differentiable_carve
from skisnow.carving.outputs import CarveRequest, output_growth
from skisnow.carving.result import Equilibrium, _edge_holds
from skisnow.carving.sensitivity import AT_KINK, CONDITIONS, CarveDerivatives
from skisnow.carving.solve import Solution, refined
from skisnow.ski import Ski, read_ski
from skisnow.ski.beam import GAUSS_POINTS, GAUSS_WEIGHTS, HALF_BANDWIDTH, ClampedSki, clamped
from skisnow.ski.editing import VALUES, shape_parameters, table_growth, varied_ski
from skisnow.ski.layout import SkiSections
from skisnow.ski.ski_file import ski_of_keys
from skisnow.snow import SnowProperties
from tests.coded import raises
from tests.present import present

from .synthetic import rigid_ski, snow

OUTPUTS = (
    "turn_radius_boot_m", "turn_radius_chord_m", "turn_radius_median_m", "edge_depth_mm", "grip_utilisation",
    "deflection_mm", "force_per_length_N_per_m", "contact_length_m",
)  # fmt: skip
STEPS = 0.01 / 3.0 ** np.arange(6)
"""Of a parameter. A difference counts with its error, that against the step before."""


def drawn(random: np.random.Generator) -> tuple[Ski, SnowProperties, dict[str, Any]]:
    """A ski of the catalogue with other widths, camber and stiffness, on some snow, in some turn."""
    keys: dict[str, Any] = dict(read_ski(str(random.choice(["slalom", "giant-slalom", "carver"]))).keys or {})
    for key in ("tip_width_mm", "waist_width_mm", "tail_width_mm"):
        keys[key] += random.uniform(-4.0, 4.0)
    keys["camber_mm"] = random.uniform(0.5, 12.0)
    keys["boot_position_mm"] = random.uniform(-30.0, 30.0)
    keys["base_bevel_deg"] = float(random.choice([0.0, random.uniform(0.3, 1.5)]))
    keys |= {
        "side_edge_deg": random.uniform(86.5, 88.5),
        "edge_radius_mm": random.choice([0.0, random.uniform(0.05, 0.45)]),
    }
    for key in ("EI_N_m2", "GJ_N_m2"):
        keys[key] = [each * random.uniform(0.7, 1.4) for each in keys[key]]
    hardness, ratio = np.exp(random.uniform(np.log([0.02, 1.05]), np.log([5.0, 50.0])))
    turn = {
        "edge_angle": math.radians(random.uniform(10.0, 70.0)),
        "load": random.uniform(300.0, 2500.0),
        "moment": random.uniform(-30.0, 30.0),
        "unloading_ratio": ratio,
        "moment_balance": str(random.choice(["boot", "free"])),
        "side_force_spread": str(random.choice(["depth", "base-reaction"])),
    }
    return ski_of_keys(keys), snow(hardness, random.uniform(0.1, 0.6)), turn


def derivatives(found: Equilibrium) -> CarveDerivatives:
    return CarveDerivatives(present(found.request))


@dataclass(frozen=True, eq=False)
class HeldSki:
    """A ski whose places stay between the rows of its tables that `rows` names by the shape of the places."""

    ski: Ski
    rows: dict[tuple[int, ...], Any]

    def __getattr__(self, name: str) -> Any:
        return getattr(self.ski, name)

    def at(self, place: FloatArray) -> SkiSections:
        names = [field.name for field in fields(SkiSections)[1:]]
        return SkiSections(np.asarray(place, float), *self.tables_at(place, *names))

    def tables_at(self, place: FloatArray, *names: str) -> tuple[FloatArray, ...]:
        station, where = self.ski.station, np.asarray(place, float)
        row = np.clip(np.searchsorted(-station, -where) - 1, 0, len(station) - 2)
        row = self.rows.setdefault(where.shape, row)
        share = (station[row] - where) / (station[row] - station[row + 1])
        tables = [getattr(self.ski, name) for name in names]
        return tuple(table[row] + share * (table[row + 1] - table[row]) for table in tables)


@functools.lru_cache(maxsize=4)
def rows_of_places(ski: Ski, clamp_length: float, elements: int) -> dict[tuple[int, ...], Any]:
    held = HeldSki(ski, {})
    clamped.__wrapped__(held, clamp_length, elements)
    return held.rows


def rounding_of_stiffness(model: ClampedSki, u: FloatArray) -> FloatArray:
    """Forces of the bent beam in long double, minus those of its stiffness matrix in double (size,)."""
    length = model.node[:-1] - model.node[1:]
    at = model.ski.at(model.node[:-1, None] - length[:, None] * GAUSS_POINTS)
    h, z, weight = length.astype(np.longdouble)[:, None], GAUSS_POINTS.astype(np.longdouble), GAUSS_WEIGHTS
    w_a, s_a, t_a, w_b, s_b, t_b = np.where(model.dof >= 0, u[model.dof], 0.0).astype(np.longdouble).T[:, :, None]
    shapes = (12.0 * z - 6.0) / h**2, (6.0 * z - 4.0) / h, (6.0 * z - 2.0) / h
    moment = weight * h * at.bending_stiffness * (shapes[0] * (w_a - w_b) + shapes[1] * s_a + shapes[2] * s_b)
    push, first, second = (np.sum(moment * shape, axis=1) for shape in shapes)
    torque = (at.torsional_stiffness @ weight) * ((t_b - t_a) / h)[:, 0]
    out, free = np.zeros(model.size, np.longdouble), model.dof >= 0
    np.add.at(out, model.dof[free], np.array([push, first, -torque, -push, second, torque]).T[free])
    around = np.pad(u.astype(np.longdouble), HALF_BANDWIDTH)
    windows = np.lib.stride_tricks.sliding_window_view(around, 2 * HALF_BANDWIDTH + 1)
    return np.asarray(out - np.sum(model.stiffness * windows, axis=1), float)


def moved(request: CarveRequest, near: Solution, name: str, change: float) -> FloatArray:
    """Outputs of the refined equilibrium with a parameter changed, on a mesh and tables that move with the ski.

    Differences need more digits than the stiffness matrix has, and no place that passes a row of the tables.
    """
    model, given, strength = request.model, request.conditions, request.strength
    if name in CONDITIONS:
        unit = {"edge_angle_deg": math.pi / 180.0, "snow.H_V_N_per_mm3": 1e9, "snow.S_f_N_per_mm2": 1e6}.get(name, 1.0)
        ratio = given.excess / given.hardness + (change if name == "unloading_ratio" else 0.0)
        angle = given.edge_angle + (unit * change if name == "edge_angle_deg" else 0.0)
        load = given.load + (change if name == "load_N" else 0.0)
        hardness = given.hardness + (unit * change if name == "snow.H_V_N_per_mm3" else 0.0)
        strength = (strength or 0.0) + (unit * change if name == "snow.S_f_N_per_mm2" else 0.0)
        free = given.pitch_of_shear != 0.0
        given = given._replace(
            edge_angle=angle,
            load=load,
            side_force=load * math.tan(angle),
            hardness=hardness,
            excess=hardness * ratio,
            moment=given.moment + (change if name == "moment_Nm" else 0.0),
            pitch_of_force=math.cos(angle) if free else 1.0,
            pitch_of_shear=math.sin(angle) if free else 0.0,
        )
    else:
        ski = varied_ski(model.ski, name, change)
        held = HeldSki(ski, rows_of_places(model.ski, model.clamp_length, request.elements))
        model = clamped.__wrapped__(held, model.clamp_length, request.elements)
        edge = ski.edge_shape
        given = given._replace(bevel=edge[0], bevel_width=edge[1], side=edge[2], radius=edge[3])
    point = refined(model, given, near)
    correction, u, border, depth, force = point.state()
    if not correction < 1e-13:
        return np.full(len(OUTPUTS), np.nan)
    if model is not request.model:
        none = np.zeros((5, len(depth))), np.zeros(14)
        by_u, by_border, by_depth, by_force, _ = point.growth(*none, rounding_of_stiffness(model, u))
        u, depth, force = u + by_u, depth + by_depth, force + by_force
        border = tuple(np.add(border, by_border))
    at = CarveRequest(model, given, strength, Solution(True, 0, u, *border, depth, force), request.elements)
    growths = [output_growth(output, at) for output in OUTPUTS]
    return np.array([np.nan if growth is None else growth.value for growth in growths])


def differences(request: CarveRequest, near: Solution, name: str, value: float) -> tuple[FloatArray, FloatArray]:
    """Derivatives of all outputs by Richardson extrapolation at the best of some steps, and their errors."""
    steps = STEPS * (abs(value) or 10.0) * (0.03 if name.endswith("length_mm") else 1.0)
    plain = [(moved(request, near, name, h) - moved(request, near, name, -h)) / (2.0 * h) for h in steps]
    found = [(9.0 * fine - coarse) / 8.0 for coarse, fine in pairwise(plain)]
    apart = np.abs(np.diff(found, axis=0))
    best = np.argmin(np.where(np.isnan(apart), np.inf, apart), axis=0)
    each = np.arange(len(OUTPUTS))
    return np.array(found)[best + 1, each], apart[best, each]


def comparisons(points: int, parameters: int, seed: int) -> dict[str, list[tuple[float, float]]]:
    """By parameter: error of the derivative, and of the reference, over max(|derivative|, |output/parameter|)."""
    random = np.random.default_rng(seed)
    out: dict[str, list[tuple[float, float]]] = {}
    for _ in range(points):
        ski, found_snow, turn = drawn(random)
        found = carve(ski, found_snow, **turn)
        names = random.permutation([*CONDITIONS, *shape_parameters(ski)])[:parameters]
        if found.request is None:
            continue
        exact = derivatives(found)
        for name in map(str, names):
            out.setdefault(name, []).extend(compared(exact, name))
    return out


def compared(exact: CarveDerivatives, name: str) -> list[tuple[float, float]]:
    """The same for each output of a carve."""
    value, pairs = exact.value(name), []
    reference, error = differences(exact.request, exact.at.solution, name, value)
    for output, by_differences, own_error in zip(OUTPUTS, reference, error, strict=True):
        if exact.output(output) is None:
            continue
        (by_adjoint,) = exact.sensitivity(output, [name])
        size = max(abs(by_adjoint.derivative), abs(by_adjoint.output_value / (value or 10.0)))
        pairs.append((abs(by_adjoint.derivative - by_differences) / size, own_error / size))
    return pairs


def require_agreement(found: dict[str, list[tuple[float, float]]], *, share: float) -> None:
    pairs = np.array([pair for each in found.values() for pair in each])
    counts = pairs[:, 1] < 1e-7
    assert np.mean(counts) >= share
    assert np.mean(pairs[counts, 0] < 1e-6) >= 0.99
    assert np.max(pairs[counts, 0]) < 1e-4


def test_derivatives_are_those_of_differences() -> None:
    require_agreement(comparisons(points=2, parameters=4, seed=3), share=0.8)


@pytest.mark.slow
def test_derivatives_at_200_points() -> None:
    found = comparisons(points=200, parameters=8, seed=58)
    require_agreement(found, share=0.9)
    for name, pairs in found.items():
        assert np.mean(np.array(pairs)[:, 1] < 1e-7) >= 0.7, name


def test_values_of_an_edit_have_the_derivatives_of_differences() -> None:
    """At both ends of the ski and between them, of each curve."""
    case: dict[str, Any] = {"edge_angle": 0.8, "load": 800.0, "unloading_ratio": 10.0}
    exact = derivatives(carve(read_ski("carver"), snow(0.21, 0.52), **case))
    require_agreement({name: compared(exact, name) for name in VALUES[::8]}, share=0.8)


def test_all_conditions_have_the_derivatives_of_differences() -> None:
    case: dict[str, Any] = {"edge_angle": math.radians(35.0), "load": 800.0, "moment": 10.0, "unloading_ratio": 10.0}
    exact = derivatives(carve(read_ski("slalom"), snow(0.21, 0.52), **case))
    require_agreement({name: compared(exact, name) for name in CONDITIONS}, share=0.8)


def test_a_row_that_is_almost_its_neighbour() -> None:
    """The curve of EI changes its form where two rows are equal: a step of the derivative must not cross that."""
    keys: dict[str, Any] = dict(read_ski("slalom").keys or {}) | {"EI_N_m2": [124.3, 202.8, 318.4, 318.2, 124.9]}
    ski = ski_of_keys(keys)
    for name in ("ski.EI_N_m2[3]", "ski.EI_N_m2[4]"):
        ends = [varied_ski(ski, name, side * 1e-3).bending_stiffness for side in (1.0, -1.0)]
        assert table_growth(ski, name).tables[3] == pytest.approx((ends[0] - ends[1]) / 2e-3, abs=1e-6)


def test_strength_and_mass_play_no_part_in_the_radius() -> None:
    found = carve(read_ski("slalom"), snow(0.21, 0.52), edge_angle=math.radians(45.0), load=800.0, unloading_ratio=10.0)
    (by_strength,) = found.sensitivity("turn_radius_boot_m", ["snow.S_f_N_per_mm2"])
    assert (by_strength.derivative, by_strength.kink) == (0.0, math.inf)
    (grip,) = found.sensitivity("grip_utilisation", ["snow.S_f_N_per_mm2"])
    assert grip.relative == pytest.approx(-1.0, rel=1e-12)


def test_at_a_kink_both_sides_have_their_derivative() -> None:
    """Followed to where another station becomes the source of the groove; each side against its own differences."""
    output, case = "force_per_length_N_per_m", {"edge_angle": math.radians(45.0), "unloading_ratio": 10.0}
    load, kink = 800.0, math.inf
    while kink > AT_KINK:
        exact = derivatives(carve(read_ski("slalom"), snow(0.21, 0.52), load=load, **case))  # type: ignore[arg-type]
        (found,) = exact.sensitivity(output, ["load_N"])
        assert (found.one_sided is None) == (found.kink > AT_KINK)
        kink, load = found.kink, load * (1.0 + found.kink)
    place, near, h = OUTPUTS.index(output), exact.at.solution, 4e-3
    for side, value in zip((-1.0, 1.0), present(found.one_sided), strict=True):
        one, two, three = (moved(exact.request, near, "load_N", side * n * h)[place] for n in (1.0, 2.0, 3.0))
        assert value == pytest.approx(side * (8.0 * two - 5.0 * one - 3.0 * three) / (2.0 * h), rel=1e-6)
    assert np.ptp(np.array(present(found.one_sided), float)) > 0.01
    elastic = derivatives(carve(read_ski("slalom"), snow(0.21, 0.52), load=800.0, edge_angle=0.5, unloading_ratio=1.0))
    assert elastic._beside("unloading_ratio", -1e-6, output) is None  # no snow is softer when it unloads


FORMS: list[dict[str, Any]] = [{"moment_balance": "free", "moment": 20.0}, {"side_force_spread": "base-reaction"}]


@pytest.mark.parametrize("form", FORMS)
def test_each_form_of_a_carve_has_its_outputs_and_derivatives(form: dict[str, Any]) -> None:
    """Those of `carve`; a known solution makes the search shorter if its mesh is the same."""
    ski, case = read_ski("slalom"), {"edge_angle": 0.8, "load": 800.0, "unloading_ratio": 10.0, **form}
    found, exact = carve(ski, snow(0.21, 0.52), **case), differentiable_carve(ski, snow(0.21, 0.52), **case)
    assert exact is not None
    radii = found.turn_radius_boot, found.turn_radius_chord, found.turn_radius_median
    known = (*radii, 1e3 * present(found.edge_depth).max(), found.grip_utilisation)
    assert [exact.output(name) for name in OUTPUTS[:5]] == pytest.approx(known, rel=1e-9)
    assert exact.output(OUTPUTS[6]) == pytest.approx(present(found.force_per_length).max(), rel=1e-9)
    assert exact.output(OUTPUTS[7]) == pytest.approx(found.contact_length, rel=1e-9)
    reference, _ = differences(exact.request, exact.at.solution, "edge_angle_deg", math.degrees(0.8))
    steeper = [exact.derivative(output, "edge_angle_deg") for output in OUTPUTS]
    assert steeper == pytest.approx(reference, rel=1e-6)
    searches = [
        differentiable_carve(ski, snow(0.21, 0.52), **case, elements=elements, near=near)
        for elements in (160, 80)
        for near in (None, exact.at.solution)
    ]
    cold, warm, coarse, other = [0 if each is None else each.request.solution.iterations for each in searches]
    assert 0 < warm < cold
    assert 0 < coarse == other


def test_outputs_that_do_not_exist() -> None:
    """A ski that lies in the snow to its tip has no ends of contact, a flat ski no side force."""
    drowned = derivatives(carve(read_ski("slalom"), snow(2e-3, 0.5), edge_angle=0.2, load=800.0, unloading_ratio=2.0))
    flat = derivatives(carve(read_ski("slalom"), snow(0.2, 0.5), edge_angle=0.0, load=800.0, unloading_ratio=2.0))
    missing = [[name for name in OUTPUTS if each.output(name) is None] for each in (drowned, flat)]
    assert missing == [[OUTPUTS[1], OUTPUTS[2], OUTPUTS[7]], [*OUTPUTS[:3], OUTPUTS[4]]]


@pytest.mark.parametrize("degrees", [30.0, 45.0])
def test_a_rigid_wedge_in_closed_form(degrees: float) -> None:
    """e = √(2 F tan ϑ/(H_V L)): half a per cent per per cent of the load, minus half of H_V; grip F tan ϑ/(S_f e L)."""
    angle = math.radians(degrees)
    case: dict[str, Any] = {"edge_angle": angle, "load": 800.0, "unloading_ratio": 10.0}
    known = snow(0.2)
    found = carve(rigid_ski(), known, **case)
    names = ["load_N", "snow.H_V_N_per_mm3", "unloading_ratio", "edge_angle_deg"]
    depth = [each.relative for each in found.sensitivity("edge_depth_mm", names)]
    grip = [each.relative for each in found.sensitivity("grip_utilisation", names)]
    steeper = angle / (math.sin(angle) * math.cos(angle))
    assert depth == pytest.approx([0.5, -0.5, 0.0, steeper / 2.0], abs=1e-6)
    assert grip == pytest.approx([0.5, 0.5, 0.0, steeper / 2.0], abs=1e-6)
    # intervals of H_V and S_f: a fifth and a tenth of each; grip grows as √H_V / S_f
    H, S = known.snow_hardness, present(known.failure_shear_stress)
    of_hardness = replace(known, snow_hardness_interval=(0.9 * H, 1.3 * H))
    of_both = replace(of_hardness, failure_shear_stress_interval=(0.8 * S, 1.0 * S))
    exact, value = derivatives(found), present(found.grip_utilisation)
    assert exact.changes_by_snow("grip_utilisation", of_both) == pytest.approx([0.1 * value, -0.1 * value], rel=1e-5)
    assert exact.half_interval("grip_utilisation", of_both) == pytest.approx(math.sqrt(0.02) * value, rel=1e-5)
    assert exact.half_interval("grip_utilisation", of_hardness) == pytest.approx(0.1 * value, rel=1e-5)
    assert exact.half_interval("grip_utilisation", known) is None


def test_facts_and_total_force_of_an_equilibrium() -> None:
    found = carve(rigid_ski(), snow(0.2), edge_angle=math.radians(30.0), load=700.0, unloading_ratio=1.0)
    assert found.total_force == pytest.approx(700.0 / math.cos(math.radians(30.0)), rel=1e-9)
    facts = found._repr_facts()
    texts = " ".join(text for _, text in facts.rows)
    assert facts.title == found.outcome
    for number in (present(found.side_force), present(found.contact_length), 1e3 * present(found.edge_depth).max()):
        assert f" {number:.4g} " in f" {texts}"
    turn = present(found.request).conditions
    assert [_edge_holds(turn, limit) for limit in (None, turn.side_force, 0.99 * turn.side_force)] == [
        False,
        True,
        False,
    ]
    assert _edge_holds(turn._replace(side_force=0.0), None)
    assert replace(found, side_force=None).total_force is None
    assert replace(found, forebody_load=None).total_force is None
    assert replace(found, afterbody_load=None).total_force is None


def test_fields_sum_to_the_derivative_by_a_factor_and_forces_grow_as_the_largest_does() -> None:
    found = carve(read_ski("slalom"), snow(0.21, 0.52), edge_angle=math.radians(45.0), load=800.0, unloading_ratio=10.0)
    exact = derivatives(found)
    fields = exact.fields("edge_depth_mm")
    model = exact.request.model
    length = model.node[:-1] - model.node[1:]
    for column, table in (("EI", "bending_stiffness"), ("GJ", "torsional_stiffness")):
        values = getattr(model.ski.at(fields["beam_m"]), table)
        (factor,) = exact.sensitivity("edge_depth_mm", [f"edit.{column}_N_m2"])
        assert fields[f"{column}_per_N_m3"] @ (length * values) == pytest.approx(factor.derivative, rel=2e-3)
    found = carve(read_ski("carver"), snow(0.21, 0.52), edge_angle=math.radians(45.0), load=800.0, unloading_ratio=10.0)
    exact = derivatives(found)
    for name in ("load_N", "ski.waist_width_mm", "ski.EI_N_m2[2]", "ski.boot_position_mm"):
        (largest,) = exact.sensitivity("force_per_length_N_per_m", [name])
        place = int(np.argmax(exact.at.solution.force_per_length))
        assert exact.force_growth(name)[place] == pytest.approx(largest.derivative, rel=1e-8, abs=1e-9)


def test_forces_at_places_grow_as_their_differences() -> None:
    """Also where the stations move with the ski: the places do not."""
    found = carve(read_ski("carver"), snow(0.21, 0.52), edge_angle=math.radians(45.0), load=800.0, unloading_ratio=10.0)
    exact, places = derivatives(found), np.array([-2.0, *np.linspace(-0.6, 0.6, 13), 2.0])  # also beyond the ski
    for name, step in (("ski.waist_width_mm", 1e-3), ("edge_angle_deg", 1e-4), ("ski.running_length_mm", 1e-2)):
        sides = [exact._moved(name, side * step) for side in (1.0, -1.0)]
        above, below = (side.force_at(places) for side in sides if side is not None)
        growth = exact.force_growth_at(name, places)
        assert (above - below) / (2.0 * step) == pytest.approx(growth, abs=2e-3 * np.abs(growth).max())


def test_forces_between_stations_that_move_are_interpolated_between_their_own() -> None:
    """A difference of numpy's interpolation, in which places and forces of all stations grow."""
    found = carve(read_ski("carver"), snow(0.21, 0.52), edge_angle=math.radians(45.0), load=800.0, unloading_ratio=10.0)
    exact, name, step = derivatives(found), "ski.running_length_mm", 1e-6
    moves = present(exact._parameter_derivatives(name).shape).place[::-1]
    grows, rising = exact.force_growth(name)[::-1], exact._rising_stations
    force, places = exact.at.solution.force_per_length[::-1], 0.3 * rising[:-1] + 0.7 * rising[1:]
    above, below = (np.interp(places, rising + h * moves, force + h * grows) for h in (step, -step))
    growth = exact.force_growth_at(name, places)
    assert growth == pytest.approx((above - below) / (2.0 * step), abs=1e-5 * np.abs(growth).max())


def test_a_neighbour_has_the_strength_of_its_parameter() -> None:
    """S_f that grows from 0.5 to 0.6 N/mm² alone changes the grip utilisation, by 5/6; a load changes it as well."""
    case: dict[str, Any] = {"edge_angle": math.radians(45.0), "load": 800.0, "unloading_ratio": 10.0}
    exact = derivatives(carve(rigid_ski(), snow(0.2, 0.5), **case))
    utilisation = present(exact.output("grip_utilisation"))
    stronger, loaded = exact._moved("snow.S_f_N_per_mm2", 0.1), exact._moved("load_N", 8.0)
    assert present(stronger).output("grip_utilisation") == pytest.approx(5.0 / 6.0 * utilisation, rel=1e-9)
    assert present(loaded).output("grip_utilisation") == pytest.approx(math.sqrt(1.01) * utilisation, rel=1e-6)


def test_everyday_parameters_are_those_of_turn_snow_and_outline() -> None:
    case: dict[str, Any] = {"edge_angle": math.radians(45.0), "load": 800.0, "unloading_ratio": 10.0}
    assert derivatives(carve(read_ski("carver"), snow(0.21), **case)).everyday_parameters == (
        "edge_angle_deg", "load_N", "moment_Nm", "unloading_ratio", "snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2",
        "ski.tip_width_mm", "ski.waist_width_mm", "ski.tail_width_mm", "ski.camber_mm",
        "edit.sidecut_depth", "edit.EI_N_m2", "edit.GJ_N_m2",
    )  # fmt: skip


def test_what_has_no_derivative_is_rejected() -> None:
    case: dict[str, Any] = {"edge_angle": math.radians(45.0), "load": 800.0, "unloading_ratio": 10.0}
    found = carve(read_ski("slalom"), snow(0.21), **case)
    with raises(ParameterError, "unknown_name", name="turn_radius"):
        found.sensitivity("turn_radius", ["load_N"])
    with raises(ParameterError, "unknown_name", name="ski.waist_mm"):
        found.sensitivity("edge_depth_mm", ["ski.waist_mm"])
    with raises(ParameterError, "no_derivatives"):
        carve(read_ski("slalom"), snow(0.21), **case, groove="path").sensitivity("edge_depth_mm", ["load_N"])
    edited = replace(read_ski("slalom"), width=1.01 * read_ski("slalom").width)
    with raises(ParameterError, "no_keys", ski="slalom"):
        carve(edited, snow(0.21), **case).sensitivity("edge_depth_mm", ["ski.waist_width_mm"])
