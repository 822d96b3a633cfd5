"""The machinery of the twins: truths that do not change, kept rows, counting, tables; no whole turn is identified."""

import csv
import math
from pathlib import Path

import numpy as np
import pytest
from benchmarks.page_tables import stale_tables, table_path

from skisnow.scenario import Solver, load_scenario
from skisnow.simulation.simulated_run import simulate

from .twins import grooves, shears, tables
from .twins.__main__ import DOCS, KINDS, PAGE, main
from .twins.glides import one_glide
from .twins.kept import KeptTwins, Row
from .twins.pool import run_twins
from .twins.shears import truth_of_shear
from .twins.truth import DRIFT, ERRORS, FREE, NOISE, SCENARIOS, Truth, finer, track_of, truth_of
from .twins.turns import track_as


def test_half_of_the_seeds_have_a_model_error_of_each_kind_in_turn() -> None:
    errors = [truth_of(SCENARIOS[0], seed).error for seed in range(12)]
    assert errors[::2] == [""] * 6
    assert errors[1::2] == [*ERRORS, *ERRORS]


def test_a_seed_is_the_same_truth_for_ever() -> None:
    """As first drawn: another order of the draws would make other twins under the same numbers."""
    first = truth_of("giant-slalom-67m", 0).values
    assert [first[key] for key in FREE] == pytest.approx([0.0454784675, 0.257914686, -92.7541589], rel=1e-8)
    other = truth_of("carver-42m", 1).values
    assert [other[key] for key in FREE] == pytest.approx([0.0332748957, 0.394758389, -89.954204], rel=1e-8)


def test_the_truth_has_finer_numbers_than_the_identification() -> None:
    asked = load_scenario("carver-42m", changes={"run.duration_s": 0.01})
    chosen, solver = simulate(asked).numbers, finer(asked).solver
    assert solver.elements == 2 * chosen["elements"]
    assert solver.line_spacing == pytest.approx(chosen["line_spacing_m"] / 2.0)
    assert solver.groove_tolerance == pytest.approx(Solver().groove_tolerance / 2.0)
    assert solver.tolerance == asked.solver.tolerance / 2.0


def test_a_track_is_the_run_at_10_hz_with_2_cm_and_the_drift() -> None:
    """Of 2 × 20 numbers the standard deviation is known to 11 %; three times that is allowed."""
    run = simulate(load_scenario("carver-42m", changes={"run.duration_s": 2.0, "run.output_ms": 10.0}))
    plain = track_of(run, Truth({}, ""), 3)
    assert np.diff(plain.time) == pytest.approx(np.full(len(plain) - 1, 0.1))
    off = (plain.place - run.place[::10])[:, :2]
    assert off.std() == pytest.approx(NOISE, rel=0.33)
    drifted = track_of(run, Truth({}, "drift"), 3).place - plain.place
    assert np.linalg.norm(drifted[-1, :2]) == pytest.approx(DRIFT * plain.time[-1], rel=1e-9)
    assert drifted[:, 2] == pytest.approx(np.zeros(len(plain)))


def test_rows_are_kept_one_by_one_and_not_computed_again(tmp_path: Path) -> None:
    path = tmp_path / "twins.csv"
    computed: list[int] = []

    def twin(case: str, seed: int) -> list[tuple[str, Row]]:
        if seed == 2 and len(computed) < 3:
            raise KeyboardInterrupt
        computed.append(seed)
        return [(case, {"value": str(seed)}), (f"{case}, elastic", {"value": "1", "more": "x"})]

    asked = [("a", seed) for seed in range(4)]
    with pytest.raises(KeyboardInterrupt):
        run_twins(twin, asked, KeptTwins.opened(path), workers=1)
    kept = KeptTwins.opened(path)
    assert sorted(kept.rows) == [("a", 0), ("a", 1), ("a, elastic", 0), ("a, elastic", 1)]
    computed.append(-1)
    assert run_twins(twin, asked, kept, workers=1, seconds=-1.0) == 1
    assert run_twins(twin, asked, kept, workers=1) == 1
    assert computed == [0, 1, -1, 2, 3]
    assert [row["value"] for row in KeptTwins.opened(path).of("a")] == ["0", "1", "2", "3"]


def half(case: str, seed: int) -> list[tuple[str, Row]]:
    return [(case, {"value": f"{seed / 2:g}"})]


@pytest.mark.slow
def test_two_processes_keep_the_rows_of_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(Path(__file__).parents[2])  # a fresh process finds the twin by its name
    asked = [("a", seed) for seed in range(5)]
    texts = []
    for workers in (1, 2):
        kept = KeptTwins.opened(tmp_path / f"{workers}.csv")
        assert run_twins(half, asked, kept, workers=workers) == 5
        texts.append(kept.path.read_text(encoding="utf-8"))
    assert texts[0] == texts[1]
    assert texts[0].splitlines()[-1] == "a,4,2"


def test_the_file_does_not_depend_on_the_order(tmp_path: Path) -> None:
    texts = []
    for order in ((0, 1), (1, 0)):
        kept = KeptTwins.opened(tmp_path / f"{order[0]}.csv")
        for seed in order:
            kept.add("a", seed, {"value": str(seed)})
        texts.append(kept.path.read_text(encoding="utf-8"))
    assert texts[0] == texts[1] == "case,seed,value\na,0,0\na,1,1\n"


