"""The search on problems whose answer is known."""

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from skisnow._support.errors import ParameterError
from skisnow.identification.parameter import Parameter, parameter_table
from skisnow.identification.search import CLOSED_FORM_SEARCH, Search, SearchOptions
from skisnow.identification.solution import _neighbour_correlation
from skisnow.identification.uncertainty import linear_uncertainty
from skisnow.scenario import scenario_file, scenario_text
from skisnow.scenario.identify_section import given_parameters
from skisnow.scenario.keys import FREE_KEYS
from skisnow.scenario.reading import load_input
from tests.coded import raises
from tests.present import present

FAR = np.full(2, 1e3)
Places = Sequence[np.ndarray]


def rosenbrock(places: Places) -> list[np.ndarray | None]:
    return [np.array([10.0 * (b - a * a), 1.0 - a]) for a, b in places]


def test_rosenbrocks_valley_ends_at_one_one() -> None:
    found = present(
        Search(rosenbrock, -FAR, FAR, replace(CLOSED_FORM_SEARCH, accuracy_is_stated=True)).run(np.array([-1.2, 1.0]))
    )
    assert found.state == "converged"
    assert found.place == pytest.approx([1.0, 1.0], abs=1e-5)


def test_bounds_hold_as_in_bounded_linear_least_squares() -> None:
    rng = np.random.default_rng(1)
    design, wanted = rng.standard_normal((12, 3)), rng.standard_normal(12)
    low, high = np.full(3, -0.1), np.full(3, 0.15)
    found = present(
        Search(lambda many: [design @ each - wanted for each in many], low, high, CLOSED_FORM_SEARCH).run(np.zeros(3))
    )
    assert found.place == pytest.approx(lsq_linear(design, wanted, (low, high)).x, abs=1e-7)


def test_a_jacobian_of_a_search_is_asked_at_once() -> None:
    asked: list[int] = []

    def residuals(many: Places) -> list[np.ndarray | None]:
        asked.append(len(many))
        return [100.0 * np.concatenate([each - 0.3, [each[0] * each[1]]]) for each in many]

    Search(residuals, -FAR, FAR, replace(SearchOptions(), accuracy_is_stated=True)).run(np.zeros(2))
    assert asked[0] == 3  # the start with one-sided differences
    assert set(asked[1:]) == {1, 2}  # trial steps, one-sided differences


def test_differences_are_taken_over_a_standard_error() -> None:
    """Residuals 40 x and 300 y of known noise: 1/40, and 1/300 limited to the smallest step."""
    asked: list[Places] = []

    def residuals(many: Places) -> list[np.ndarray | None]:
        asked.append(many)
        return [np.array([40.0 * (a - 0.3), 300.0 * (b - 0.2)]) for a, b in many]

    options = replace(SearchOptions(), accuracy_is_stated=True, keeps_jacobian=0.0, smallest_step=0.01, central=True)
    Search(residuals, -FAR, FAR, options).run(np.zeros(2))
    central = [many for many in asked[1:] if len(many) == 4][-1]
    assert (central[0] - central[1]) / 2.0 == pytest.approx([0.025, 0.0])
    assert (central[2] - central[3]) / 2.0 == pytest.approx([0.0, 0.01])


def test_interrupts_keep_the_best_so_far() -> None:
    calls = 0

    def residuals(many: Places) -> list[np.ndarray | None]:
        nonlocal calls
        calls += 1
        if calls == 4:
            raise KeyboardInterrupt
        return rosenbrock(many)

    found = present(Search(residuals, -FAR, FAR, CLOSED_FORM_SEARCH).run(np.array([-1.2, 1.0])))
    assert found.state == "interrupted"
    assert found.cost <= 24.2 + 1e-9  # of the start: 10² 0.44² + 2.2²


def test_places_without_residuals_are_avoided() -> None:
    """Nothing beyond 0.7; the least inside is at the border."""

    def residuals(many: Places) -> list[np.ndarray | None]:
        return [None if each[0] > 0.7 else each - 0.65 for each in many]

    found = present(Search(residuals, -FAR[:1], FAR[:1], CLOSED_FORM_SEARCH).run(np.zeros(1)))
    assert found.place == pytest.approx([0.65], abs=1e-6)
    assert Search(lambda many: [None for _ in many], -FAR[:1], FAR[:1], CLOSED_FORM_SEARCH).run(np.zeros(1)) is None


def bent(many: Places, target: float = 0.4) -> list[np.ndarray | None]:
    """Residuals of three curved curves of 20 points, 0 at a = b = c = target."""
    t = np.linspace(0.1, 1.0, 20)
    aim = np.exp(target * t) + target * t**2
    return [200.0 * (np.exp(a * t) + 0.5 * (b + c) * t**2 - aim + 0.1 * (b - c) * t**3) for a, b, c in many]


