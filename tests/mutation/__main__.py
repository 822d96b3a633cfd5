"""Plant errors in a package one at a time, run its tests on each, and report those that no test found.

    python -m tests.mutation --package track -n 50 --seed 1 --workers 2

The errors are drawn with a seed from all that can be planted; the same seed on the same files plants the same ones.
Nothing in this tree is changed: the tests run in copies.
"""

import argparse
import difflib
import random
import sys
import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import replace
from itertools import islice
from pathlib import Path
from queue import Queue
from typing import Final, TypeAlias

from .mutants import Mutant, mutants
from .reach import whole_time
from .trial import OUT_OF_TIME, SURVIVED, Trials, copied_tree

Planted: TypeAlias = tuple[Path, Mutant]
Place: TypeAlias = tuple[str, str, str]
ROOT: Final = Path(__file__).resolve().parents[2]
SOURCE: Final = Path("src/skisnow")
EQUIVALENTS: Final = Path(__file__).with_name("equivalents.toml")


def files_of(package: str, *, root: Path = ROOT) -> list[Path]:
    """Python files of a package, or the one file that a package is, from the tree's top."""
    found = sorted((root / SOURCE / package).rglob("*.py")) or sorted(root.glob(f"{SOURCE}/{package}.py"))
    if not found:
        sys.exit(f"no package {package!r}: give a folder or file of {SOURCE}, such as track or campaign/store")
    return [path.relative_to(root) for path in found]


def package_tests(package: str, *, root: Path = ROOT) -> tuple[str, ...]:
    """The package's tests and the examples in its docstrings."""
    tests = package.replace("_support", "support")
    named = [
        f"tests/{tests}",
        f"tests/{Path(tests).parent / f'test_{Path(tests).name}.py'}",
        f"{SOURCE}/{package}",
        f"{SOURCE}/{package}.py",
    ]
    return tuple(name for name in named if (root / name).exists())


def changed_lines(path: Path, mutant: Mutant, *, root: Path = ROOT) -> str:
    """The error as a diff without surroundings."""
    source = (root / path).read_text(encoding="utf-8")
    two = (source.splitlines(), mutant.planted(source).splitlines())
    return "\n".join(difflib.unified_diff(*two, str(path), str(path), n=0, lineterm=""))


def place_of(path: Path, mutant: Mutant, *, root: Path = ROOT) -> Place:
    """File below the program's folder, line before, line after: how equivalents are listed."""
    lines = changed_lines(path, mutant, root=root).splitlines()[3:]
    before, after = (" ".join(line[1:].strip() for line in lines if line[0] == sign) for sign in "-+")
    return str(path.relative_to(SOURCE)), before, after


def equivalents() -> set[Place]:
    """What is listed by hand as without consequence."""
    listed = tomllib.loads(EQUIVALENTS.read_text(encoding="utf-8")).get("equivalent", [])
    return {(each["file"], each["was"], each["is"]) for each in listed if each["reason"]}


def drawn(files: Iterable[Path], count: int, seed: int, *, root: Path = ROOT) -> list[Planted]:
    """So many errors, of each kind about as many, but for equivalent ones; all where there are fewer."""
    texts = {path: (root / path).read_text(encoding="utf-8") for path in files}
    every = [(path, each) for path, text in texts.items() for each in mutants(text)]
    random.Random(seed).shuffle(every)
    before: Counter[str] = Counter()
    turns = []
    for one in every:
        before[one[1].kind] += 1
        turns.append(before[one[1].kind])
    in_turn = (one for _, one in sorted(zip(turns, every, strict=True), key=lambda each: each[0]))
    known = equivalents()
    counted = (
        (path, each)
        for path, each in in_turn
        if each.is_another_program(texts[path]) and not (known and place_of(path, each, root=root) in known)
    )
    return list(islice(counted, count))


def verdicts(planted: list[Planted], trials: list[Trials]) -> Iterator[tuple[Planted, str]]:
    """Results of the tests for each error, on as many copies of the tree as there are."""
    free: Queue[Trials] = Queue()
    for each in trials:
        free.put(each)

    def tried(one: Planted) -> str:
        trial = free.get()
        try:
            return trial.verdict(*one)
        finally:
            free.put(trial)

    with ThreadPoolExecutor(len(trials)) as pool:
        yield from zip(planted, pool.map(tried, planted), strict=True)


def asked_of(words: list[str] | None) -> argparse.Namespace:
    """Arguments of the command line."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("--package", required=True, help="folder or file of src/skisnow: track, field/store, units")
    parser.add_argument("-n", type=int, default=50, help="number of errors (50)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=1, help="copies of the tree that are tested at once (1)")
    parser.add_argument("--only", nargs="*", type=int, default=[], help="numbers of the errors to plant (all)")
    parser.add_argument("--reach", type=Path, help="file of which test reaches what; kept for the next time")
    parser.add_argument("--tests", nargs="*", default=[], help="further test files and folders that count")
    parser.add_argument("--file", default="", help="only files of the package whose path contains this")
    parser.add_argument(
        "--limit-s", type=float, help="time for each (default: a minute and five times what all tests take)"
    )
    return parser.parse_args(words)


def main(words: list[str] | None = None) -> int:
    """Number of errors that survived."""
    asked = asked_of(words)
    planted = drawn([path for path in files_of(asked.package) if asked.file in str(path)], asked.n, asked.seed)
    planted = [one for number, one in enumerate(planted, 1) if number in (asked.only or [number])]
    tests = (*package_tests(asked.package), *asked.tests)
    with ExitStack() as kept:
        trees = [kept.enter_context(copied_tree(ROOT)) for _ in range(asked.workers)]
        reach = asked.reach.resolve() if asked.reach else trees[0] / ".reach.json"
        first = Trials(trees[0], tests, 3600.0, reach)
        if not reach.exists() and first.look() != 0:
            reach.unlink(missing_ok=True)
            sys.exit(f"the tests fail without an error planted: {' '.join(tests)}")
        limit = asked.limit_s or 60.0 + 5.0 * asked.workers * whole_time(reach)
        trials = [replace(first, tree=tree, limit=limit) for tree in trees]
        survivors, late = [], 0
        for number, (one, verdict) in enumerate(verdicts(planted, trials), 1):
            print(f"{number} of {len(planted)}: {verdict}, {one[1].kind}, {one[0]}", file=sys.stderr, flush=True)
            late += verdict == OUT_OF_TIME
            if verdict == SURVIVED:
                survivors.append(one)
                print(f"{changed_lines(*one)}\n", flush=True)
    found = len(planted) - len(survivors)
    print(f"{asked.package}: {found} of {len(planted)} caught ({found / max(len(planted), 1):.0%}), {late} by time")
    return len(survivors)


if __name__ == "__main__":
    main()
