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
BY_S_F: Final = {"edge of 1°": 38, "carve": 0.4, "skid": 26, "skier": 13}
"""The larger of the ways (mm) by which the ends move with 0.999 and 1.001 of S_f."""
PARTS: Final = (
    (20.0, "27.793", "33.838"),
    (10.0, "27.742", "33.708"),
    (5.0, "27.706", "33.615"),
)
"""Length of a part (mm), and x of the ends (m) of the edge of 1° and of the skid."""
PARTS_BY_BEND: Final = (
    ("edge of 1°", "27.762, 27.750, 27.746", 2.6),
    ("carve", "21.371, 21.372, 21.372", 1.3),
    ("skid", "33.887, 33.865, 33.849", 1.4),
    ("skier", "29.432, 29.434, 29.430", 1.1),
)
"""By case: x of the end (m) for three shares that are missed, and processor time over that as it is."""
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
    yield "* `PART_ALONG` moves 1°, the skid and the skier. `DOWN`, `MILNE`, `SAFETY` and `UP` choose the lengths of"
    yield "  steps and so the number of parts: they move the skid by up to 77 mm, `SAFETY` also 1° and the skier."
    yield "* `ELEMENTS` in the skid: it is the key `solver.elements`. `SHEAR_DISPLACEMENT`, `CLAMP_LENGTH` and"
    yield "  `CAMBER_ROUNDING` are keys of snow, scenario and ski. Other constants of `ski` are shape."
    yield "* `KNOT_AREA` and `TOLERANCE` move nothing here: a run takes them from `solver.groove_tolerance` and"
    yield "  `solver.tolerance_mm`."
    yield ""
    yield "**The stated error omits the history.** Fixed steps up to 0.5 ms need no parts. x of the end (m) with steps"
    yield "of 0.5, 0.25 and 0.125 ms; fine: lines 5 mm apart and a tolerance of the groove of 10⁻⁸:"
    yield ""
    yield "| case | fixed steps | fine | default is off the last by (mm) |\n| --- | --- | --- | ---: |"
    yield from (f"| {' | '.join(map(str, row))} |" for row in FIXED_STEPS)
    yield ""
    yield "* With fine lines ends converge with an order of 1.6 to 1.9. Lines 20 mm apart shake the ski; steps below"
    yield "  0.5 ms resolve that, and it digs the groove deeper: they converge with order 1, and to another end."
    yield "* A base passes its deepest place between two ends of steps or parts. It is pressed where a parabola has its"
    yield "  vertex; without that, steps of 0.8 and 0.4 ms differ by 2.6 mm at 1° after 2 s, with it by 1.1 mm."
    yield "* The motion is not that sensitive: 10⁻⁶ more speed at the start moves the skid by 0.4 mm. A tolerance of"
    yield "  the groove of 10⁻⁸ moves it by 0.7 mm."
    yield ""
    yield from _parts()


def _parts() -> Iterator[str]:
    yield "**Shorter parts do not converge.** The history of a step is followed to an extrapolated end. The end that"
    yield "Newton's method finds is micrometres off, so grounds are pressed deeper than the base comes. x of"
    yield "the end (m):"
    yield ""
    yield "| `PART_ALONG` (mm) | edge of 1° | skid |\n| ---: | ---: | ---: |"
    yield from (f"| {part:g} | {' | '.join(ends)} |" for part, *ends in PARTS)
    yield ""
    yield "* The deepest place is pressed up to the extrapolated end. Before that, the history followed again after"
    yield "  Newton's first change gave 27.840 and 33.691 m with parts of 10 mm, for 1.28 times the processor time."
    yield "* To follow it again only when a step is accepted changes nothing: the forces of the step already come from"
    yield "  ground that is too deep. A correction of the extrapolated end by half of that of the step before is worse."
    yield ""
    yield "**Parts by the bend of the depth.** Where the depth d bends by d'' along the ski, parts of length l miss"
    yield "d'' l²/24 of it in the mean. The trial chose l so that this is a share of the greatest depth: 1.7, 0.8 and"
    yield "0.4 · 10⁻⁴. Then `PART_ALONG` moves ends by at most 2 mm (skid):"
    yield ""
    yield "| case | x of the end (m) | processor time at 0.8 · 10⁻⁴ to 1 · 10⁻⁴ |\n| --- | --- | ---: |"
    yield from (f"| {case} | {ends} | {time:g} |" for case, ends, time in PARTS_BY_BEND)
    yield ""
    yield "With parts down to 1 mm the shear of a flat ski brakes by 1.56 N, not 1.52 N, and three upright skis"
    yield "swing by 5.4 % of their weight after 0.1 s, not below 5 %. Parts of at least 2.5 mm cure both. The trials"
    yield "had sections that were placed for a straight ski, so their skid ends 0.2 m farther. They are not in use."
    yield "Three checks do not yet hold their limits: long fixed steps on soft snow, laws given in Python, and the"
    yield "change of load between skis."
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
