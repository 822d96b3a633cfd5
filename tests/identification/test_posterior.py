"""Samples of the posterior: likelihoods of a linear problem by hand, and what the sampler is asked."""

from __future__ import annotations

import sys
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.identification import intervals
from skisnow.identification.parameter import Parameter

DESIGN = np.array([[1.0, 0.0], [0.0, 2.0], [1.0, 1.0]])
BEST, LEFT = np.array([0.25, -0.5]), np.array([0.1, -0.2, 0.3])
WIDENING = 1.5


def parameters() -> list[Parameter]:
    return [
        Parameter(key=f"friction.{name}", name=name, start=0.0, lower=-2.0, upper=2.0, size=1.0) for name in ("a", "b")
    ]


def solution(kind: str, *, bend: float = 0.0) -> Any:
    """Residuals LEFT + DESIGN d + ½ bend d², d from the best place; nothing is known where a is below -1."""

    def residuals(places: list[np.ndarray]) -> list[np.ndarray | None]:
        return [
            None if place[0] < -1.0 else LEFT + DESIGN @ (place - BEST) + 0.5 * bend * (place - BEST) ** 2 @ DESIGN.T
            for place in places
        ]

    problem = SimpleNamespace(parameters=parameters(), residuals=residuals, observations=[SimpleNamespace(kind=kind)])
    found = SimpleNamespace(place=BEST, residuals=LEFT, jacobian=DESIGN, second=bend * DESIGN)
    known = SimpleNamespace(standard_errors=np.array([0.1, 0.2]), groups=())
    return SimpleNamespace(problem=problem, optimum=found, widening=WIDENING, uncertainty=lambda: known)


@pytest.mark.parametrize("likelihood", [intervals._quadratic, intervals._true])
def test_likelihoods_of_normal_noise(likelihood: Any) -> None:
    """-χ²/2 over the square of the widening; outside the bounds nothing is likely."""
    found = likelihood(solution("track", bend=0.4))
    away = np.array([0.5, -0.25])
    left = LEFT + DESIGN @ away + 0.2 * DESIGN @ away**2
    assert found(np.array([BEST, BEST + away])) == pytest.approx(
        [-0.5 * (0.01 + 0.04 + 0.09) / 2.25, -0.5 * float(left @ left) / 2.25]
    )
    assert found(np.array([[2.1, 0.0], [0.0, -2.1], [2.0, -2.0]])).tolist()[:2] == [-np.inf, -np.inf]
    assert np.isfinite(found(np.array([[2.0, -2.0]]))).all()


def test_where_there_are_no_residuals_nothing_is_likely() -> None:
    assert intervals._true(solution("marks"))(np.array([[-1.5, 0.0], [-0.5, 0.0]])).tolist()[0] == -np.inf


class Sampler:
    """Stands where it began."""

    made: list[Sampler]

    def __init__(self, walkers: int, p: int, likelihood: Any, *, vectorize: bool) -> None:
        assert vectorize
        self.walkers, self.p, self.likelihood = walkers, p, likelihood
        Sampler.made.append(self)

    def sample(self, begin: np.ndarray, *, iterations: int) -> Any:
        self.begin, self.steps = begin, iterations
        return iter([begin] * iterations)

    def get_chain(self, *, discard: int, flat: bool) -> np.ndarray:
        assert flat
        return np.tile(self.begin, (self.steps - discard, 1))


@pytest.fixture
def sampler(monkeypatch: pytest.MonkeyPatch) -> list[Sampler]:
    module = ModuleType("emcee")
    vars(module)["EnsembleSampler"] = Sampler
    monkeypatch.setitem(sys.modules, "emcee", module)
    Sampler.made = []
    return Sampler.made


@pytest.mark.parametrize(
    ("kind", "told"), [("track", intervals.QUADRATIC_POSTERIOR), ("marks", intervals.EXACT_POSTERIOR)]
)
def test_about_so_many_samples_are_drawn_about_the_best_place(kind: str, told: str, sampler: list[Sampler]) -> None:
    said: list[str] = []
    places, words = intervals.posterior_places(solution(kind), 4000, np.random.default_rng(1), said.append)
    assert words == told
    assert places is not None
    (made,) = sampler
    assert (made.walkers, made.p) == (16, 2)
    assert len(places) == pytest.approx(4000, abs=2 * 16)
    assert said == [f"posterior: step {n} of {made.steps}" for n in range(1, made.steps + 1)]
    spread = made.begin - BEST
    assert np.abs(spread).max(axis=0) == pytest.approx([0.1, 0.2], rel=0.6)  # half a standard error each
    assert np.ptp(spread[:, 0]) > 0.05


def test_a_parameter_that_is_open_has_no_posterior(sampler: list[Sampler]) -> None:
    unknown = solution("marks")
    unknown.uncertainty = lambda: SimpleNamespace(standard_errors=np.full(2, np.inf), groups=((0, 1),))
    places, _ = intervals.posterior_places(unknown, 100, np.random.default_rng(1), lambda _: None)
    assert places is None
    assert sampler == []


def test_what_to_install_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "emcee", None)
    with pytest.raises(ParameterError, match=r"skisnow\[posterior\]"):
        intervals.require_emcee()