def test_binomial_interval_by_hand() -> None:
    """All of 5: (0.005)^(1/5). None of 4: 1 - (0.005)^(1/4)."""
    assert tables.binomial(5, 5) == pytest.approx((0.005 ** (1 / 5), 1.0))
    assert tables.binomial(0, 4) == pytest.approx((0.0, 1.0 - 0.005 ** (1 / 4)))


def test_intervals_that_hold_the_truth_are_counted() -> None:
    ends = [("1", "3"), ("2.1", "3"), ("1", "1.9"), ("", "3"), ("1", "")]
    twins = [{"k true": "2", "k low": low, "k high": high} for low, high in ends]
    assert tables.covered(twins, "k") == (3, 5)


def test_an_error_of_half_an_interval_is_1_96_standard_errors() -> None:
    row = {"k true": "1", "k found": "3", "k low": "1", "k high": "5"}
    assert tables.in_standard_errors(row, "k") == pytest.approx(1.959964)


def test_a_twin_of_photo_cells_has_the_standard_errors_of_the_closed_form() -> None:
    """As in test_photo_cell_times, 10⁻⁴ leaves room for the step of integration."""
    ((case, row),) = one_glide("photo cells, three free", 4)
    assert "photo cells" in case
    assert row["outcome"] == "converged"
    for key in ("friction.mu_0", "drag.drag_area_m2", "start.speed_m_per_s"):
        assert float(row[f"{key} error over Fisher"]) == pytest.approx(1.0, abs=1e-4)
        assert float(row[f"{key} low"]) < float(row[f"{key} found"]) < float(row[f"{key} high"])


def test_a_sliding_groove_balances_and_a_holding_one_carves() -> None:
    """At the radius of a sliding edge, m v²/R over the same grip is S_f again; fast slides, slow holds."""
    fast, slow = (
        grooves.true_groove(0.5, 0.1, {"start.heading_deg": 0.0, "start.speed_m_per_s": speed}) for speed in (9.0, 3.0)
    )
    assert fast.slid
    assert not slow.slid
    assert fast.turn_radius / slow.turn_radius == pytest.approx(fast.needed / 0.1e6, rel=1e-9)
    assert fast.needed / slow.needed == pytest.approx(9.0, rel=1e-9)
    assert slow.depth / 0.9 / slow.width == pytest.approx(math.tan(math.radians(30.0)), rel=0.1)  # the ski twists


def test_a_seed_of_the_shear_is_the_same_truth_for_ever() -> None:
    found = [truth_of_shear(seed) for seed in range(200)]
    assert found[0] == pytest.approx(truth_of_shear(0))
    strength, displacement = (np.array([each[key] for each in found]) for key in shears.FREE)
    assert 0.08 < strength.min() < 0.085
    assert 0.45 < displacement.max() < 0.5


def test_the_shear_is_reported_by_whether_the_edge_slips(tmp_path: Path) -> None:
    kept = KeptTwins.opened(tmp_path / "shears.csv")
    row = {"outcome": "converged", "correlation": "-0.5", "near the limit": "0"}
    for seed, slips in enumerate("011"):
        ends = {f"{key} {name}": text for key in shears.FREE for name, text in zip(
            ("true", "found", "low", "high"), ("1", "1.1", "0.9", "1.2"), strict=True)}  # fmt: skip
        kept.add(shears.CASE, seed, {**row, **ends, "slips": slips})
    lines = tables.shear_of_tracks(kept).splitlines()
    assert lines[2] == "| holds | 1 | 1 of 1 | 10 | 1 of 1 | 10 | 1 of 1 | 0.50 | 0 of 1 |"
    assert lines[3] == "| slips | 2 | 2 of 2 | 10 | 2 of 2 | 10 | 2 of 2 | 0.50 | 0 of 2 |"


def test_places_below_the_surface_are_not_written_down() -> None:
    drawn = grooves.above_zero(0.1, 1.0, np.random.default_rng(1))
    assert len(drawn) == grooves.PLACES
    assert (drawn > 0.0).all()


def test_tables_hold_the_finished_twins(tmp_path: Path) -> None:
    main(["glides", "--seeds", "1", "--workers", "1"], docs=tmp_path)
    path = table_path(PAGE, "photo-cells", tmp_path)
    text = path.read_text(encoding="utf-8")
    assert text.count("\n") == 1 + 2 + 3
    assert "two free,mu_0,1," in text
    main([], docs=tmp_path)
    assert path.read_text(encoding="utf-8") == text


def test_the_page_holds_what_the_kept_twins_say() -> None:
    """The committed tables are those of the committed rows."""
    kept = {kind: KeptTwins.opened(DOCS / "validation" / "twins" / f"{kind}.csv") for kind in KINDS}
    assert stale_tables(PAGE, tables.page_tables(kept)) == []


def test_kept_turns_are_twins_of_their_seeds() -> None:
    """A row's truth is the one that its seed draws."""
    with (DOCS / "validation" / "twins" / "turns.csv").open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            truth = truth_of(row["case"].partition(",")[0], int(row["seed"]))
            assert row["error"] == truth.error
            assert [float(row[f"{key} true"]) for key in FREE] == pytest.approx(
                [truth.values[key] for key in FREE], rel=1e-8
            )


def test_a_track_without_noise_has_no_marks() -> None:
    track = track_as(np.array([0.0, 1.0]), np.zeros((2, 3)))
    assert track.usable.all()
    assert track.axes == "slope"
