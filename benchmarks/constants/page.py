"""Effect of the constants (docs/validation/simulated-turn.md): what they move, and the reasons of the others."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Final

from .collecting import ROOT, Constant, constants
from .results import Moved, read_moved
from .varying import CASES, FACTORS

INCLUDED: Final = ROOT / "docs" / "_generated" / "contact-constants.md"
"""File that the page includes; the build of the docs writes it."""
Reasons = Mapping[str, Sequence[str]]


def read_reasons(path: Path) -> dict[str, list[str]]:
    """Keys by the reason for which they are not varied."""
    return {reason: list(table["keys"]) for reason, table in tomllib.loads(path.read_text(encoding="utf-8")).items()}


REASONS: Final = read_reasons(Path(__file__).with_name("reasons.toml"))
BY_S_F: Final = {"edge of 1°": 38, "carve": 0.4, "skid": 26, "skier": 6}
"""The larger of the ways (mm) by which the ends move with 0.999 and 1.001 of S_f."""
PARTS: Final = (
    (20, "27.799", "33.879", "27.777", "33.668"),
    (10, "27.747", "33.744", "27.729", "33.686"),
    (5, "27.715", "33.661", "27.692", "33.679"),
)
"""Length of a part (mm), and x of the mean end (m) of the edge of 1° and the skid: with anchors that follow ends of
parts alone, and also where an edge turns back."""
MEANS: Final = (
    ("DOWN", "7.7 ± 1.1, 3.3 ± 1.3", "7.4 ± 4.3, 6.4 ± 5.0"),
    ("MILNE", "0.6 ± 0.2, 0.2 ± 0.1", "2.9 ± 4.7, 51.0 ± 9.0"),
    ("SAFETY", "4.9 ± 0.4, 1.4 ± 0.3", "12.1 ± 14.1, 0.8 ± 5.7"),
    ("UP", "0.2 ± 0.1, 0.4 ± 0.1", "1.6 ± 5.5, 22.0 ± 8.3"),
)
"""By constant: shifts of the mean ends (mm) with × ½ and × 2, of the edge of 1° and of the skid."""
PHASE: Final = (
    ("20", "1.40, 1.15", "0.99, 0.86"),
    ("10", "0.50, 0.37", "0.35, 0.34"),
    ("5", "0.08, 0.08", "0.06, 0.07"),
    ("2.5", "0.03, 0.02", "0.02, 0.02"),
    ("20, u_y 0.5 mm", "0.17, 0.37", "0.30, 0.05"),
)
"""Spacing of the lines, and standard deviations of the shear and of its moment about the boot, left and right ski."""
FIXED_STEPS: Final = (
    ("edge of 1°", "27.755, 27.725, 27.706", "27.771, 27.748, 27.741", 3),
    ("carve", "21.374, 21.376, 21.378", "21.372, 21.373, 21.374", 3),
    ("skid", "33.735, 33.712, 33.694", "33.747, 33.734, 33.731", 27),
    ("skier", "29.350, 29.343, 29.340", "29.352, 29.349", 25),
)
"""By case: x of the end (m) with fixed steps of 0.5, 0.25 and 0.125 ms, the same with fine lines and grooves; distance
(mm) of the default end from the last."""


def reasons_by_key(reasons: Reasons) -> dict[str, str]:
    """The reason of each key."""
    return {key: reason for reason, keys in reasons.items() for key in keys}


def page(found: Sequence[Constant], moved: Sequence[Moved], reasons: Reasons) -> str:
    """The text of the page below its title."""
    known = {each.key for each in found}
    rows = [each for each in moved if each.key in known]
    varied = len({each.key for each in rows})
    return "\n".join([*_head(len(known), varied), *_table(rows), *_others(reasons), ""])


def _head(count: int, varied: int) -> Iterator[str]:
    yield "A script collects the constants of the sources: `constexpr` numbers of the compiled core, and numbers in"
    yield "capitals of the Python packages contact, dynamics, carving, ski, simulation, skier and forces. In one build"
    yield f"they are read at the start; each is halved and doubled. Of {count} constants {varied} were varied."
    yield "*`python -m benchmarks.constants` varies those that are new.*"
    yield ""
    yield "| case | run |\n| --- | --- |"
    for case, (name, changes) in CASES.items():
        words = ", ".join(f"`{key}` {value:g}" for key, value in changes.items() if isinstance(value, float))
        yield f"| {case} | `{name}`{' with ' if words else ''}{words} |"
    yield ""
    yield "## How far the end moves"
    yield ""
    ways = ", ".join(f"{way} mm ({case})" for case, way in BY_S_F.items())
    yield "In mm on the slope; another outcome where the run does not end as it did. The default method's stated error"
    yield f"is 7 mm after 46 m. A change of S_f by 0.1 % moves ends by {ways}. A constant of the solver should not"
    yield "move them by more than the larger of both. These do:"
    yield ""
    yield "* `PART_ALONG`, doubled, moves the skier by 13 mm."
    yield "* `MILNE`, `SAFETY` and `UP` choose the lengths of steps. Single ends of the skid move by up to 69 mm: they"
    yield "  scatter. The mean end moves by more than 26 mm with `MILNE` doubled only."
    yield "* `ELEMENTS` and `FINER`, halved: the key `solver.elements` chooses both. `SHEAR_DISPLACEMENT`,"
    yield "  `CLAMP_LENGTH` and `CAMBER_ROUNDING` are keys. Other constants of `ski` are shape."
    yield "* `KNOT_AREA` and `TOLERANCE` move nothing here: a run takes them from `solver.groove_tolerance` and"
    yield "  `solver.tolerance_mm`."
    yield ""
    yield "**The stated error omits the history.** Fixed steps up to 0.5 ms need no parts. x of the end (m) with steps"
    yield "of 0.5, 0.25 and 0.125 ms; fine: lines 5 mm apart and a tolerance of the groove of 10⁻⁸:"
    yield ""
    yield "| case | fixed steps | fine | default is off the last by (mm) |\n| --- | --- | --- | ---: |"
    yield from (f"| {' | '.join(map(str, row))} |" for row in FIXED_STEPS)
    yield ""
    yield "* With fine lines ends converge with an order of 1.6 to 1.9. With lines 20 mm apart the forces change with"
    yield "  the place of the lines. Steps below 0.5 ms resolve that: the groove gets deeper, and ends converge with"
    yield "  order 1 to another end."
    yield "* A base passes its deepest place between two ends of steps or parts. It is pressed where a parabola has its"
    yield "  vertex; without that, steps of 0.8 and 0.4 ms differ by 2.6 mm at 1° after 2 s, with it by 1.1 mm."
    yield ""
    yield from _means()
    yield from _parts()


def _means() -> Iterator[str]:
    yield "**Single ends scatter.** 16 runs start with 0.999 to 1.001 of 7 m/s. About their trend the ends have a"
    yield "standard deviation along x of 20 mm in the skid and of 4 mm at 1°. Twelve starts of the skid scatter by"
    yield "17, 13 and 2 mm with lines 20, 10 and 5 mm apart. Those of an earlier core scattered by 27, 11 and 3 mm"
    yield "(with u_y 0.5 mm instead of 0.02 mm by 0.8 mm). Steps made uneven at random scatter more."
    yield ""
    yield "**The scatter comes from the sum over the lines near the tail.** Where the tail rises, an edge that carves"
    yield "reverses its slip within 4 mm, and its shear jumps. So the sum changes with the place of the lines; its mean"
    yield "is right. Standard deviations before the skid begins, by `python -m benchmarks.constants.line_phase`:"
    yield ""
    yield "| lines (mm) | shear of the left, right ski (N) | yaw moment of each (N m) |\n| ---: | --- | --- |"
    yield from (f"| {' | '.join(row)} |" for row in PHASE)
    yield ""
    yield "* The edges break away after 1.4 s. A yaw impulse of 0.01 N m s then moves the end by 28 mm, at 2 s by 2 mm."
    yield "* If the base behind the boot is smoothed, by means over 20 mm, the twelve starts scatter by 6 instead of"
    yield "  17 mm; before the boot by 23 mm."
    yield "* Exact integrals of the depth at both ends of the contact change the error of the yaw moment of a ski that"
    yield "  slides from 0.2 to 0.01 N m, but not the scatter. A remedy must find the reversal between two lines."
    yield ""
    yield "Shift of the mean end and its standard error (mm), by `python -m benchmarks.constants --mean KEY`. The"
    yield "table of fixed steps and the moves of most constants that move an end by less are of a core whose anchors"
    yield "follow only the ends of parts."
    yield ""
    yield "| constant | edge of 1°, × ½ and × 2 | skid, × ½ and × 2 |\n| --- | --- | --- |"
    yield from (f"| `{' | '.join(row).replace(' |', '` |', 1)} |" for row in MEANS)
    yield ""


def _parts() -> Iterator[str]:
    yield "**Anchors follow an edge up to where it turns back.** Between ends of parts its place is a parabola,"
    yield "as the depth is. x of the mean end (m) without and with this and the acceleration within a step:"
    yield ""
    yield "| `PART_ALONG` (mm) | edge of 1°, without | skid, without | edge of 1°, with | skid, with |"
    yield "| ---: | ---: | ---: | ---: | ---: |"
    yield from (f"| {part:g} | {' | '.join(ends)} |" for part, *ends in PARTS)
    yield ""
    yield "* The skid holds: a mean of 8 starts has ± 8 mm. With fine steps and lines it ends at 33.731 m. Lines 5 mm"
    yield "  apart lead to 33.71 m with parts of 10 and 2.5 mm, without to 33.75 and 33.66 m."
    yield "* At 1° the remaining shift came from the rates of the beams, which grooves follow within a step. With the"
    yield "  mean of their last two values x of one end is 27.800, 27.740, 27.699 and 27.653 m for parts of 20, 10, 5"
    yield "  and 2.5 mm; with a lead of a quarter of their last change (`LEAD`) 27.830, 27.760, 27.735 and 27.718 m."
    yield ""


def _table(moved: Sequence[Moved]) -> Iterator[str]:
    yield f"| constant | value | {' | '.join(f'{case}, × ½ and × 2' for case in CASES)} |"
    yield f"| --- | --- |{' --- |' * len(CASES)}"
    by_key: dict[str, dict[float, Moved]] = {}
    for each in moved:
        by_key.setdefault(each.key, {})[each.factor] = each
    for key, of in sorted(by_key.items()):
        value = next(iter(of.values())).value
        cells = [
            ", ".join(of[factor].ends[place] if factor in of else "not run" for factor in FACTORS)
            for place in range(len(CASES))
        ]
        yield f"| `{key}` | {value} | {' | '.join(cells)} |"
    yield ""


def _others(reasons: Reasons) -> Iterable[str]:
    yield "## Not varied"
    yield ""
    yield "`benchmarks/constants/reasons.toml` lists them by name."
    yield ""
    yield "| reason | constants |\n| --- | ---: |"
    for reason, keys in reasons.items():
        yield f"| {reason} | {len(keys)} |"


def write_page() -> None:
    """Write the text of the page from the sources and the kept rows."""
    INCLUDED.parent.mkdir(exist_ok=True)
    INCLUDED.write_text(page(constants(), read_moved(), REASONS), encoding="utf-8")
