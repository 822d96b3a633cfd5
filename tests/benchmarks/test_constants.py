"""Constants of the sources: each is found, and each is varied or has a reason not to be."""

from __future__ import annotations

from pathlib import Path

import pytest
from benchmarks.constants import collecting
from benchmarks.constants.collecting import constants, in_cpp, in_python
from benchmarks.constants.page import REASONS, page
from benchmarks.constants.results import Moved, read_moved
from benchmarks.constants.varying import CASES, rewritten


def test_every_constant_was_varied_or_has_a_reason() -> None:
    found = {each.key for each in constants()}
    reasons = [key for keys in REASONS.values() for key in keys]
    varied = {each.key for each in read_moved()}
    assert found - varied - set(reasons) == set()
    assert (varied | set(reasons)) - found == set(), "of constants that are no more"
    assert varied & set(reasons) == set()
    assert len(reasons) == len(set(reasons))


def test_the_page_has_a_row_for_each_that_was_varied() -> None:
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
