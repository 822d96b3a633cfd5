"""``skisnow carve`` and ``design``: the equilibrium of a ski in snow, and the ski that makes the wanted turn."""

from __future__ import annotations

import argparse
import sys
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .._support.messages import Message, in_language, local_number
from .options import add_language, number, whole_number
from .output import Progress, prepare_figure, print_json, print_warnings

if TYPE_CHECKING:
    from ..design import Design, DesignTask


def add_carve(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow carve`` to the program."""
    parser = commands.add_parser(
        "carve",
        help="equilibrium of a ski in snow: depth, pressure, deflection, twist, turn radius",
        description="Equilibrium of a ski that carves a steady turn, or is set down on snow. The snow is given in one "
        "of three ways: --H-V-N-per-mm3 with --S-f-N-per-mm2, --results, or --published.",
    )
    _add_question(parser)
    _add_choices(parser)
    sensitivity: dict[str, Any] = {"action": "append", "nargs": "?", "const": "", "metavar": "PARAMETER"}
    parser.add_argument(
        "--sensitivity",
        **sensitivity,
        help="exact derivatives of radius, depth, grip, deflection and force by a parameter, such as "
        "ski.waist_width_mm, ski.EI_N_m2[2], edit.sidecut_depth, snow.H_V_N_per_mm3, load_N (repeatable; "
        "default: by turn, snow, and the ski's widths, camber and stiffness)",
    )
    parser.add_argument("--json", action="store_true", help="print JSON alone to standard output")
    parser.add_argument("--figure", type=Path, metavar="FILE", help="draw a figure: .png, .svg or .pdf")
    add_language(parser, "the figure")
    parser.set_defaults(run=carve_ski)


def _add_question(parser: argparse.ArgumentParser) -> None:
    """Add the options for skis, edge angle, load, moment and snow."""
    named: dict[str, Any] = {"action": "append", "required": True, "metavar": "NAME|FILE"}
    parser.add_argument("--ski", **named, help="a ski of the catalogue or a ski file; several times to compare")
    angle = "angle of the base under the boot to the snow, 0 to 85"
    parser.add_argument("--edge-angle-deg", type=number("degrees"), required=True, metavar="DEGREES", help=angle)
    load = "on this ski, along the snow normal, at the boot"
    parser.add_argument("--load-N", type=number("N"), required=True, metavar="NEWTONS", help=load)
    parser.add_argument(
        "--moment-Nm", type=number("N m"), metavar="N_M", help="at the boot, positive presses the tip down"
    )
    snow = parser.add_argument_group("snow")
    snow.add_argument("--H-V-N-per-mm3", type=number("N/mm³"), metavar="H_V", help="snow hardness")
    stress = "failure shear stress; beside --results or --published only where those have none"
    snow.add_argument("--S-f-N-per-mm2", type=number("N/mm²"), metavar="S_f", help=stress)
    snow.add_argument("--results", metavar="PATH", help="results.json of an analysed campaign")
    snow.add_argument("--site", metavar="S", help="one site of those results; default: all sites together")
    snow.add_argument("--published", metavar="NAME", help="a published snow, such as race-piste")
    ratio = "k_u/H_V: 1 is elastic snow, inf rigid-plastic; no default; plays no part with --at-rest"
    snow.add_argument("--unloading-ratio", type=number(""), metavar="RATIO", help=ratio)


def _add_choices(parser: argparse.ArgumentParser) -> None:
    """Add the options for the model's choices and for changes of the ski."""
    choices = parser.add_argument_group("modelling choices; those in force are printed with the answer")
    choices.add_argument(
        "--clamp-length-m", type=number("m"), metavar="M", help="length that boot and binding keep straight"
    )
    footprint = "stiffness of boot and binding under each metre of it; default: rigid"
    choices.add_argument("--footprint-stiffness-N-per-mm2", type=number("N/mm²"), metavar="K", help=footprint)
    off: dict[str, Any] = {"action": "store_const", "const": False}
    choices.add_argument(
        "--no-side-force-bending", dest="side_force_bending", **off, help="the side force does not bend the ski"
    )
    spread = "how the side force goes along the edge: as its depth, or as the snow's force on the base"
    choices.add_argument("--side-force-spread", choices=("depth", "base-reaction"), help=spread)
    choices.add_argument("--groove", choices=("edge", "path"), help="curve that the groove of the forebody follows")
    balance = "support of the side force's moment about the ski's cross axis: boot, or nothing but --moment-Nm (free)"
    choices.add_argument("--moment-balance", choices=("boot", "free"), help=balance)
    choices.add_argument("--no-twist", dest="twist", **off, help="the ski keeps its edge angle everywhere")
    choices.add_argument("--elements", type=whole_number(), metavar="N", help="finite elements over the whole ski")
    choices.add_argument(
        "--at-rest", action="store_const", const=True, help="set down on virgin snow, without side force"
    )
    changes = parser.add_argument_group("changes of the ski")
    for name, what in {"sidecut": "width beyond that of the waist", "width": "width", "EI": "EI", "GJ": "GJ"}.items():
        changes.add_argument(f"--{name}-factor", type=number(""), metavar="F", help=f"factor of its {what}")


def carve_ski(options: argparse.Namespace) -> int:
    """Solve the carved turn of each ski, print and draw it; returns exit status 1 if an equilibrium was not found."""
    from ..carving.answer import answer_question, answers_dict, sensitivities_dict
    from ..carving.question import CARVE_KEYS, carve_question

    prepare_figure(options.figure)
    question = {name: value for name, value in vars(options).items() if name in CARVE_KEYS and value is not None}
    answers = [answer_question(carve_question(question | {"ski": ski})) for ski in options.ski]
    several = len(answers) > 1
    lines = [f"{a.question.ski}: {text}" if several else text for a in answers for text in a.warnings]
    print_warnings(dict.fromkeys(lines))
    result, derivatives = answers_dict(answers), []
    if options.sensitivity is not None:
        names = [name for name in options.sensitivity if name]
        derivatives = [sensitivities_dict(answer.equilibrium, names) for answer in answers]
    for answer, derivative in zip(result.get("skis", [result]), derivatives, strict=False):
        answer["sensitivity"] = derivative
    if options.figure is not None:
        from ..report.carving_figure import carved_skis
        from ..report.figures.drawing import write_figure

        write_figure(options.figure, lambda: carved_skis(result), language=options.language)
        print(f"Figure: {options.figure}", file=sys.stderr)
    if options.json:
        print_json(result)
    else:
        from ..report.summaries import carve_summary

        print(carve_summary(result))
        for answer, derivative in zip(answers, derivatives, strict=False):
            print(_sensitivity_table(answer.ski.name, derivative))
    lost = [str(answer.question.ski) for answer in answers if answer.equilibrium.outcome == "not_converged"]
    if lost:
        text = f"skisnow: no equilibrium was found for {', '.join(lost)}: these numbers are not a solution."
        print(text, file=sys.stderr)
    return 1 if lost else 0


def _sensitivity_table(ski: str, derivatives: list[dict[str, Any]]) -> str:
    """Table for the terminal of the derivatives of each output by each parameter, per unit and in % per %."""
    lines = [f"Derivatives, {ski}:", f"  {'output':26} {'parameter':26} {'per unit':>12} {'% per %':>9}"]
    for row in derivatives:
        relative = "" if row["percent_per_percent"] is None else f"{row['percent_per_percent']:9.4f}"
        lines.append(f"  {row['output']:26} {row['parameter']:26} {row['derivative']:12.6g} {relative:>9}")
    return "\n".join(lines)


def add_design(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow design`` to the program."""
    parser = commands.add_parser(
        "design",
        help="the ski that makes a wanted turn: variables, conditions and goals in, a ski file out",
        description="Find the ski that comes nearest to the goals of DESIGN.toml, by exact derivatives of the carve "
        "and from several starts. Writes ski.toml, ski-rounded.toml, table.csv and design.json.",
    )
    parser.add_argument("design", type=Path, metavar="DESIGN.toml", help="ski, variables, conditions, goals")
    parser.add_argument(
        "--out", type=Path, metavar="FOLDER", help="folder for the files (default: that of DESIGN.toml)"
    )
    parser.add_argument(
        "--front",
        type=whole_number(2, 1000),
        metavar="N",
        help="front.csv and front.json instead: N designs between two targets",
    )
    drawn = "draw both skis in the turn of the first condition: .png, .svg or .pdf"
    parser.add_argument("--figure", type=Path, metavar="FILE", help=drawn)
    parser.add_argument("--json", action="store_true", help="print JSON alone to standard output")
    add_language(parser, "the printed result and the figure")
    parser.set_defaults(run=design_ski)


def design_ski(options: argparse.Namespace) -> int:
    """Search a ski design, write and print it; returns exit status 1 if one of its goals is not reached."""
    prepare_figure(options.figure)
    from ..design import design_ski, read_design

    task = read_design(options.design)
    if options.front is not None:
        return _search_front(options, task)
    with Progress() as progress:
        design = design_ski(task, progress=lambda done, count: progress(f"{done} of {count} starts"))
    paths = design.write(options.out or options.design.parent)
    if options.figure is not None:
        _draw_design(options, task, design)
        paths = (*paths, options.figure)
    if options.json:
        print_json(design.as_dict())
    else:
        with in_language(options.language):
            print(_design_summary(design))
        print("\n".join(f"written: {path}" for path in paths))
    return 0 if design.reached else 1


def _draw_design(options: argparse.Namespace, task: DesignTask, design: Design) -> None:
    """Draw the initial ski and the design in the turn of the first condition."""
    from ..carving.answer import answer_question, answers_dict
    from ..report.carving_figure import carved_skis
    from ..report.figures.drawing import write_figure

    answers = []
    for name, keys in ((design.before.name, design.before.keys), (design.ski.name, design.keys)):
        task.sources.take_ski(name, keys or {})
        answers.append(answer_question(replace(task.conditions[0], ski=name), sources=task.sources))
    write_figure(options.figure, lambda: carved_skis(answers_dict(answers)), language=options.language)


def _search_front(options: argparse.Namespace, task: DesignTask) -> int:
    """Search the Pareto front of two targets, write it, and print the paths or the points; returns exit status 0."""
    from ..design.search import design_front, write_front

    front = design_front(task, points=options.front)
    paths = write_front(front, options.out or options.design.parent)
    if options.json:
        print_json([asdict(point) for point in front])
    else:
        print("\n".join(f"written: {path}" for path in paths))
    return 0


def _design_summary(design: Design) -> str:
    """Text of a design for the terminal: variables, outputs before and after, optima, remarks."""
    names = (Message("before"), Message("design"), Message("change %"), Message("rounded"))
    before, after, change, rounded = map(str, names)
    condition, output = str(Message("condition")), str(Message("output"))
    lines = [f"{Message('variable')!s:24} {after:>12}"]
    lines += [f"{name:24} {_number(value, '12.6g')}" for name, value in design.values.items()]
    lines += ["", f"{condition:>9}  {output:26} {before:>11} {after:>11} {change:>10} {rounded:>11} {'± 95 %':>11}"]
    for row in design.rows:
        numbers = [_number(row.before), _number(row.after), _number(row.change_percent, "10.3g"), _number(row.rounded)]
        numbers += [] if row.half_interval is None else [_number(row.half_interval, "11.3g")]
        lines.append(" ".join([f"{row.condition:9}  {row.output:26}", *numbers]))
    lines += ["", str(Message("local optima, with the share of starts that reached them, and their objective:"))]
    lines += [f"  {optimum.share:5.0%}  {_number(optimum.result, '.6g')}" for optimum in design.optima]
    lines += ["", *map(str, design.remarks), str(Message("equilibria: {count}", count=design.equilibria))]
    return "\n".join(lines)


def _number(value: float | None, form: str = "11.6g") -> str:
    """A number in the form `form`, or spaces of the same width for None."""
    return " " * int(form.partition(".")[0]) if value is None else local_number(f"{value:{form}}")
