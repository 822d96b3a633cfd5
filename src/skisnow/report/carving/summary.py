"""Results for skis in snow as a table for a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from ..formatting import significant

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

Json = dict[str, Any]


def answers_of(found: Json) -> list[Json]:
    """The answers of `skisnow carve`'s JSON: one, or those under ``skis``."""
    answers: list[Json] = found.get("skis", [found])
    return answers


def ski_titles(answers: list[Json]) -> list[str]:
    """What to call each ski: its own name, or the word it was asked for by where names do not tell the skis apart."""
    words = [str(answer["inputs"]["ski"]) for answer in answers]
    names = [str(answer["ski"]["name"]) for answer in answers]
    return names if len(set(names)) == len(set(zip(words, names, strict=True))) else words


def carve_summary(found: Json) -> str:
    """What was asked, the choices in force, and one column for each ski.

    Parameters
    ----------
    found
        What `skisnow.carving.answer_dict.answers_dict` gives.
    """
    return "\n".join(_lines(answers_of(found)))


def _lines(answers: list[Json]) -> Iterator[str]:
    inputs = answers[0]["inputs"]
    kind = "at rest" if inputs["at_rest"] else "carving"
    angle, load, moment = (significant(inputs[key], style="plain") for key in ("edge_angle_deg", "load_N", "moment_Nm"))
    yield f"{kind}: edge angle {angle} degrees, load {load} N, boot moment {moment} N m"
    yield f"snow: {_snow(answers[0])}"
    yield f"model: {_choices(inputs)}"
    yield ""
    yield from _table(answers)
    for title, answer in zip(ski_titles(answers), answers, strict=True):
        if answer["remedy"]:
            yield ""
            yield f"{title}: {answer['outcome'].replace('_', ' ')}: {answer['remedy']}"


def _snow(answer: Json) -> str:
    inputs = answer["inputs"]
    words = [f"H_V {_with_interval(answer, 'H_V', 'N_per_mm3')} N/mm3"]
    if inputs["S_f_N_per_mm2"] is not None:
        words.append(f"S_f {_with_interval(answer, 'S_f', 'N_per_mm2')} N/mm2")
    if inputs["unloading_ratio"] is not None and not inputs["at_rest"]:
        words.append(f"k_u/H_V {significant(inputs['unloading_ratio'], style='plain')}")
    return f"{', '.join(words)} ({answer['snow']['source']})"


def _with_interval(answer: Json, symbol: str, unit: str) -> str:
    value = significant(answer["inputs"][f"{symbol}_{unit}"], style="plain")
    ends = answer["snow"][f"{symbol}_interval_{unit}"]
    return value if ends is None else f"{value} [{', '.join(significant(end, style='plain') for end in ends)}]"


def _choices(inputs: Json) -> str:
    words = [f"clamp length {significant(inputs['clamp_length_m'], style='plain')} m"]
    if inputs["footprint_stiffness_N_per_mm2"] is not None:
        words.append(f"footprint stiffness {significant(inputs['footprint_stiffness_N_per_mm2'], style='plain')} N/mm²")
    if not inputs["at_rest"]:
        words.append(f"side force bends the ski: {_yes(inputs['side_force_bending'])}")
        words.append(f"side force spread: {inputs['side_force_spread']}")
        words.append(f"groove follows the {inputs['groove']}")
        words.append(f"moment balance: {inputs['moment_balance']}")
    return ", ".join([*words, f"twist: {_yes(inputs['twist'])}", f"elements {inputs['elements']}"])


def _yes(value: bool) -> str:
    return "yes" if value else "no"


def _greatest(key: str, *, by: Callable[[float], float] = float) -> Callable[[Json], str]:
    def greatest(answer: Json) -> str:
        known = [value for value in answer[key] or () if value is not None]
        return significant(max(known, key=by), style="plain") if known else "-"

    return greatest


def _number(key: str) -> Callable[[Json], str]:
    return lambda answer: significant(answer[key], style="plain")


def _of_ski(answer: Json, key: str) -> str:
    return significant(answer["ski"][key], style="plain")


_ROWS: Final[tuple[tuple[str, Callable[[Json], str]], ...]] = (
    ("outcome", lambda answer: answer["outcome"].replace("_", " ")),
    ("grip holds", lambda answer: "-" if answer["holds"] is None else _yes(answer["holds"])),
    ("side force (N)", _number("side_force_N")),
    ("shear capacity of the snow (N)", _number("side_force_limit_N")),
    ("grip utilisation (1: side-slip)", _number("grip_utilisation")),
    ("total force of the snow (N)", _number("total_force_N")),
    ("turn radius, boot and 0.4 m to each side (m)", _number("turn_radius_boot_m")),
    (
        "the same, side force spread the other way (m)",
        _number("turn_radius_boot_other_spread_m"),
    ),
    ("turn radius, boot and ends of contact (m)", _number("turn_radius_chord_m")),
    ("sidecut radius of three widths (m)", lambda answer: _of_ski(answer, "sidecut_radius_of_three_widths_m")),
    ("sidecut radius of the whole edge line (m)", lambda answer: _of_ski(answer, "sidecut_radius_of_edge_line_m")),
    ("contact length (m)", _number("contact_length_m")),
    ("loaded contact length (m)", _number("bearing_length_m")),
    ("edge depth, afterbody / forebody", _number("afterbody_depth_ratio")),
    ("edge depth, maximum (mm)", _greatest("edge_depth_mm")),
    ("normal force per length, maximum (N/m)", _greatest("force_per_length_N_per_m")),
    ("deflection, maximum (mm)", _greatest("bending_mm", by=abs)),
    ("twist, maximum (degrees)", _greatest("twist_deg", by=abs)),
    ("boot moment about the ski's cross axis (N m)", _number("boot_pitch_moment_Nm")),
    ("force out of balance (N)", _number("residual_force_N")),
    ("moment out of balance (N m)", _number("residual_moment_Nm")),
)


def _table(answers: list[Json]) -> Iterator[str]:
    cells = [["", *ski_titles(answers)]]
    cells += [[name, *(of(answer) for answer in answers)] for name, of in _ROWS]
    widths = [max(len(row[column]) for row in cells) for column in range(len(cells[0]))]
    for row in cells if len(answers) > 1 else cells[1:]:
        first, *rest = (cell.rjust(width) for cell, width in zip(row, widths, strict=True))
        yield "  ".join([first.strip().ljust(widths[0]), *rest]).rstrip()
