"""The machinery of the twins: truths that do not change, kept rows, counting, tables; no whole turn is identified."""

import csv
from pathlib import Path

import numpy as np
import pytest
from benchmarks.page_tables import stale_tables, table_path
from benchmarks.twins import tables
from benchmarks.twins.__main__ import DOCS, KINDS, PAGE, main
from benchmarks.twins.kept import KeptTwins, Row
from benchmarks.twins.pool import run_twins
from benchmarks.twins.truth import DRIFT, FREE, NOISE, Truth, finer, track_of, truth_of

from skisnow.scenario import Solver, load_scenario
from skisnow.simulation.simulated_run import simulate


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
        assert run_twins(half, asked[::-1] if workers == 1 else asked, kept, workers=workers) == 5
        texts.append(kept.path.read_text(encoding="utf-8"))
    assert texts[0] == texts[1]
    assert texts[0].splitlines()[-1] == "a,4,2"


def test_binomial_interval_by_hand() -> None:
    """All of 5: (0.005)^(1/5). None of 4: 1 - (0.005)^(1/4)."""
    assert tables.binomial(5, 5) == pytest.approx((0.005 ** (1 / 5), 1.0))
    assert tables.binomial(0, 4) == pytest.approx((0.0, 1.0 - 0.005 ** (1 / 4)))


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
