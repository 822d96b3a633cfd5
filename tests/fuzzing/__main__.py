"""``python -m tests.fuzzing``: long runs in shards, their counts, and single cases."""

import argparse
import sys
from collections import Counter, defaultdict
from pathlib import Path

from .case import reproduced
from .registry import BY_NAME, READERS
from .shards import read_rows, run_shard


def main() -> int:
    """Run what the arguments ask for."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzzing", description=__doc__)
    parser.add_argument("--shard", type=int, default=0, help="number of the shard, from 0 (default: 0)")
    parser.add_argument(
        "--out", type=Path, default=Path("fuzzing.jsonl"), help="rows, continued (default: fuzzing.jsonl)"
    )
    parser.add_argument("--minutes", type=float, default=10.0, help="time after which no batch begins (default: 10)")
    parser.add_argument("--reader", action="append", default=[], help="words of the reader's name (repeatable)")
    parser.add_argument("--case", type=int, help="print the traceback of one case of --reader")
    parser.add_argument("--save", type=Path, help="write the case's files into this folder instead")
    parser.add_argument("--counts", type=Path, nargs="+", metavar="ROWS", help="print the counts of files of rows")
    options = parser.parse_args()
    if options.counts:
        return print_counts(options.counts)
    if options.case is not None:
        (name,) = options.reader
        if options.save:
            BY_NAME[name].lay(options.save, BY_NAME[name].mutated(options.case))
        else:
            print(reproduced(BY_NAME[name], options.case))
        return 0
    chosen = [each for each in READERS if not options.reader or any(word in each.name for word in options.reader)]
    for reader in chosen:
        if not reader.is_ready:
            print(f"{reader.name} is skipped: it needs {', '.join(reader.needs)}")
    ready = [each for each in chosen if each.is_ready]
    return 0 if run_shard(ready, options.shard, options.out, minutes=options.minutes) else 3


def print_counts(places: list[Path]) -> int:
    """Cases and faults by reader, then each different fault with one case of it."""
    cases, read, slowest = Counter[str](), Counter[str](), defaultdict[str, float](float)
    faults: dict[str, Counter[str]] = defaultdict(Counter)
    kinds: dict[tuple[str, str, str], list[int]] = defaultdict(list)
    examples: dict[tuple[str, str, str], str] = {}
    for row in read_rows(places):
        if row["row"] == "batch":
            cases[row["reader"]] += row["count"]
            read[row["reader"]] += row["read"]
            slowest[row["reader"]] = max(slowest[row["reader"]], row["slowest_s"])
        else:
            faults[row["reader"]][row["kind"]] += 1
            key = (row["reader"], row["kind"], row["where"] + " " + row["what"].partition(":")[0])
            kinds[key].append(row["number"])
            examples.setdefault(key, row["what"])
    for name in cases:
        told = ", ".join(f"{kind} {count}" for kind, count in faults[name].items())
        print(f"{name:28} {cases[name]:7} cases, {read[name]:6} read, slowest {slowest[name]:5.1f} s  {told}")
    total = sum((faults[name] for name in faults), Counter[str]())
    print(f"{'all':28} {cases.total():7} cases, {read.total():6} read  {dict(total)}")
    for key, numbers in sorted(kinds.items(), key=lambda pair: (pair[0][0], -len(pair[1]))):
        print(f"{len(numbers):5} × {key[0]} | {key[1]} | {key[2]} | {examples[key][:110]} | case {numbers[0]}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
