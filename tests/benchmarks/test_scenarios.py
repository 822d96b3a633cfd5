"""The measured scenarios, constants and printed numbers."""

import csv
import math
from pathlib import Path

import pytest
from benchmarks.constants import collecting
from benchmarks.constants.collecting import constants, in_cpp, in_python
from benchmarks.constants.page import REASONS, page
from benchmarks.constants.results import Moved, read_moved
from benchmarks.constants.varying import CASES, rewritten
from benchmarks.page_tables import stale_tables, table_path
from benchmarks.regressions import found, significant, table
from benchmarks.turns import allowed_keys, scenarios

from benchmarks import printed_numbers
from skisnow.scenario.keys import SCENARIO_KEYS
from skisnow.scenario.reading import load_input
from skisnow.scenario.resolution import resolve
from skisnow.ski.ski_file import Sources


def test_every_constant_was_varied_or_has_a_reason_and_the_page_has_a_row_for_each_that_was_varied() -> None:
    found = {each.key for each in constants()}
    reasons = [key for keys in REASONS.values() for key in keys]
    varied = {each.key for each in read_moved()}
    assert found - varied - set(reasons) == set()
    assert (varied | set(reasons)) - found == set()
    assert varied & set(reasons) == set()
    assert len(reasons) == len(set(reasons))
    rows = page(constants(), read_moved(), REASONS).splitlines()
    keys = {row.split("`")[1] for row in rows if row.count("|") == 3 + len(CASES) and row.startswith("| `")}
    assert keys == {each.key for each in read_moved()}


def test_values_that_were_varied_are_those_of_the_sources() -> None:
    now = {each.key: each.value for each in constants()}
    assert {each.key for each in read_moved() if now[each.key] != each.value} == set()


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(collecting, "ROOT", tmp_path)
    (tmp_path / "src").mkdir()
    return tmp_path / "src"


def test_numbers_of_the_core_are_found_and_read_at_the_start(root: Path) -> None:
    (root / "a.cpp").write_text(
        "constexpr double A = 0.5,  // of b, c\n"
        "    B = std::max(2.0, A);\n"
        "struct S {\n  static constexpr int C = 3;\n  static constexpr double S::* D[] = {};\n};\n"
        "constexpr double E[2] = {1.0, 2.0};\n// constexpr double F = 1.0;\n"
        "void g() { if constexpr (true) return; constexpr double G = 1e-3; }\n",
        encoding="utf-8",
    )
    found = list(in_cpp(root / "a.cpp"))
    assert [(each.name, each.value, each.is_array) for each in found] == [
        ("A", "0.5", False), ("B", "std::max(2.0, A)", False), ("C", "3", False), ("E", "{1.0, 2.0}", True),
        ("G", "1e-3", False),
    ]  # fmt: skip
    text = rewritten((root / "a.cpp").read_text(encoding="utf-8"), [found[0], found[2], found[4]])
    assert 'static const double A = skisnow::tuned<double>("a.cpp:A", 0.5), B = std::max(2.0, A);' in text
    assert 'static inline const int C = skisnow::tuned<int>("a.cpp:C", 3);' in text
    assert 'static const double G = skisnow::tuned<double>("a.cpp:G", 1e-3);' in text
    assert "constexpr double E[2] = {1.0, 2.0};" in text


def test_numbers_in_capitals_are_found_and_read_at_the_start(root: Path) -> None:
    (root / "b.py").write_text(
        "from __future__ import annotations\nimport math\nÄ = 'ä'; A: Final = 0.5\n_B, C = 2, math.radians(3.0)\n"
        "D = 'words'\nE: Final = (1.0, 2.0)\nf = 1.0\nG = True\nH: Final = -A * 2\n",
        encoding="utf-8",
    )
    found = list(in_python(root / "b.py"))
    assert [(each.name, each.value) for each in found] == [
        ("A", "0.5"), ("_B", "2"), ("C", "math.radians(3.0)"), ("H", "-A * 2"),
    ]  # fmt: skip
    text = rewritten((root / "b.py").read_text(encoding="utf-8"), found)
    assert 'A: Final = _tuned("b.py:A", 0.5)\n' in text
    assert '_B, C = _tuned("b.py:_B", 2), _tuned("b.py:C", math.radians(3.0))\n' in text
    assert text.startswith("from __future__ import annotations\nfrom skisnow.tuned_constants import tuned as _tuned\n")


