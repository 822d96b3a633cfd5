"""The search on problems whose answer is known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from skisnow.identification.search import CLOSED_FORM_SEARCH, Search, SearchOptions
from skisnow.identification.uncertainty import linear_uncertainty

FAR = np.full(2, 1e3)
Places = Sequence[np.ndarray]


def rosenbrock(places: Places) -> list[np.ndarray | None]:
    return [np.array([10.0 * (b - a * a), 1.0 - a]) for a, b in places]


def test_rosenbrocks_valley_ends_at_one_one() -> None:
    found = Search(rosenbrock, -FAR, FAR, replace(CLOSED_FORM_SEARCH, accuracy_is_stated=True)).run(
        np.array([-1.2, 1.0])
    )
    assert found is not None
    assert found.state == "converged"
    assert found.place == pytest.approx([1.0, 1.0], abs=1e-5)


def test_bounds_hold_as_in_bounded_linear_least_squares() -> None:
    rng = np.random.default_rng(1)
    design, wanted = rng.standard_normal((12, 3)), rng.standard_normal(12)
    low, high = np.full(3, -0.1), np.full(3, 0.15)
    found = Search(lambda many: [design @ each - wanted for each in many], low, high, CLOSED_FORM_SEARCH).run(
        np.zeros(3)
    )
    assert found is not None
    assert found.place == pytest.approx(lsq_linear(design, wanted, (low, high)).x, abs=1e-7)


def test_a_jacobian_of_a_search_is_asked_at_once() -> None:
    asked: list[int] = []

    def residuals(many: Places) -> list[np.ndarray | None]:
        asked.append(len(many))
        return [np.concatenate([each - 0.3, [each[0] * each[1]]]) for each in many]

    Search(residuals, -FAR, FAR, replace(SearchOptions(), candidates=2)).run(np.zeros(2))
    assert asked[0] == 3  # the start with one-sided differences
    assert set(asked[1:]) <= {2, 4}  # trial steps, central differences


def test_differences_are_taken_over_a_standard_error() -> None:
    """Residuals 40 x and 300 y of known noise: 1/40, and 1/300 limited to the smallest step."""
    asked: list[Places] = []

    def residuals(many: Places) -> list[np.ndarray | None]:
        asked.append(many)
        return [np.array([40.0 * (a - 0.3), 300.0 * (b - 0.2)]) for a, b in many]

    options = replace(
        SearchOptions(), accuracy_is_stated=True, keeps_jacobian=0.0, smallest_step=0.01, largest_step=0.05
    )
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

    found = Search(residuals, -FAR, FAR, CLOSED_FORM_SEARCH).run(np.array([-1.2, 1.0]))
    assert found is not None
    assert found.state == "interrupted"
    assert found.cost <= 24.2 + 1e-9  # of the start: 10² 0.44² + 2.2²


def test_places_without_residuals_are_avoided() -> None:
    """Nothing beyond 0.7; the least inside is at the border."""

    def residuals(many: Places) -> list[np.ndarray | None]:
        return [None if each[0] > 0.7 else each - 0.65 for each in many]

    found = Search(residuals, -FAR[:1], FAR[:1], CLOSED_FORM_SEARCH).run(np.zeros(1))
    assert found is not None
    assert found.place == pytest.approx([0.65], abs=1e-6)
    assert Search(lambda many: [None for _ in many], -FAR[:1], FAR[:1], CLOSED_FORM_SEARCH).run(np.zeros(1)) is None


def test_the_last_steps_go_with_other_residuals() -> None:
    """The quick ones miss by 0.1; the Jacobian is the same."""
    search = Search(
        lambda many: [each - 0.4 for each in many], -FAR, FAR, replace(CLOSED_FORM_SEARCH, accuracy_is_stated=True)
    )
    found = search.run(np.zeros(2))
    assert found is not None
    better = search.polish(found, lambda many: [each - 0.5 for each in many])
    assert better.place == pytest.approx([0.5, 0.5], abs=1e-9)


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