def test_broydens_update_replaces_jacobians_on_the_way() -> None:
    """Two Jacobians of three runs each: at the start, 500 standard deviations off, and next to the minimum."""
    asked: list[Places] = []

    def residuals(many: Places) -> list[np.ndarray | None]:
        asked.append(many)
        return bent(many)

    far, options = np.full(3, 1e3), replace(SearchOptions(), accuracy_is_stated=True)
    found = present(Search(residuals, -far, far, options).run(np.zeros(3)))
    assert (found.state, found.rounds) == ("converged", 2)
    assert found.cost < 4.0  # 2 standard deviations, the tolerance
    assert [len(many) for many in asked].count(3) == 1
    (last,) = (many for many in asked if len(many) == 3)
    away = np.diag(last) - present(found.differentiated_at)
    assert np.abs(away) == pytest.approx(np.full(3, 0.02), abs=1e-9)  # one-sided, over the smallest step
    quick = present(Search(bent, -far, far, replace(options, renews=False)).run(np.zeros(3)))
    assert (quick.state, quick.rounds) == ("converged", 1)  # another search continues next to the minimum


def test_the_last_steps_use_the_jacobian_of_cheaper_residuals() -> None:
    """The cheap ones miss by 0.01; two or three of the expensive ones suffice.

    One-sided differences begin where the cheap search ended; two more are along b + c, which is hardly determined.
    """
    calls: list[int] = []
    cheap_calls: list[int] = []

    def counted(many: Places) -> list[np.ndarray | None]:
        cheap_calls.append(len(many))
        return bent(many)

    def expensive(many: Places) -> list[np.ndarray | None]:
        calls.append(len(many))
        return bent(many, 0.41)

    far, options = np.full(3, 1e3), replace(SearchOptions(), accuracy_is_stated=True, renews=False)
    found = present(Search(bent, -far, far, options).run(np.zeros(3)))
    options = replace(options, renews=True)
    last = Search(expensive, -far, far, replace(options, tolerance=0.2), differences=counted)
    better, apart = last.resume(found)
    assert better.cost < 0.1
    assert calls in ([1, 1], [1, 1, 1])
    assert cheap_calls == [3, 2]
    (cheap,), (dear,) = bent([better.place]), bent([better.place], 0.41)
    assert apart == pytest.approx(np.sqrt(np.mean((present(cheap) - present(dear)) ** 2)), rel=0.2)


def test_a_side_without_residuals_is_replaced_by_the_other() -> None:
    """Nothing above 0.01, less than a step of the differences: the slope is that of the other side."""
    options = replace(SearchOptions(), accuracy_is_stated=True, tolerance=0.2)
    found = present(Search(lambda many: [None if a > 0.01 else np.array([30.0 * a + 3.0]) for (a,) in many],
                   -FAR[:1], FAR[:1], options).run(np.zeros(1)))  # fmt: skip
    assert found.jacobian == pytest.approx(np.array([[30.0]]))
    assert found.place == pytest.approx([-0.1], abs=2e-5)  # the damping is 1e-5


def nearly_parallel(bend: float, asked: list[Places]) -> Any:
    """Residuals with two almost parallel columns, whose difference is 1/1000 of them, and the bend of one."""
    t = np.linspace(0.1, 1.0, 20)

    def residuals(many: Places) -> list[np.ndarray | None]:
        asked.append(many)
        return [100.0 * (a * t + b * (t + 1e-3 * t**2) - 0.5 * t + bend * t**2 * b**2) + 1.0 for a, b in many]

    return residuals


@pytest.mark.parametrize("lowest", [-2.0, 0.0])
def test_columns_hardly_told_apart_are_differentiated_along_their_difference(lowest: float) -> None:
    """Beside a bound, b = 0, on one side; inside, on both sides, which cancels the bend that hides the difference."""
    t, asked = np.linspace(0.1, 1.0, 20), list[Places]()
    options = replace(SearchOptions(), accuracy_is_stated=True)
    low = np.array([-2.0, lowest])
    search = Search(nearly_parallel(0.1 if lowest else 0.0, asked), low, np.full(2, 2.0), options)
    begun = present(search._differentiate(np.zeros(2)))
    renewed = search._sharpened(begun)
    assert renewed.jacobian is not None
    wanted = 100.0 * np.column_stack([t, t + 1e-3 * t**2])
    errors = [linear_uncertainty(jacobian, degrees_of_freedom=None).alone[0] for jacobian in (renewed.jacobian, wanted)]
    assert errors[0] == pytest.approx(errors[1], rel=0.01)
    weakest = [np.linalg.svd(jacobian, compute_uv=False)[-1] for jacobian in (renewed.jacobian, wanted)]
    assert weakest[0] == pytest.approx(weakest[1], rel=0.02)
    assert [len(many) for many in asked] == [3, 2]


def test_uncertainty_is_that_of_linear_least_squares() -> None:
    rng = np.random.default_rng(2)
    design = rng.standard_normal((20, 3)) * np.array([1e-3, 1.0, 1e4])
    found = linear_uncertainty(design, degrees_of_freedom=None)
    covariance = np.linalg.inv(design.T @ design)
    assert found.covariance == pytest.approx(covariance, rel=1e-8)
    assert found.correlation[0, 2] == pytest.approx(covariance[0, 2] / np.sqrt(covariance[0, 0] * covariance[2, 2]))
    assert found.alone == pytest.approx(1.0 / np.linalg.norm(design, axis=0))
    assert not found.groups