def test_an_end_moves_by_its_distance_or_has_another_outcome() -> None:
    (constant, *_) = constants()
    base = dict.fromkeys(CASES, ("finished", 1.0, 2.0))
    other = dict.fromkeys(CASES, ("finished", 1.003, 2.004)) | {"skier": ("fell", 1.0, 2.0)}
    moved = Moved.of(constant, 2.0, base, other)
    assert dict(zip(CASES, moved.ends, strict=True)) == dict.fromkeys(CASES, "5") | {"skier": "fell"}


QUICK = 10
"""A seed whose sledge tips over soon."""


def test_a_seed_is_a_scenario_within_the_ranges() -> None:
    for seed in range(50):
        given = scenarios.changes(seed)
        assert given == scenarios.changes(seed)
        for key, (least, most) in (scenarios.UNIFORM | scenarios.LOGARITHMIC).items():
            assert key not in given or least <= given[key] <= most
    assert {scenarios.changes(seed)["snow.penetration"] for seed in range(50)} == set(scenarios.CONTACTS)


def test_any_values_are_those_of_a_scenario() -> None:
    """A seed gives the same values each time; each key is one of a scenario."""
    for seed in range(60):
        given = allowed_keys.changes(seed, "by-angle")
        assert given == allowed_keys.changes(seed, "by-angle")
        assert set(given) <= set(SCENARIO_KEYS)
        assert given["shear.law"] == "by-angle"
        resolve(load_input("carved-46m").changed(given), Sources())
    assert {allowed_keys.changes(seed)["shear.law"] for seed in range(50)} == set(allowed_keys.LAWS)


def test_what_is_in_the_file_is_not_computed_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "rows.jsonl"
    scenarios.print_table(QUICK, 1, path)
    first, told = path.read_text(encoding="utf-8"), capsys.readouterr().out
    assert "| tipped_over | 1 |" in told and told.count("none") == 3
    scenarios.print_table(QUICK, 1, path)
    assert (path.read_text(encoding="utf-8"), capsys.readouterr().out) == (first, told)


def test_one_that_does_not_end_is_reported_and_the_next_are_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The process begins anew behind it; here every one takes too long."""
    monkeypatch.setattr(scenarios, "_work", _sleep)
    assert [each["outcome"] for each in scenarios.rows([1, 2], limit=0.05)] == ["hangs", "hangs"]


def _sleep(seeds: list[int], answers: object, any_values: bool) -> None:  # noqa: ARG001
    import time

    time.sleep(60.0)


def test_numbers_that_follow_from_printed_ones_agree_except_a_truncated_one() -> None:
    """(0.1027 · 500 - 11.5323)² Pa = 1585 Pa, which the paper prints as 0.0015 N/mm²."""
    differing = [row for row in printed_numbers.derived() if not row.agrees]
    assert [round(row.ours, 7) for row in differing] == [round((0.1027 * 500 - 11.5323) ** 2 / 1e6, 7)]


def test_conversion_of_federolf_by_hand() -> None:
    """H_V = 2 A / cos² ϑ and S_f = B / sin² ϑ at 55°."""
    rows = printed_numbers.derived()
    angle = math.radians(55.0)
    assert rows[0].ours == pytest.approx(2 * 0.034 / math.cos(angle) ** 2)
    assert rows[1].ours == pytest.approx(0.35 / math.sin(angle) ** 2)


def test_a_simulated_campaign_has_every_number_of_the_table() -> None:
    assert set(printed_numbers.values_of(1)) >= set(printed_numbers.PRINTED)


def test_page_has_the_computed_rows() -> None:
    assert stale_tables("validation/index", {"printed-derived": printed_numbers.derived_table()}) == []
    rows = csv.reader(table_path("validation/index", "printed-simulated").read_text("utf-8").splitlines()[1:])
    assert {name: printed for name, printed, *_ in rows} == printed_numbers.PRINTED


EQN_14 = ("S_f_N_per_mm2", "snow_density_kg_per_m3", "all")


@pytest.mark.slow
def test_the_page_has_the_table_of_two_hundred_seeds() -> None:
    assert stale_tables("validation/reference-campaign", {"regressions": table(range(200))}) == []


def test_counts_are_those_of_the_p_values() -> None:
    seeds = range(3)
    p = [row.fit.p for seed in seeds for row in found(seed) if row.plan.predictor == EQN_14[1] and row.fit is not None]
    shear = p[::2]  # each campaign regresses S_f on density first, then H_V
    count = significant(seeds)[EQN_14]
    assert count.below == [sum(value < 0.05 for value in shear), sum(value < 0.01 for value in shear)]
    assert count.below[0] > 0
