"""The campaign's model against a general optimiser, known spreads and simulated truth."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import optimize, stats

import skisnow
from skisnow.campaign import ReferenceNoise, reference_campaign
from skisnow.estimation import campaign_fit
from skisnow.estimation.campaign_fit import Priors
from skisnow.estimation.campaign_model import DEFAULT_PRIORS, CampaignModel, fit_campaign
from skisnow.estimation.errors_in_depth import volume_factor
from skisnow.estimation.hardness import DEFINITIONS, hardness_at_largest_load
from skisnow.estimation.parts import seating_change
from skisnow.estimation.readings import Readings, ReadingUncertainty
from skisnow.estimation.spread_groups import _two_classes, fit_in_groups, noisier_series, noisier_series_warning
from skisnow.geometry import Disc, SkiPiece, Tool

from .conftest import MakeCampaign
from .test_hardness import LOADS, TOOL, pressed

ANGLE = math.radians(30.0)
GAUGE = 1e-5
UNCERTAINTY = ReadingUncertainty(GAUGE / math.sqrt(12.0))


def simulated(
    m: int,
    *,
    seating_sd: float = 5e-5,
    layering: float = 0.07,
    mean: float = 1.0,
    scatter: float = 0.02,
    seed: int = 1,
    H: float = 0.5e9,
) -> tuple[Readings, np.ndarray]:
    """Series on edge with known spreads (scatter of the depth), and their ln H_V."""
    rng = np.random.default_rng(seed)
    log_H = math.log(H) + 0.3 * rng.standard_normal(m)
    g = mean + layering * rng.standard_normal((m, 1))
    volume = LOADS[-1] / np.exp(log_H)[:, None] * (LOADS / LOADS[-1]) ** g
    depth = TOOL.depth_at_volume(volume, ANGLE) * (1.0 + scatter * rng.standard_normal((m, 7)))
    depth = np.maximum(depth + seating_sd * rng.standard_normal((m, 1)), 0.0)
    return pressed(TOOL, ANGLE, np.round(depth / GAUGE) * GAUGE, LOADS), log_H


def fitted(readings: Readings, uncertainty: ReadingUncertainty = UNCERTAINTY, **how: object) -> CampaignModel:
    H = hardness_at_largest_load(readings, DEFINITIONS["H_V"])
    return fit_campaign(readings, H, uncertainty, **how)  # type: ignore[arg-type]


def test_a_series_has_the_least_squares_of_a_general_optimiser() -> None:
    """With the spreads of the fit, `scipy.optimize.least_squares` over residuals and priors gives the same numbers."""
    readings, _ = simulated(30)
    model = fitted(readings)
    (tau2,), (mean,), (layering2,), (scatter2,) = model.spreads
    for i in range(3):
        own = slice(7 * i, 7 * i + 7)
        depth = readings.penetration_depth[own]

        def law(b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            volume = LOADS[-1] / np.exp(b[0]) * (LOADS / LOADS[-1]) ** b[1]
            e = TOOL.depth_at_volume(volume, ANGLE)
            return e, volume / TOOL.contact_area(e, ANGLE)

        best = np.array([model.log_hardness[i], model.exponent[i], model.offset[i] * 1e4])
        _, slope = law(best)
        deviation = np.sqrt(UNCERTAINTY.depth**2 + slope**2 * scatter2)

        def residuals(b: np.ndarray, depth: np.ndarray = depth, deviation: np.ndarray = deviation) -> np.ndarray:
            e, _ = law(b)
            own = (depth - e - b[2] * 1e-4) / deviation
            return np.concatenate((own, [(b[1] - mean) / layering2**0.5, b[2] * 1e-4 / tau2**0.5]))

        found = optimize.least_squares(residuals, best + np.array([0.1, 0.05, 0.1]), xtol=1e-14, ftol=1e-14)
        jacobian = np.asarray(found.jac, dtype=float)
        covariance = np.linalg.inv(jacobian.T @ jacobian)
        scale = np.array([1.0, 1.0, 1e-4])
        ours = model.covariance[i] / np.outer(scale, scale)
        np.testing.assert_allclose(
            ours, covariance, rtol=2e-3, atol=1e-3 * np.sqrt(np.outer(*[np.diag(covariance)] * 2)).min()
        )
        np.testing.assert_allclose(best, found.x, atol=2e-3 * np.sqrt(np.diag(covariance)).min())


def test_the_spreads_of_many_series_are_those_they_were_drawn_with() -> None:
    """On edge V grows as e², so a scatter of the depth of 2 % is one of the force of 4 %.

    A standard deviation with ν degrees of freedom has the relative error 1/√(2 ν); three of them are allowed.
    """
    readings, _ = simulated(3000, mean=0.9)
    model = fitted(readings)
    (tau2,), (mean,), (layering2,), (scatter2,) = model.spreads
    seating, layering, scatter = (3.0 / math.sqrt(2.0 * degrees[0]) for degrees in model.freedom[:3])
    assert math.sqrt(tau2) == pytest.approx(5e-5, rel=seating)
    assert mean == pytest.approx(0.9, abs=3.0 * math.sqrt(model.freedom.mean_exponent_variance[0]))
    assert math.sqrt(layering2) == pytest.approx(0.07, rel=layering)
    assert math.sqrt(scatter2) == pytest.approx(0.04, rel=scatter)
    assert max(seating, layering, scatter) < 0.1


def test_of_few_series_the_priors_count() -> None:
    """Each spread is the mean of its prior and of what the series show, weighted by their numbers."""
    m = 4
    model = fitted(simulated(m, mean=0.8, layering=0.02, seating_sd=1e-5)[0])
    (tau2,), (mean,), (layering2,), _ = model.spreads
    of_g, of_d = model.covariance[:, 1, 1], model.covariance[:, 2, 2]
    assert tau2 == pytest.approx((5e-5**2 + np.sum(model.offset**2 + of_d)) / (1.0 + m), rel=0.01)
    about_1 = 0.1**-2
    assert mean == pytest.approx((about_1 + model.exponent.sum() / layering2) / (about_1 + m / layering2), rel=1e-3)
    scattered = np.sum((model.exponent - mean) ** 2 + of_g)
    assert layering2 == pytest.approx((3.0 * 0.1**2 + scattered) / (3.0 + m), rel=0.01)
    shown = 1.0 - of_g / layering2
    assert model.freedom.layering[0] == pytest.approx(3.0 + np.sum(shown**2), rel=0.01)
    known = about_1 + shown.sum() / layering2
    assert model.freedom.mean_exponent_variance[0] == pytest.approx(1.0 / known, rel=0.01)


@pytest.mark.parametrize("size", [1, 2, 5, 400])
@pytest.mark.parametrize("seating_sd", [0.0, 5e-5])
def test_intervals_cover_the_truth_in_campaigns_of_any_size(size: int, seating_sd: float) -> None:
    """2,000 series in campaigns of ``size``: H_V and δ cover 93 to 98.5 %, with 3 binomial deviations."""
    m = 2000
    rng = np.random.default_rng(2)
    readings, log_H = simulated(m, seating_sd=0.0, seed=3)
    offset = seating_sd * np.repeat(rng.standard_normal(m), 7)
    depth = np.maximum(readings.penetration_depth + offset, 0.0)
    readings = pressed(TOOL, readings.edge_angle, np.round(depth / GAUGE).reshape(m, 7) * GAUGE, LOADS)
    model = fitted(readings, group=np.arange(m) // size)
    inside = np.abs(model.log_hardness - log_H) <= model.half_width(0)
    deviation = 3 * math.sqrt(0.05 * 0.95 / m)
    assert 0.93 - deviation < inside.mean() < 0.985 + deviation
    low, high = model.offset_interval.T
    assert ((low <= offset[::7]) & (offset[::7] <= high)).mean() > 0.93 - deviation
    # a typical width, so that wide intervals do not pass: today's were 0.1 and more
    assert np.median(model.half_width(0)) < (0.08 if size == 1 else 0.07)


def test_groups_are_fitted_as_campaigns_of_their_own() -> None:
    readings, _ = simulated(6)
    together = fitted(readings, group=np.array([0, 0, 0, 1, 1, 1]))
    alone = fitted(readings.of(np.arange(6) >= 3))
    np.testing.assert_allclose(together.log_hardness[3:], alone.log_hardness, atol=1e-3)
    np.testing.assert_allclose(together.half_width(0)[3:], alone.half_width(0), rtol=1e-2)
    np.testing.assert_allclose(together.freedom.seating[1], alone.freedom.seating[0], rtol=1e-2)


def test_series_that_do_not_count_leave_the_spreads() -> None:
    readings, _ = simulated(20)
    worse, _ = simulated(20, seating_sd=1e-3, scatter=0.2, seed=5)
    counts = np.arange(20) < 10
    depth = np.where(np.repeat(counts, 7), readings.penetration_depth, worse.penetration_depth).reshape(20, 7)
    mixed = fitted(pressed(TOOL, readings.edge_angle, depth, LOADS), counts=counts)
    alone = fitted(readings.of(counts))
    np.testing.assert_allclose(np.array(mixed.spreads), np.array(alone.spreads), rtol=1e-6)
    np.testing.assert_allclose(mixed.log_hardness[:10], alone.log_hardness, atol=1e-5)


def test_readings_of_0_are_omitted_and_counted_and_a_series_needs_two_readings_in_contact() -> None:
    readings, _ = simulated(10)
    depth = readings.penetration_depth.reshape(10, 7).copy()
    depth[3, :2] = 0.0
    model = fitted(pressed(TOOL, readings.edge_angle, depth, LOADS))
    assert model.n_zero.tolist() == [0, 0, 0, 2, 0, 0, 0, 0, 0, 0]
    assert np.isfinite(model.half_width(0)).all()
    assert abs(model.log_hardness[3] - fitted(readings).log_hardness[3]) < model.half_width(0)[3]
    readings, _ = simulated(3)
    depth = readings.penetration_depth.reshape(3, 7).copy()
    depth[0, :6] = 0.0
    depth[1, :5] = 0.0
    model = fitted(pressed(TOOL, readings.edge_angle, depth, LOADS))
    assert np.isfinite(model.log_hardness).tolist() == [False, True, True]
    assert np.isfinite(model.hardness_interval).all(axis=1).tolist() == [False, True, True]


@pytest.mark.parametrize(("tool", "angle_deg"), [(SkiPiece(0.2, 0.062), 45.0), (Disc(0.1), 0.0)])
def test_exact_series_give_back_offset_and_hardness(tool: Tool, angle_deg: float) -> None:
    """Twelve series without scatter: what the weak priors take is below a tenth of the half widths."""
    rng, angle = np.random.default_rng(4), math.radians(angle_deg)
    H, offset = 0.2e9 * np.exp(rng.normal(0, 0.5, 12)), 1e-4 * rng.standard_normal(12) + 1e-4
    depth = tool.depth_at_volume(LOADS / H[:, None], angle) + offset[:, None]
    readings = replace(pressed(TOOL, angle, depth, LOADS), tools=(tool,))
    model = fitted(readings, ReadingUncertainty(1e-7))
    assert (np.abs(model.log_hardness - np.log(H)) < 0.2 * model.half_width(0)).all()
    assert (np.abs(model.offset - offset) < 0.2 * model.half_width(2)).all()
    as_read = readings.load[6::7] / readings.displaced_volume[6::7]
    change = seating_change(readings, model.offset)
    np.testing.assert_allclose(as_read * (1.0 + change), H, rtol=0.01)
    assert (np.sign(change) == np.sign(offset)).all()


def test_errors_of_the_load_alone_give_those_of_a_weighted_mean() -> None:
    """Without other errors each reading gives ln H = ln F - ln V(e) ± u_F/F: the variance is 1/Σ (F/u_F)²."""
    readings, _ = simulated(8, seating_sd=0.0, layering=0.0, scatter=0.0)
    H = hardness_at_largest_load(readings, DEFINITIONS["H_V"])
    exact = replace(DEFAULT_PRIORS, seating=1e-10, layering=1e-5, mean_layering=1e-5, scatter=1e-5)
    model = fit_campaign(readings, H, ReadingUncertainty(1e-9, 5.0), priors=exact)
    np.testing.assert_allclose(model.covariance[:, 0, 0], 1.0 / np.sum((LOADS / 5.0) ** 2), rtol=0.01)


def test_more_rounds_hardly_move_the_spreads(monkeypatch: pytest.MonkeyPatch) -> None:
    readings, _ = simulated(30)
    H = hardness_at_largest_load(readings, DEFINITIONS["H_V"])
    first = fit_campaign(readings, H, UNCERTAINTY)
    for name, value in (("_ROUNDS", 400), ("_SPREADS_SETTLED", 1e-9), ("_SCATTER_SETTLED", 1e-9)):
        monkeypatch.setattr(campaign_fit, name, value)
    settled = fit_campaign(readings, H, UNCERTAINTY)
    np.testing.assert_allclose(first.log_hardness, settled.log_hardness, atol=1e-3)
    np.testing.assert_allclose(np.ravel(first.spreads), np.ravel(settled.spreads), rtol=0.02)


def test_noisier_sites_have_their_own_spreads() -> None:
    """Four times the scatter and seating at one of two sites; without that, one set of spreads."""
    site = np.repeat(["A", "B"], 30)

    def at_two_sites(factor: float) -> CampaignModel:
        quiet, _ = simulated(30)
        loud, _ = simulated(30, seating_sd=factor * 5e-5, scatter=factor * 0.02, seed=9)
        depth = np.concatenate((quiet.penetration_depth, loud.penetration_depth)).reshape(60, 7)
        readings = pressed(TOOL, ANGLE, depth, LOADS)
        H = hardness_at_largest_load(readings, DEFINITIONS["H_V"])
        return fit_in_groups(readings, H, UNCERTAINTY, labels={"site": site.tolist(), "tool": ["ski"] * 60})

    alike, apart = at_two_sites(1.0), at_two_sites(4.0)
    assert (alike.grouped_by, alike.group_names) == ("campaign", ("",))
    assert (apart.grouped_by, apart.group_names) == ("site", ("A", "B"))
    assert math.sqrt(apart.spreads.scatter2[1] / apart.spreads.scatter2[0]) == pytest.approx(4.0, rel=0.3)
    assert np.median(apart.half_width(0)[30:]) > 2.0 * np.median(apart.half_width(0)[:30])


def mixed_series(factor: float, *, count: int = 40, seed: int = 1, noisier: np.ndarray | None = None) -> Readings:
    """Some series of one site and tool, by default every other, have ``factor`` times the seating and scatter."""
    quiet, _ = simulated(count, seed=seed)
    loud, _ = simulated(count, seating_sd=factor * 5e-5, scatter=factor * 0.02, seed=seed + 1000)
    mask = np.arange(count) % 2 == 1 if noisier is None else noisier
    depth = np.where(mask[:, None], loud.penetration_depth.reshape(count, 7), quiet.penetration_depth.reshape(count, 7))
    return pressed(TOOL, ANGLE, depth, LOADS)


def in_groups(readings: Readings) -> CampaignModel:
    H = hardness_at_largest_load(readings, DEFINITIONS["H_V"])
    same = ["A"] * readings.n_series
    return fit_in_groups(readings, H, UNCERTAINTY, labels={"site": same, "tool": same})


def test_noisier_series_among_quieter_ones_have_their_own_spreads() -> None:
    model = in_groups(mixed_series(4.0))
    assert model.grouped_by == "scatter"
    assert np.mean(model.group == np.arange(40) % 2) > 0.85
    assert math.sqrt(model.spreads.scatter2[1] / model.spreads.scatter2[0]) == pytest.approx(4.0, rel=0.3)
    (warning,) = noisier_series_warning(model, [f"P{number}" for number in range(40)])
    assert warning.fields["n"] == (model.group == 1).sum()
    assert warning.fields["first"] == [*(f"P{number}" for number in np.flatnonzero(model.group == 1)[:5]), "…"]


def test_offsets_that_come_from_the_prior_alone_do_not_count_for_the_classes() -> None:
    readings = mixed_series(2.5, seed=3)
    model = fit_campaign(readings, hardness_at_largest_load(readings, DEFINITIONS["H_V"]), UNCERTAINTY)
    seating2, covariance = model.spreads.seating2[0], model.covariance.copy()
    covariance[:32, 2, 2] = seating2
    share = 1.0 - covariance[:, 2, 2] / seating2
    assert share[32:].min() > 0.3
    sums = [(model.misfit, model.free), (share * model.offset**2 / seating2, share**2)]
    noisier = noisier_series(replace(model, covariance=covariance))
    np.testing.assert_array_equal(noisier, _two_classes(sums)[0] > 0.5)


@pytest.mark.parametrize("noisier", [6, 15, 34])
def test_two_classes_are_a_maximum_of_the_likelihood(noisier: int) -> None:
    """Few or many of 40 series: the classes are those of scipy's gamma densities with the weighted variances."""
    random, first = np.random.default_rng(noisier), np.arange(40) < noisier
    degrees = np.array([np.full(40, 6.0), random.uniform(0.5, 1.0, 40)])
    squares = np.where(first, 9.0, 1.0) * random.chisquare(degrees)
    degrees[1, ::4] = squares[1, ::4] = 0.0  # no information
    probability, gain, factor = _two_classes(list(zip(squares, degrees, strict=True)))
    seen = degrees > 0.0

    def likelihood(weight: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        scale = (squares @ weight) / (degrees @ weight)
        density = np.ones_like(squares)
        density[seen] = stats.gamma.pdf(squares[seen], degrees[seen] / 2.0, scale=2.0 * np.repeat(scale, seen.sum(1)))
        return density.prod(axis=0), scale

    (large, noisy), (small, quiet), (one, _) = map(likelihood, (probability, 1.0 - probability, np.ones(40)))
    share = probability.mean()
    mixed = share * large + (1.0 - share) * small
    assert probability == pytest.approx(share * large / mixed, abs=1e-4)
    assert gain == pytest.approx(2.0 * np.log(mixed / one).sum(), rel=1e-4)
    assert factor == pytest.approx(math.sqrt(noisy[0] / quiet[0]), rel=1e-4)
    assert np.mean((probability > 0.5) == first) > 0.8


@pytest.mark.parametrize(("loud", "grouped_by"), [(2, "campaign"), (6, "scatter"), (34, "scatter"), (38, "campaign")])
def test_a_few_series_that_scatter_otherwise_are_outliers_and_no_class(loud: int, grouped_by: str) -> None:
    assert in_groups(mixed_series(8.0, noisier=np.arange(40) < loud)).grouped_by == grouped_by


@pytest.mark.parametrize("count", [1, 2, 10, 40])
def test_series_of_one_scatter_stay_one_group(count: int) -> None:
    for seed in range(15):
        model = in_groups(mixed_series(1.0, count=count, seed=seed))
        assert model.grouped_by == "campaign"
        assert noisier_series_warning(model, ["P1"] * count) == ()


def test_b_is_corrected_for_its_dilution() -> None:
    """Fifteen reference campaigns with a scatter of 8 %: least squares give 0.95, the correction 1."""
    raw, expected, corrected, covered = [], [], [], []
    for seed in range(15):
        drawn = reference_campaign(
            seed + 2000, noise=ReferenceNoise(depth_scatter=0.08, layering_sd=0.15, depths_grow=False)
        )
        found = skisnow.estimation.readings.readings_of(drawn.penetration, drawn.campaign().tools, geometry="extended")
        H = hardness_at_largest_load(found, DEFINITIONS["H_V"])
        b = volume_factor(found, H, fit_campaign(found, H, ReadingUncertainty(GAUGE / math.sqrt(12.0), 0.5)))
        raw.append(b.raw)
        expected.append(b.expected_raw)
        corrected.append(b.value)
        covered.append(b.low <= 1.0 <= b.high)
    assert np.mean(raw) == pytest.approx(0.955, abs=0.01)
    assert np.mean(expected) == pytest.approx(np.mean(raw), abs=0.006)
    assert np.mean(corrected) == pytest.approx(1.0, abs=0.006)
    assert np.mean(covered) > 0.85


def test_a_series_without_hardness_takes_no_part() -> None:
    """A hardness of 0 or below is as good as none: the other series have the same numbers."""
    readings, _ = simulated(8)
    H = hardness_at_largest_load(readings, DEFINITIONS["H_V"])
    fits = []
    for missing in (np.nan, 0.0, -0.5, -1e9):
        H[3] = missing
        fits.append(fit_campaign(readings, H, UNCERTAINTY))
    for other in fits:
        assert np.isnan(other.log_hardness[3])
        assert not other.counts[3]
        np.testing.assert_array_equal(other.hardness_interval, fits[0].hardness_interval)


def test_one_series_has_a_b_without_an_interval() -> None:
    readings, _ = simulated(1)
    H = hardness_at_largest_load(readings, DEFINITIONS["H_V"])
    b = volume_factor(readings, H, fitted(readings))
    assert b.n == 1
    assert math.isfinite(b.value)
    assert math.isnan(b.low)


def test_a_campaign_states_its_seating_and_the_result_the_priors(make_campaign: MakeCampaign) -> None:
    readings, _ = simulated(1)
    depth = readings.penetration_depth * 1e3
    rows: list[tuple[object, ...]] = [
        ("P1", "A", "ski", 30, load, f"{e:.2f}") for load, e in zip(LOADS, depth, strict=True)
    ]
    rows.append(("P1", "A", "ski", 30, 5, 0))
    narrow, wide = (
        skisnow.analyse(make_campaign(rows, top=top), n_resamples=100).results["penetration"]
        for top in ("seating_mm = 0.005\n", "")
    )
    for results, value in ((narrow, 0.005), (wide, Priors().seating * 1e3)):
        model = results["campaign_model"]
        assert model["priors"]["seating_mm"] == pytest.approx(value)
        assert model["groups"][0]["seating_degrees_of_freedom"] >= model["priors"]["seating_series"]
        assert model["n_zero"] == 1
        assert results["experiments"][0]["n_zero"] == 1
        assert results["experiments"][0]["n_loads"] == 8
    width = [high - low for low, high in (row["experiments"][0]["H_V_interval_N_per_mm3"] for row in (narrow, wide))]
    assert width[0] < 0.8 * width[1]
