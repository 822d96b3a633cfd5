"""``skisnow study``: a grid or a sample of carved turns or simulated runs, in parallel, resumable, to one table."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from .._support.errors import ParameterError
from .options import add_language, add_workers
from .output import Progress, ending_is_an_interrupt, prepare_figure, report_interrupt

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..studies import Study, StudyTable


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow study`` to the program."""
    parser = commands.add_parser(
        "study",
        help="carved turns or simulated runs over a grid or a sample of inputs, as one table",
        description="Run a study. Its table goes where STUDY.toml says; an interrupted one goes on when started again.",
    )
    about = "with the varied and fixed inputs and `out`; with --merge the parts"
    parser.add_argument("study", type=Path, nargs="+", metavar="STUDY.toml", help=about)
    add_workers(parser)
    parts = parser.add_mutually_exclusive_group()
    shard = "compute one of n parts, for the jobs of an array: every n-th point, into a file beside the table"
    parts.add_argument("--shard", metavar="i/n", help=shard)
    merge = "put parts together to this table: skisnow study --merge TABLE PART PART …"
    parts.add_argument("--merge", type=Path, metavar="TABLE", help=merge)
    parser.add_argument("--figure", type=Path, metavar="FILE", help="draw a map of the table: .png, .svg or .pdf")
    add_language(parser, "the map")
    about = "radius over edge angle, or where the edge loses grip; default: radius"
    parser.add_argument("--map", choices=("radius", "grip"), default="radius", help=about)
    parser.set_defaults(run=run, parser=parser)


def run(options: argparse.Namespace) -> int:
    """Run, resume or combine the study; returns 1 if no point could be computed."""
    if options.merge is not None:
        return _merge_shards(options)
    if len(options.study) > 1:
        options.parser.error("one STUDY.toml is taken; several files are the parts of --merge TABLE")
    (file,) = options.study
    prepare_figure(options.figure)
    from ..studies import read_study

    study = read_study(file)
    return _run_whole(options, study) if options.shard is None else _run_part(options, study)


def _run_whole(options: argparse.Namespace, study: Study) -> int:
    """Compute a study with its figure; returns the exit status, which is 1 if all points failed."""
    from ..studies import run_study

    if options.figure is not None and "turn_radius_boot_m" not in study.columns:
        raise ParameterError("--figure draws maps of carved turns; remove it for simulated runs and use the table").tag(
            "not_supported"
        )
    _print_state(study)
    try:
        with ending_is_an_interrupt(), Progress() as progress:
            table = run_study(study, workers=options.workers, progress=_print_points(progress))
    except KeyboardInterrupt as stopped:
        return report_interrupt(stopped, study.partial)
    _print_outcomes(study.out, table)
    if _all_points_failed(study.out, table):
        return 1
    if options.figure is not None:
        from ..report.figures.drawing import write_figure
        from ..report.study_maps import grip_map, radius_map

        draw = {"radius": radius_map, "grip": grip_map}[options.map]
        write_figure(options.figure, lambda: draw(table), language=options.language)
        print(f"Figure: {options.figure}", file=sys.stderr)
    return 0


def _run_part(options: argparse.Namespace, study: Study) -> int:
    """Compute the part of a study that --shard names, and print its file; returns the exit status."""
    from ..studies import Shard, run_shard

    if options.figure is not None:
        raise ParameterError("--figure needs the whole table; draw it when the parts are put together").tag("missing")
    shard = Shard.of(options.shard)
    try:
        with ending_is_an_interrupt(), Progress() as progress:
            place = run_shard(study, shard, workers=options.workers, progress=_print_points(progress))
    except KeyboardInterrupt as stopped:
        return report_interrupt(stopped, shard.place(study))
    print(f"{place}: points {len(shard.points(len(study.points)))} of {len(study.points)}")
    return 0


def _print_points(progress: Progress) -> Callable[[int, int], None]:
    """Callback that shows the numbers of finished and all points as progress."""
    return lambda done, total: progress(f"{done} of {total} points")


def _merge_shards(options: argparse.Namespace) -> int:
    """Put the parts of a study together into its table; returns the exit status, 1 if all points failed."""
    from ..studies import merge_shards

    if options.figure is not None:
        options.parser.error("--merge computes nothing: it takes a table and the files that --shard left, and no more")
    table = merge_shards(options.merge, options.study)
    _print_outcomes(options.merge, table)
    return 1 if _all_points_failed(options.merge, table) else 0


def _all_points_failed(place: Path, table: StudyTable) -> bool:
    """True, after a message on standard error, if every point of a table failed."""
    if table.answers():
        return False
    print(f"skisnow: not one point could be asked; {place} was not written.", file=sys.stderr)
    return True


def _print_state(study: Study) -> None:
    """Print, on standard error, that the study is finished already or that another one is in its place."""
    from ..studies import StudyState, study_state

    state = study_state(study)
    if state is StudyState.ANOTHER:
        place = study.place_for_previous()
        print(f"{study.out} holds another study; it goes to {place} when this one is finished.", file=sys.stderr)
    if state is StudyState.FINISHED:
        print(f"{study.out} holds this study already; nothing is computed again.", file=sys.stderr)


def _print_outcomes(place: Path, table: StudyTable) -> None:
    """Print the counts of outcomes, and the first failed and first warned point on standard error."""
    from ..studies.table import FAILED

    counts = ", ".join(f"{outcome} {count}" for outcome, count in table.counts().items())
    print(f"{place}: points {len(table.rows)} ({counts})")
    rows = list(enumerate(table.rows, start=1))
    failed = [(number, row.get("reason")) for number, row in rows if row["outcome"] == FAILED]
    warned = [(number, row["warnings"]) for number, row in rows if row.get("warnings")]
    for points, what in ((failed, "have an input that is not allowed"), (warned, "carry warnings")):
        if points:
            row, text = points[0]
            count = "1 point" if len(points) == 1 else f"{len(points)} points"
            print(f"warning: {count} {what}; the first, row {row}: {text}", file=sys.stderr)
