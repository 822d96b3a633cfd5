"""A study of 100,000 points that cost nothing: memory and time of its parent, and how a second start begins.

``python -m benchmarks.studies --points 100000``; every part runs in a process of its own.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from skisnow.carving.question import CARVE_KEYS
from skisnow.studies import Study, read_study, run_study
from skisnow.studies.points import Point
from skisnow.studies.subjects import CARVE_RESULTS, CarveModel

TEXT: Final = """
out = "table.csv"
[fixed]
ski = "slalom"
published = "race-piste"
unloading_ratio = 10
[grid]
load_N = {{ from = 300, to = 1500, n = 100 }}
edge_angle_deg = {{ from = 10, to = 60, n = {n} }}
"""


class Costless(CarveModel):
    """Rows as long as those of carved turns, in no time."""

    def __call__(self, point: Point) -> dict[str, Any]:
        number = point["load_N"] / 3.0 + point["edge_angle_deg"] / 7.0
        results = {name: number + place for place, name in enumerate(CARVE_RESULTS)}
        texts = {"outcome": "equilibrium", "holds": True, "ski_name": "slalom", "warnings": "", "reason": ""}
        return {**dict.fromkeys(CARVE_KEYS), **point, **results, **texts}


def run(folder: Path, *, share: float) -> dict[str, float]:
    """A share of the study, or all of it with its table, in this process and two workers."""
    begin, spent = time.perf_counter(), time.process_time()
    study: Study = read_study(folder / "study.toml", subject=Costless)
    first: list[float] = []

    def tell(done: int, total: int) -> None:
        if not first:
            first.append(time.perf_counter() - begin)
        if share < 1.0 and done >= share * total:
            raise KeyboardInterrupt

    with suppress(KeyboardInterrupt):
        run_study(study, workers=2, progress=tell)
    return {
        "place_s": first[0],
        "wall_s": time.perf_counter() - begin,
        "cpu_us_per_row": 1e6 * (time.process_time() - spent) / (share * len(study.points)),
        "memory_MB": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
    }


def main() -> None:
    """Print a table of all parts."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=100_000, help="a multiple of 100")
    parser.add_argument("--part", type=float, help=argparse.SUPPRESS)
    parser.add_argument("--folder", type=Path, help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.part is not None:
        print(json.dumps(run(asked.folder, share=asked.part)))
        return
    print("| part | found its place after | wall time | CPU of the parent for a row | peak memory of the parent |")
    print("| --- | ---: | ---: | ---: | ---: |")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "study.toml").write_text(TEXT.format(n=asked.points // 100), encoding="utf-8")
        for title, share in (("all, with the table", 1.0), ("nine tenths", 0.9), ("the rest, with the table", 1.0)):
            words = ["-m", "benchmarks.studies", "--part", str(share), "--folder", name]
            found = json.loads(subprocess.run([sys.executable, *words], check=True, capture_output=True).stdout)
            print(
                f"| {title} | {found['place_s']:.2f} s | {found['wall_s']:.0f} s | {found['cpu_us_per_row']:.1f} µs | "
                f"{found['memory_MB']:.0f} MB |",
                flush=True,
            )
            if title.startswith("all"):
                size = (folder / "table.csv").stat().st_size / 1e6
                (folder / "table.csv").unlink()
            elif share < 1.0:
                kept = (folder / "table.csv.partial").stat().st_size / 1e6
    print(f"\nThe table has {size:.0f} MB, the file of finished points {kept:.0f} MB with nine tenths of them.")


if __name__ == "__main__":
    main()
