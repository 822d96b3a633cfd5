"""Run the tests; those that drive a browser and failed run once more, one by one, and the last lines say which.

The arguments are pytest's. Any other failure stays one, and so does a browser test that fails again.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

SOME_FAILED = 1  # pytest's exit status; with any other it has not come to its end
FAILED = Path(".pytest_cache/v/cache/lastfailed")


def pytest(*words: str) -> int:
    """Its exit status."""
    return subprocess.call([sys.executable, "-m", "pytest", *words])


def failed() -> list[str]:
    """Of the tests that ran, those whose last run failed."""
    return sorted(json.loads(FAILED.read_text(encoding="utf-8"))) if FAILED.exists() else []


def main(words: list[str]) -> int:
    """Zero where every test passed, at once or when it was repeated."""
    status = pytest("--cache-clear", *words)
    first = failed()
    if status != SOME_FAILED or not first:
        return status
    print(f"\nRepeated, of {len(first)} that failed: those that drive a browser.", flush=True)
    pytest("-q", "--exitfirst", "-m", "browser", "-p", "no:xdist", *first)
    left = failed()
    for name in first:
        print(f"{'FAILED, not repeated or again' if name in left else 'failed once, passed when repeated'}: {name}")
    return SOME_FAILED if left else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
