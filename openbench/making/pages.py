"""The page of each case: what its files say, in words, with its drawing."""

from __future__ import annotations

import json
from typing import Any, Final

from .. import CASES
from ..checking import unit_of
from ..reading import case_names, read_answer, read_case
from .exact import EXACT, formula

Json = dict[str, Any]
MOST = 8
"""Numbers of a list that a page shows."""

WORDS: Final = {
    "01-plate": "What every law of plastic snow has to do at least: the snow is pressed along its virgin line, comes back "
    "steeply, and takes up the virgin line again where it was left.",
    "02-edge": "An edge in soft snow is a wedge a few millimetres wide. A square grid of nodes meets it another way at "
    "each heading, though the snow is the same: beside the error the **spread over headings** is told, the largest "
    "less the smallest force over their mean, the mean of the three edge angles.",
    "03-cycles": "A cycle to a new depth costs what it adds to the print; one to an older depth costs nothing. Aside, "
    "an elastic and perfectly plastic point costs four times its strength times what the amplitude is beyond its reach.",
    "04-glide": "Friction, drag and the work of pressing snow down, in one line. A program that forgets the compaction, or "
    "gives the groove's energy back at the tail, is off by some per cent of v².",
    "05-sand": "Not snow, and not made by us: the only case whose truth was measured. Any law may be fitted to the given half. "
    "The data hold no cylinder that was pressed down; the wheel is one, and its side force is asked.\n\n"
    "The numbers are **not part of this set**. `given.json` (see `../../schemas/given.schema.json`) is made from the "
    "files when the set is run with `--data FOLDER`. FOLDER holds `wheel_lateral_smooth.csv` of the source, with the "
    "columns `slip_angle_deg`, `slip_ratio` and `Fx_N`, and `plates_large_box_7level.csv`: for each of nine trials of its large box "
    "the depth (`depth_mm`) at which the load, a centred mean of ten samples, first reaches 1/7, 2/7 … 7/7 of its "
    "largest value, that `load_N`, `trial` and `plate_diameter_mm`. `answer.json` has their SHA-256, their scale and "
    "their scatter, which we derived. Without `--data` the case is left out, and said so.",
    "06-carve": "The balance of a bending and twisting ski in the groove that its forebody presses for its afterbody. "
    "`turn_radius_at_boot_m` is what a ski maker asks.",
    "07-turn": "Everything at once: 15 m in 2 s. Beside the answer stands how far the end moves when something that nobody "
    "knows well is 1 % larger: a program that is off by less than that is as good as the snow is known.",
    "08-crossing": "Snow that was pressed before carries less: a runner that crosses a track loses less there, and lies deeper when it "
    "stands on it. Where tracks cross at a small angle the shared part is long and thin.",
}


def write_all() -> None:
    """README.md into each case's folder."""
    for name in case_names():
        (CASES / name / "README.md").write_text(page(name), encoding="utf-8")


def page(name: str) -> str:
    """Of one case."""
    case, answer = read_case(name), read_answer(name)
    lines = [
        f"# {name}: {case['title']}",
        "",
        f"![Drawing of the case: {case['title']}](drawing.svg)",
        "",
        WORDS[name],
        "",
    ]
    lines += ["## The law", "", *(f"- {law}" for law in case["laws"]), "", "## What is given", ""]
    lines += ["| key | value |", "| --- | --- |"]
    for part in ("body", "snow", "motion", "loads"):
        lines += [f"| `{part}.{key}` | {_shown(value)} |" for key, value in case.get(part, {}).items()]
    if "data" in case:
        lines += [f"| `data.{key}` | {_shown(value)} |" for key, value in case["data"].items()]
    lines += [
        "",
        "## What is asked",
        "",
        "| key | numbers | unit | what | scale | uncertainty of the answer |",
        "| --- | ---: | --- | --- | ---: | ---: |",
    ]
    for each in case["asked"]:
        key = each["key"]
        unit = (unit_of(key) or "").replace("_per_", "/")
        lines.append(
            f"| `{key}` | {each['count']} | {unit} | {each['words']} | {answer['scale'][key]:g} | {answer['uncertainty'][key]:g} |"
        )
    lines += [
        "",
        "Errors are root mean squares over the scale.",
        "",
        "## The answer",
        "",
        f"Kind: **{answer['kind']}**. {_provenance(name, answer)}",
        "",
    ]
    if "sensitivity" in answer:
        told = answer["sensitivity"]
        lines += ["| unknown | end moves on the first snow (m) | on the second (m) |", "| --- | ---: | ---: |"]
        lines += [f"| `{key}` | {a:g} | {b:g} |" for key, (a, b) in told["end_moves_m"].items()]
        lines += ["", f"Sensitivity: {told['words']}.", ""]
    return "\n".join(lines)


def _provenance(name: str, answer: Json) -> str:
    if name in EXACT:
        return f"{formula(name)} (`python -m openbench.making exact`)"
    return str(answer["provenance"]) + "."


def _shown(value: Any) -> str:
    if isinstance(value, list) and len(value) > MOST and not isinstance(value[0], list):
        return f"{len(value)} numbers, {value[0]:g} … {value[-1]:g}"
    return value if isinstance(value, str) else json.dumps(value)