def test_parallel_columns_are_named_together_and_dead_ones_alone() -> None:
    t = np.linspace(0.0, 1.0, 9)
    found = linear_uncertainty(np.column_stack([t, 0.0 * t, 2.0 * t, 1.0 + t**2]), degrees_of_freedom=5.0)
    assert set(found.groups) == {(1,), (0, 2)}
    assert found.unknown.tolist()[:3] == [True, True, True]
    assert np.isinf(found.standard_errors[:3]).all()
    assert np.isfinite(found.standard_errors[3])
    assert found.factor == pytest.approx(2.570582, abs=1e-6)  # Student's t with 5 degrees of freedom


VALUES = scenario_file("carved-46m").values


def test_bounds_that_exclude_the_start_are_rejected() -> None:
    section = given_parameters({"mu_0": {"lower": 0.02, "upper": 0.3}})
    with raises(ParameterError, "start_outside_bounds"):
        parameter_table(["friction.mu_0"], VALUES, section)


@pytest.mark.parametrize(
    ("table", "told"),
    [
        ({"mu_0": {"begin": 0.1}}, "start"),
        ({"mu_0": {"prior_mean": 0.1}}, "prior_sd"),
        ({"mu_0": {"prior_mean": 0.1, "prior_sd": 0.0}}, "above 0"),
        ({"mu_0": {"lower": 0.3, "upper": 0.2}}, "below upper"),
        ({"mu_0": {"upper": True}}, "upper is True"),
        ({"mu_0": 0.3}, "must be a table"),
        ({"muu_0": {"upper": 0.3}}, r"mean mu_0\?"),
        ({"S_f": {"lower": -1.0}}, "allowed is above 0"),
    ],
)
def test_what_is_wrong_in_the_section_is_named(table: dict[str, object], told: str) -> None:
    with pytest.raises(ParameterError, match=told):
        parameter_table(["friction.mu_0", "snow.S_f_N_per_mm2"], VALUES, given_parameters(table))


def test_start_bounds_and_prior_come_from_the_section(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    section = (
        '[identify."snow.S_f_N_per_mm2"]\nstart = 0.3\nlower = 0.1\nupper = 1.0\nprior_mean = 0.4\nprior_sd = 0.05\n'
    )
    path.write_text(scenario_text("carved-46m") + section, encoding="utf-8")
    given = load_input(path)
    (found,) = parameter_table(["snow.S_f_N_per_mm2"], VALUES, given_parameters(given.identify))
    assert (found.start, found.lower, found.upper, found.prior_mean, found.prior_sd) == (0.3, 0.1, 1.0, 0.4, 0.05)
    assert found.prior_residual(0.5) == pytest.approx(2.0)
    assert given.changed({"friction.mu_0": 0.02}).identify == given.identify
    assert scenario_file(path).scenario.contact.snow.failure_shear_stress == 0.5e6  # a run does not heed it


def test_a_section_that_is_no_table_is_rejected(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text("identify = 3\n" + scenario_text("carved-46m"), encoding="utf-8")
    with pytest.raises(ParameterError, match="identify is 3"):
        load_input(path)


def test_logarithmic_parameters_count_in_factors() -> None:
    hardness = Parameter(
        key="snow.H_V_N_per_mm3", name="H_V", start=0.2, lower=0.02, upper=2.0, size=2.0, logarithmic=True
    )
    assert hardness.scaled(0.2 * math.e) == pytest.approx(0.5)
    assert hardness.value(-0.5) == pytest.approx(0.2 / math.e)
    assert hardness.slope(0.4) == pytest.approx(0.8)
    assert hardness.value(100.0) == 2.0


def test_every_key_that_has_a_value_can_be_looked_for() -> None:
    for key in FREE_KEYS:
        if VALUES[key] is not None:
            (found,) = parameter_table([key], VALUES, {})
            assert found.lower <= found.start <= found.upper


def solution(residuals: Any, *series: tuple[str, int]) -> Any:
    observations = [SimpleNamespace(kind=kind, series=(length,)) for kind, length in series]
    return SimpleNamespace(
        problem=SimpleNamespace(observations=observations), optimum=SimpleNamespace(residuals=np.asarray(residuals))
    )


def test_neighbours_that_are_the_same_have_a_correlation_of_one() -> None:
    """Ten pairs at least."""
    assert _neighbour_correlation(solution(np.ones(11), ("track", 11))) == pytest.approx(1.0)
    assert _neighbour_correlation(solution(np.ones(10), ("track", 10))) is None
    assert _neighbour_correlation(solution(np.tile([1.0, -1.0], 10), ("track", 20))) is None
    assert _neighbour_correlation(solution(np.zeros(20), ("track", 20))) is None


def test_two_series_have_no_pair_between_them() -> None:
    """Nine pairs of 1 and nine of 2: (9 + 36)/(10 · 0.9 + 40 · 0.9) = 1; one of 1 and the other of -1 as well."""
    residuals = np.concatenate([np.ones(10), np.full(10, -2.0)])
    assert _neighbour_correlation(solution(residuals, ("track", 10), ("track", 10))) == pytest.approx(1.0)
