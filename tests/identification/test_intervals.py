"""The bootstrap: samples against refits by another program, interrupts, what is refused."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import least_squares

from skisnow._support.errors import ParameterError
from skisnow._support.messages import Message
from skisnow.identification import Identification, identify, intervals
from skisnow.identification.intervals import _resample, add_bootstrap_intervals
from skisnow.identification.parameter import Parameter
from skisnow.identification.problem import Fit, Kind, Problem, Values
from skisnow.identification.solution import BootstrapBy, SearchRequest, build_identification
from skisnow.identification.solving import Solver
from tests.coded import raises
from tests.present import present

from . import straight_tracks
from .straight_tracks import SCENARIO, track

X = np.linspace(0.0, 2.0, 25)
SD = 0.2


class Decay:
    """y = a exp(-b x), far from linear in b with so much noise."""

    kind: Kind = "photo_cells"
    used_keys: tuple[str, ...] | None = ("a", "b")
    nuisances = 0
    accuracy_is_stated = True
    points = len(X)
    series: tuple[int, ...] = (len(X),)

    def __init__(self, seed: int) -> None:
        self.y = 2.0 * np.exp(-1.5 * X) + SD * np.random.default_rng(seed).standard_normal(len(X))

    def residuals(self, many: Sequence[Values], *, final: bool = False) -> list[np.ndarray | None]:  # noqa: ARG002
        return [(each["a"] * np.exp(-each["b"] * X) - self.y) / SD for each in many]

    def fits(self, values: Values) -> tuple[Fit, ...]:  # noqa: ARG002
        return ()

    def warnings(self, values: Values) -> tuple[Message, ...]:  # noqa: ARG002
        return ()


def resampled(by: BootstrapBy, seed: int) -> tuple[Decay, Identification]:
    decay = Decay(seed)
    parameters = tuple(Parameter(key=key, name=key, start=1.0, lower=0.01, upper=20.0, size=1.0) for key in ("a", "b"))
    rng = np.random.default_rng(3)
    plan = SearchRequest(title="", starts=1, profile=False, bootstrap=0, posterior=0, rng=rng, progress=lambda _: None)
    solution = Solver(Problem(parameters, (decay,), noise=(1.0,)), plan).solution()
    plan = replace(plan, bootstrap=80, bootstrap_by=by, rng=np.random.default_rng(4))
    return decay, add_bootstrap_intervals(build_identification(solution, plan), solution, plan)


def test_drawn_errors_have_zero_mean() -> None:
    """Each series without its own mean: of constant ones nothing is left."""
    residuals = np.concatenate([np.full(7, 3.0), np.full(5, -2.0)])
    assert _resample(residuals, [7, 5], np.random.default_rng(1)).tolist() == [0.0] * 12
    rising = _resample(np.arange(9.0) + 5.0, [9], np.random.default_rng(1))
    assert set(rising.tolist()) <= set((np.arange(9.0) - 4.0).tolist())


def refits_by_scipy(decay: Decay, found: Identification, linear: np.ndarray) -> np.ndarray:
    """The same resamples fitted by another program.

    The draws follow from the linear samples' own draws: the same numbers in the same order.
    """
    a, b = (float(found[key].value or 0.0) for key in ("a", "b"))
    best = present(decay.residuals([{"a": a, "b": b}])[0])
    rng = np.random.default_rng(4)
    inflated = np.sqrt(len(X) / (len(X) - 2))
    refits = []
    for _ in linear:
        drawn = inflated * _resample(best, [len(X)], rng)
        rng.standard_normal(0)

        def residuals(place: np.ndarray, drawn: np.ndarray = drawn) -> np.ndarray:
            return (place[0] * np.exp(-place[1] * X) - a * np.exp(-b * X)) / SD + drawn

        refits.append(least_squares(residuals, [a, b], bounds=([0.01, 0.01], [20.0, 20.0]), xtol=1e-12).x)
    return np.array(refits)


def test_samples_are_those_of_refits_by_another_program() -> None:
    """Nine of ten within 2 % of a standard error: derivatives also change in ways that the steps do not know.

    The linearised model is off by ten times as much.
    """
    decay, found = resampled("refit", 1)
    linear = present(resampled("linear", 1)[1].bootstrap)
    wanted = refits_by_scipy(decay, found, linear)
    error = np.std(wanted, axis=0)
    assert np.all(np.quantile(np.abs(present(found.bootstrap) - wanted) / error, 0.9, axis=0) < 0.02)
    assert np.quantile(np.abs(linear - wanted)[:, 1], 0.9) > 0.1 * error[1]


def test_what_is_not_linear_shows_in_the_interval() -> None:
    """A fast decay hardly shows how fast it is: the interval of b reaches farther up than down, more than it seems."""
    lengths = {}
    for by in ("refit", "linear"):
        b = resampled(by, 1)[1]["b"]
        low, high = (end for end in present(b.bootstrap_interval) if end is not None)
        lengths[by] = (high - present(b.value)) / (present(b.value) - low)
    assert lengths["refit"] > 1.15 * lengths["linear"]


@pytest.fixture
def _straight(monkeypatch: pytest.MonkeyPatch) -> None:
    straight_tracks.put(monkeypatch)


def found_from(data: Any, **more: Any) -> Identification:
    return identify("carved-46m", data, "mu_0,speed", changes=SCENARIO, workers=1, **more)


@pytest.mark.usefixtures("_straight")
class TestTracks:
    def test_of_a_linear_model_both_ways_agree(self) -> None:
        """A straight run is linear in friction and speed: the samples are the same to what a search leaves open."""
        one = track(seed=1)
        refit, linear = (found_from(one, bootstrap=60, bootstrap_by=by) for by in ("refit", "linear"))
        error = [each.standard_error for each in refit.parameters]
        assert np.max(np.abs(present(refit.bootstrap) - present(linear.bootstrap)) / error) < 0.01
        assert refit.effort.simulations >= linear.effort.simulations + 60
        assert any("60 resamples" in text and "refitted" in text for text in refit.methods)

    def test_an_interrupt_keeps_values_and_runs(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        kept = tmp_path / "simulations.partial"
        module = sys.modules["skisnow.simulation.simulated_run"]
        simulate, calls = module.simulate, 0
        whole = found_from(track(seed=2), bootstrap=50)

        def stopping(scenario: Any) -> Any:
            nonlocal calls
            calls += 1
            if calls == whole.effort.simulations - 10:
                raise KeyboardInterrupt
            return simulate(scenario)

        monkeypatch.setattr(module, "simulate", stopping)
        stopped = found_from(track(seed=2), bootstrap=50, checkpoint=kept)
        assert stopped.outcome == "interrupted"
        assert stopped["mu_0"].value == whole["mu_0"].value
        assert stopped["mu_0"].bootstrap_interval is None
        again = found_from(track(seed=2), bootstrap=50, checkpoint=kept)
        assert again.effort.simulations < 0.3 * whole.effort.simulations
        assert again["mu_0"].bootstrap_interval == whole["mu_0"].bootstrap_interval

    def test_a_parameter_without_effect_has_no_interval(self) -> None:
        one = track(seed=4)
        found = identify("carved-46m", one, "mu_0,S_f", changes=SCENARIO, workers=1, bootstrap=50)
        assert found["S_f"].bootstrap_interval is None
        assert found["mu_0"].bootstrap_interval is not None

    def test_too_few_resamples_are_rejected(self) -> None:
        with raises(ParameterError, "too_few_resamples"):
            found_from(track(), bootstrap=39)
        with raises(ParameterError, "unknown_bootstrap"):
            found_from(track(), bootstrap=100, bootstrap_by="hope")


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


@pytest.mark.parametrize("likelihood", [intervals._quadratic_likelihood, intervals._exact_likelihood])
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


def test_without_residuals_there_is_no_likelihood() -> None:
    assert (
        intervals._exact_likelihood(solution("photo_cells"))(np.array([[-1.5, 0.0], [-0.5, 0.0]])).tolist()[0]
        == -np.inf
    )


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
    ("kind", "told"), [("track", intervals.QUADRATIC_POSTERIOR), ("photo_cells", intervals.EXACT_POSTERIOR)]
)
def test_about_so_many_samples_are_drawn_about_the_best_place(kind: str, told: str, sampler: list[Sampler]) -> None:
    said: list[str] = []
    places, words = intervals.posterior_places(solution(kind), 4000, np.random.default_rng(1), said.append)
    assert words == told
    (made,) = sampler
    assert (made.walkers, made.p) == (16, 2)
    assert len(present(places)) == pytest.approx(4000, abs=2 * 16)
    assert said == [f"posterior: step {n} of {made.steps}" for n in range(1, made.steps + 1)]
    spread = made.begin - BEST
    assert np.abs(spread).max(axis=0) == pytest.approx([0.1, 0.2], rel=0.6)  # half a standard error each
    assert np.ptp(spread[:, 0]) > 0.05


def test_a_parameter_that_is_open_has_no_posterior(sampler: list[Sampler]) -> None:
    unknown = solution("photo_cells")
    unknown.uncertainty = lambda: SimpleNamespace(standard_errors=np.full(2, np.inf), groups=((0, 1),))
    places, _ = intervals.posterior_places(unknown, 100, np.random.default_rng(1), lambda _: None)
    assert places is None
    assert sampler == []


def test_a_missing_sampler_is_named_with_its_installation(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "emcee", None)
    with pytest.raises(ParameterError, match=r"skisnow\[posterior\]"):
        intervals.require_emcee()
