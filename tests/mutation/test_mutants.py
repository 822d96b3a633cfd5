"""Each kind of error is planted where it belongs, and the tests of a package are what finds it."""

import json
import subprocess
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from tests.mutation.__main__ import EQUIVALENTS, changed_lines, drawn, files_of, package_tests, place_of, verdicts
from tests.mutation.mutants import Mutant, mutants
from tests.mutation.reach import function_at, nearest, whole_time
from tests.mutation.trial import CAUGHT, OUT_OF_TIME, SURVIVED, Trials, copied_tree


def planted(source: str, kind: str) -> set[str]:
    return {each.planted(source) for each in mutants(source) if each.kind == kind and each.is_another_program(source)}


@pytest.mark.parametrize(
    ("source", "kind", "expected"),
    [
        ("rise * cosine", "arithmetic", {"rise / cosine"}),
        ("(a * b) + c", "arithmetic", {"(a / b) + c", "(a * b) - c"}),
        ("x -= 2", "arithmetic", {"x += 2"}),
        ("a ** b // c", "arithmetic", {"a * b // c", "a ** b / c"}),
        ("(größe  # a*b\n + b)", "arithmetic", {"(größe  # a*b\n - b)"}),
        ("a < b", "comparison", {"a <= b", "a >= b"}),
        ("0 <= a < b", "comparison", {"0 < a < b", "0 > a < b", "0 <= a <= b", "0 <= a >= b"}),
        ("a is not b", "comparison", {"a is b"}),
        ("a not  in b", "comparison", {"a in b"}),
        ("a and b or c", "and, or", {"a or b or c", "a and b and c"}),
        ("-(a + b)", "sign", {"(a + b)"}),
        ("not a", "sign", {"a"}),
        ("f(True, 2)", "constant", {"f(False, 2)", "f(True, 3)", "f(True, 1)"}),
        ("if a:\n    pass", "condition", {"if (not (a)):\n    pass"}),
        ("[a for a in b if a]", "condition", {"[a for a in b if (not (a))]"}),
        ("f(a, *b, c, d)", "arguments", {"f(a, *b, d, c)"}),
        ("f(a, a)", "arguments", set()),
        ("max(a, b) + np.hypot(c, d)", "arguments", set()),
        ("def f():\n    return a + b", "returned value", {"def f():\n    return None"}),
        ("def f():\n    return None", "returned value", set()),
        ("raise A(b) from c", "statement", {"pass"}),
        ("f()", "statement", {"pass"}),
        ("x: int | None = 1", "arithmetic", set()),
        ("def f(a: B | None) -> C | None: ...", "arithmetic", set()),
        ("f'{a + b}'", "arithmetic", set()),
    ],
)
def test_planted_errors_of_each_kind(source: str, kind: str, expected: set[str]) -> None:
    assert planted(source, kind) == expected


def test_errors_of_a_real_room_are_small_and_drawn_by_seed() -> None:
    files = files_of("_support/units")
    few = drawn(files, 12, 3)
    assert few == drawn(files, 12, 3) != drawn(files, 12, 4)
    for path, mutant in few:
        assert len([line for line in changed_lines(path, mutant).splitlines() if line[0] == "+"]) == 2  # file, line
    assert package_tests("track") == ("tests/track", "src/skisnow/track")


def test_the_function_around_a_character_is_found() -> None:
    source = "A = 1\n\n@cache\ndef f(x=2):\n    def g():\n        return 3\n    return 4\n"
    assert [function_at(source, source.index(digit)) for digit in "1234"] == [None, None, 5, 3]


def test_test_files_that_call_a_function_come_first_the_quick_ones_before(tmp_path: Path) -> None:
    reach = tmp_path / "reach.json"
    calls = {
        "slow.py": [9.0, [["a.py", 3]]],
        "quick.py": [0.1, [["a.py", 3], ["b.py", 3]]],
        "other.py": [1.0, [["a.py", 7]]],
    }
    reach.write_text(json.dumps(calls))
    assert nearest(reach, Path("a.py"), 3) == ["quick.py", "slow.py"]
    assert nearest(reach, Path("a.py"), None) == ["quick.py", "other.py", "slow.py"]
    assert nearest(reach, Path("c.py"), None) == []
    assert whole_time(reach) == pytest.approx(10.1)


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A program with a package of one function, tests that know half of it, and a file that git does not have."""
    for name, text in {
        "src/skisnow/__init__.py": "",
        "src/skisnow/toy/area.py": "def area(a, b):\n    if a > 9:\n        return 0\n    return a * b\n",
        "tests/toy/test_area.py": "from skisnow.toy.area import area\n\ndef test_area():\n    assert area(2, 3) == 6\n",
        ".gitignore": "left_out\n*.so\n",
        "src/skisnow/compiled/library.so": "",
        "left_out": "",
    }.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    subprocess.run(["git", "init", "-q", "."], cwd=tmp_path, check=True)
    return tmp_path


@pytest.fixture
def trials(tree: Path) -> Iterator[Trials]:
    with copied_tree(tree) as copy:
        assert not (copy / "left_out").exists()
        yield Trials(copy, package_tests("toy", root=tree), 60.0)


def test_what_is_compiled_is_copied_beside_what_git_has(tree: Path) -> None:
    with copied_tree(tree) as copy:
        found = {str(each.relative_to(copy)) for each in copy.rglob("*") if each.is_file()}
    assert "src/skisnow/compiled/library.so" in found
    assert "tests/toy/test_area.py" in found
    assert "left_out" not in found
    assert not copy.exists()


@pytest.mark.slow
def test_what_no_test_asks_for_survives(tree: Path, trials: Trials) -> None:
    """The product is tested, the limit is not; a loop without end is caught by time; the copy is left as it was."""
    trials = replace(trials, reach=trials.tree / "reach.json")
    assert trials.look() == 0
    assert trials.reach is not None
    (path,) = files_of("toy", root=tree)
    source = (tree / path).read_text()
    product = Mutant("arithmetic", source.index("*"), source.index("*") + 1, "/")
    limit = Mutant("comparison", source.index(">"), source.index(">") + 1, ">=")
    found = dict(verdicts([(path, product), (path, limit)], [trials]))
    assert nearest(trials.reach, path, function_at(source, product.start)) == ["tests/toy/test_area.py::test_area"]
    assert found == {(path, product): CAUGHT, (path, limit): SURVIVED}
    assert place_of(path, limit, root=tree) == ("toy/area.py", "if a > 9:", "if a >= 9:")
    start = source.index("return a * b")
    endless = Mutant("statement", start, start + 12, "while True: pass")
    assert Trials(trials.tree, trials.tests, 2.0).verdict(path, endless) == OUT_OF_TIME
    assert (trials.tree / path).read_text() == source
    assert trials.status() == 0


def test_every_equivalent_is_in_its_file() -> None:
    """For a line that was changed since, nothing is known."""
    package = Path(__file__).resolve().parents[2] / "src" / "skisnow"
    named = tomllib.loads(EQUIVALENTS.read_text(encoding="utf-8"))["equivalent"]
    assert len(named) > 10
    for each in named:
        lines = {line.strip() for line in (package / each["file"]).read_text(encoding="utf-8").splitlines()}
        assert set(map(str.strip, each["was"].splitlines())) <= lines, f"{each['file']}: {each['was']}"
