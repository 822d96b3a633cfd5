"""Numbers that stand in the sentences and tables of pages; `docs/write_numbers.py` puts them there.

A function bears the name of its page with its folder, and gets the folder in which the page's commands have run. A
value that is a Markdown table becomes a CSV file of the page.
"""

from __future__ import annotations

import contextlib
import io
import json
import re
import sys
from pathlib import Path
from typing import Any

from skisnow import read_snow
from skisnow.cli import main
from skisnow.report.formatting import significant

DOCS = Path(__file__).resolve().parent


def page_files(page: str) -> dict[str, str]:
    """The blocks of a page that show files, each by the file that was named last before it; the first of each name."""
    found: dict[str, str] = {}
    name = ""
    for part in re.split(
        r"^(```\w*\n.*?^```$)", (DOCS / page).read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL
    ):
        if part.startswith("```") and name:
            found.setdefault(name, part.partition("\n")[2].removesuffix("```"))
        name = (re.findall(r"[\w-]+\.(?:csv|toml)", part) or [""])[-1]
    return found


def python_blocks(page: str) -> list[str]:
    """The programs that a page shows."""
    return re.findall(r"^```python\n(.*?)^```$", (DOCS / page).read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)


def answer(*words: str) -> dict[str, Any]:
    """What a command says with --json."""
    told = io.StringIO()
    with contextlib.redirect_stdout(told), contextlib.redirect_stderr(io.StringIO()):
        main([*words, "--json"])
    return dict(json.loads(told.getvalue()))


def how_to_carve(_folder: Path) -> dict[str, str]:
    """Grip and depth of an edge on a glacier, and depth of a tool at rest."""
    ski = ("carve", "--ski", "slalom", "--edge-angle-deg", "45", "--load-N", "800")
    glacier = answer(*ski, "--published", "glacier", "--unloading-ratio", "10")
    numbers = {
        "glacier limit": f"{glacier['side_force_limit_N']:.0f}",
        "glacier depth": f"{max(glacier['edge_depth_mm']):.1f}",
    }
    tool = ("carve", "--ski", "paper-tool", "--edge-angle-deg", "45", "--load-N", "490", "--H-V-N-per-mm3", "0.04")
    at_rest = answer(*tool, "--at-rest", "--clamp-length-m", "0")
    return {**numbers, "tool depth": f"{max(at_rest['edge_depth_mm']):.1f}"}


def tutorials_campaign(folder: Path) -> dict[str, str]:
    """What the sentences about the report say."""
    results = json.loads((folder / "results" / "results.json").read_text(encoding="utf-8"))
    penetration = results["penetration"]
    rmse = {row["id"]: significant(row["rmse_N"], 4) for row in penetration["models"]}
    sites = {name: read_snow(folder / "results" / "results.json", site=f"site {name}") for name in "AH"}
    low, high = (end / 1e9 for end in sites["A"].snow_hardness_interval or ())
    best = min(row["rmse_N"] for row in penetration["models"])
    selected = next(row for row in penetration["models"] if row["id"] == penetration["selected"]["id"])
    seating = penetration["seating"]
    offsets = [row["interval_mm"] for row in seating]
    change = sorted(row["H_V_change_percent"] for row in seating)
    (on_angle,) = [row for row in results["regressions"] if row["p"] is not None and row["p"] < 0.05]
    return {
        "flags": str(sum(len(row["flags"]) for kind in (penetration, results["shear"]) for row in kind["experiments"])),
        "experiments": str(len(penetration["experiments"])),
        "shear experiments": str(len(results["shear"]["experiments"])),
        **{f"mean {name}": significant(snow.snow_hardness / 1e9, 3) for name, snow in sites.items()},
        "interval A": f"[{significant(low, 3)}, {significant(high, 3)}]",
        **{f"{hardness} {shape}": rmse[f"{hardness}:a={shape},b={shape}"]
           for hardness in ("H_e", "H_A", "H_V") for shape in ("linear", "constant")},
        **{f"b {shape}": rmse[f"H_V:a=none,b={shape}"] for shape in ("linear", "constant", "one")},
        "above the best": f"{100.0 * (selected['rmse_N'] / best - 1.0):.1f}",
        "intervals without zero": str(sum(not low <= 0.0 <= high for low, high in offsets)),
        "lower quarter": _percent(_quantile(change, 0.25)),
        "upper quarter": _percent(_quantile(change, 0.75)),
        "regressions": str(len(results["regressions"])),
        "slope": significant(on_angle["b"][1], 3),
        "slope interval": "[{}, {}]".format(*(significant(end, 3) for end in on_angle["interval"][1])),
    }  # fmt: skip


def how_to_in_python(folder: Path) -> dict[str, str]:
    """The snow of site C in the field's units."""
    snow = read_snow(folder / "results" / "results.json", site="site C")
    stress = snow.failure_shear_stress
    return {"hardness": significant(snow.snow_hardness / 1e9), "stress": significant(stress and stress / 1e6)}


def _quantile(ordered: list[float], share: float) -> float:
    at = share * (len(ordered) - 1)
    low = int(at)
    return ordered[low] + (at - low) * (ordered[min(low + 1, len(ordered) - 1)] - ordered[low])


def _percent(value: float) -> str:
    return significant(value, 3)


def validation_measured(_folder: Path) -> dict[str, str]:
    """Numbers and tables of the pairs in docs/gallery/contrast; no run is computed."""
    from benchmarks.contrast.found import found, numbers, read_rows, tables

    pairs = found(read_rows(DOCS / "gallery" / "contrast"))
    return numbers(pairs) | tables(pairs)


if __name__ == "__main__":
    what, page, *rest = sys.argv[1:]
    if what == "program":
        print(python_blocks(page)[int(rest[0]) - 1])
    else:
        Path(rest[0]).mkdir(exist_ok=True)
        for name in rest[1:]:
            (Path(rest[0]) / name).write_text(page_files(page)[name], encoding="utf-8")
