"""Running a study, whole or in parts: missing rows are computed, finished rows are stored, the table is written last.

Parts are for the job arrays of batch systems: each computes some points, then all are put together.
"""

from __future__ import annotations

import heapq
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from enum import Enum
from functools import partial
from pathlib import Path
from typing import Any, Final, Self

from .._support.errors import OutputError, ParameterError
from .._support.messages import template
from .._support.processes.batch import ExecutorLike, Progress, compute_missing, require_executor, worker_count
from .._support.processes.kept_rows import KeptRows, NumberedText, json_text
from .._support.staging import cannot_write, write_file
from .._support.user_files.json_text import own_json
from ..compiled import core
from ..parameters import Quantity
from .points import Point
from .study import Study, place_for_previous, read_study, require_csv
from .subjects import StudyModel
from .table import StudyTable, read_table


class StudyState(Enum):
    """State of the file at the path of a study's table."""

    NEW = "new"
    FINISHED = "finished"
    ANOTHER = "another study"


def study_state(study: Study) -> StudyState:
    """State of a study's table: complete, absent, or of another study; ParameterError if it is not one."""
    return table_state(study.out, study.subject.keys, study.fingerprint(), len(study.points))[0]


def table_state(
    out: Path, keys: Mapping[str, Quantity], fingerprint: str, points: int
) -> tuple[StudyState, StudyTable | None]:
    """State of the file at the path of a table, and the table where it is one."""
    if not out.exists():
        return StudyState.NEW, None
    try:
        table = read_table(out, keys)
    except ParameterError as error:
        raise ParameterError("{problem}. It is not replaced: name another place in out, or move it away").tag(
            "wrong_kind", problem=error
        ) from error
    same = len(table.rows) == points and {row["study"] for row in table.rows} == {fingerprint}
    return (StudyState.FINISHED if same else StudyState.ANOTHER), table


def run_study(
    study: Study | str | Path,
    *,
    workers: int | None = None,
    executor: ExecutorLike | None = None,
    progress: Progress | None = None,
) -> StudyTable:
    """Compute the missing points of a study over a grid or a sample of inputs, and write its table.

    Parameters
    ----------
    study
        The study, or the path of its STUDY.toml. A table of the same study is read and not computed again; one of
        another study is moved to `Study.place_for_previous`. A table is not written if no point could be computed.
    workers
        Number of processes; None: one for each core. The table does not depend on it.
    executor
        Executor used instead of processes of this computer, as of `skisnow.run_batch`.
    progress
        Called with the number of finished points and that of all.

    Returns
    -------
    StudyTable
        A row for each point, in their order; the table is written when it is complete.

    Raises
    ------
    ParameterError
        Finished points of another study are next to the table, or something that is not a table has its name;
        or the number of workers is below 1.
    OutputError
        The table's place cannot be written.

    See Also
    --------
    skisnow.read_study : the study of a file.
    skisnow.run_batch : points and your own function.

    References
    ----------
    * McKay, Beckman and Conover (1979), "A comparison of three methods for selecting values of input variables in the
      analysis of output from a computer code", Technometrics 21, 239-245, doi 10.1080/00401706.1979.10489755.
    * The page docs/how-to/study.md.
    """
    workers = worker_count(workers)
    require_executor(executor)
    study = study if isinstance(study, Study) else read_study(study)
    fingerprint = study.fingerprint()
    before = _stamp(study.out)
    state, table = table_state(study.out, study.subject.keys, fingerprint, len(study.points))
    if state is StudyState.FINISHED and table is not None:
        if study.partial.exists():  # a kill between writing the one and removing the other
            kept_rows(study, study.partial, fingerprint).remove()
        return replace(table, varied=study.varied)
    finished_rows = kept_rows(study, study.partial, fingerprint)
    try:
        if _stamp(study.out) != before:
            raise OutputError("{out} was just written by another run. Start again to see its table").tag(
                "in_use", out=study.out
            )
        rows = partial(point_values, study.subject, study.columns[:-1])
        compute_missing(study.points, rows, finished_rows, workers=workers, executor=executor, progress=progress)
        previous = study.place_for_previous() if state is StudyState.ANOTHER else None
        study_table = write_rows(study.out, study.columns, finished_rows.rows(), fingerprint, previous=previous)
        finished_rows.remove()
    finally:
        finished_rows.close()
    return replace(study_table, varied=study.varied)


def kept_rows(study: Study, path: Path, fingerprint: str, **about: str) -> KeptRows:
    """Open or create the file of a study's finished points; `about`: further entries that the file stores."""
    kinds = json_text({name: key.kind for name, key in study.subject.keys.items()})
    columns = json_text(study.columns[:-1])
    about = {"points": str(len(study.points)), "kinds": kinds, "columns": columns, **about}
    return KeptRows.opened(path, fingerprint, about=about)


def write_rows(
    out: Path, columns: Sequence[str], finished: Iterable[tuple[int, Any]], fingerprint: str, *, previous: Path | None
) -> StudyTable:
    """Write the table of all rows and return it; it is not written if no point could be computed.

    columns: columns of the table, the last one for the fingerprint.
    finished: number of each point, and the values of its row without the fingerprint.
    previous: where a table in its place goes; None: no table is there.
    """
    rows = [dict(zip(columns, (*values, fingerprint), strict=True)) for _, values in finished]
    table = StudyTable(tuple(columns), rows, ())
    if table.answers():
        if previous is not None:
            try:
                out.rename(previous)
            except OSError as error:
                raise cannot_write(previous, error) from error
        write_file(out, table.csv())
    return table


def _stamp(path: Path) -> tuple[int, int, int] | None:
    """Inode, size and time of change of a file, which identify its version; None without the file."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_ino, status.st_size, status.st_mtime_ns


def point_values(subject: StudyModel, columns: Sequence[str], point: Point) -> list[Any]:
    """Values of a point's row, computed by a model, in the order of the columns; None for missing values."""
    row = subject(point)
    return [row.get(name) for name in columns]


MOST_SHARDS: Final = 10_000
"""Of one study (more than a job array has)."""
_SHARD: Final = re.compile(r"(\d{1,9})/(\d{1,9})")


@dataclass(frozen=True, slots=True)
class Shard:
    """Part `number` (1 or more) of the `count` parts of a study: every `count`-th point."""

    number: int
    count: int

    @classmethod
    def of(cls, text: str) -> Self:
        """Read ``"2/8"``, the second of eight parts; ParameterError if the text is not a shard."""
        match = _SHARD.fullmatch(text)
        shard = cls(int(match[1]), int(match[2])) if match else None
        if shard is None or not 1 <= shard.number <= shard.count <= MOST_SHARDS:
            raise ParameterError(
                "shard is {text!r}; it is written i/n, from 1/n to n/n, such as 2/8 for the second of eight; n is "
                "{most_shards} at most"
            ).tag("out_of_range", text=text, most_shards=MOST_SHARDS)
        return shard

    def points(self, count: int) -> range:
        """Numbers of the shard's points among `count`: every n-th, so that all shards take about as long."""
        return range(self.number - 1, count, self.count)

    def place(self, study: Study) -> Path:
        """Path of the file with the part's finished points, next to the table."""
        return study.out.with_name(f"{study.out.name}.shard-{self.number}-of-{self.count}")


def run_shard(
    study: Study | str | Path,
    shard: Shard | str,
    *,
    workers: int | None = None,
    executor: ExecutorLike | None = None,
    progress: Progress | None = None,
) -> Path:
    """Compute the points of one part of a study that are missing; several parts may be computed at once.

    study: The study, or the path of its STUDY.toml.
    shard: The part, such as "2/8".
    workers, executor, progress: As of `skisnow.study`.
    Returns: The file of the part, which `merge_shards` takes; it is continued when the part is started again.
    Raises ParameterError: the file is of another study, or the shard is not valid.
    Raises OutputError: the file cannot be written, or another run is writing it.

    References
    ----------
    The page docs/how-to/study.md.
    """
    workers = worker_count(workers)
    require_executor(executor)
    shard = Shard.of(shard) if isinstance(shard, str) else shard
    study = study if isinstance(study, Study) else read_study(study)
    place = shard.place(study)
    finished_rows = kept_rows(study, place, study.fingerprint(), core=core.SOURCE_HASH)
    try:
        numbers = shard.points(len(study.points))
        rows = partial(point_values, study.subject, study.columns[:-1])
        compute_missing(
            study.points, rows, finished_rows, numbers=numbers, workers=workers, executor=executor, progress=progress
        )
    finally:
        finished_rows.close()
    return place


def merge_shards(out: str | Path, parts: Sequence[str | Path]) -> StudyTable:
    """Merge the parts of a study into one table, the same as without parts; the parts stay.

    out: The table; ends in .csv. A table of another study in its place is moved aside.
    parts: The files of `run_shard`, in any order.
    Returns: A row for each point; not written if no point could be computed.
    Raises ParameterError: the parts are of different studies or were computed by different cores, or points are
        missing.
    Raises OutputError: a part is still being computed, or the place cannot be written.

    References
    ----------
    The page docs/how-to/study.md.
    """
    out = Path(out)
    require_csv(out)
    places = [Path(part) for part in parts]
    if not places:
        raise ParameterError("no part is named; name the files of all parts of the study").tag("unknown_name")
    with ExitStack() as opened:
        shard_rows = []
        for place in dict.fromkeys(places):
            shard_rows.append(KeptRows.read(place))
            opened.callback(shard_rows[-1].close)
        return _merge_parts(out, shard_rows)


_OF_ANOTHER_STUDY: Final = template("{path} is a part of another study than {other}. Remove one of them")
_OF_ANOTHER_CORE: Final = template(
    "{path} is a part of this study, computed by another core than {other}. Remove one of them"
)


def _merge_parts(out: Path, parts: Sequence[KeptRows]) -> StudyTable:
    """Table merged from the parts of one study; rejects parts of another study or version, and missing rows."""
    about = [part.about() for part in parts]
    for name, text in (("fingerprint", _OF_ANOTHER_STUDY), ("core", _OF_ANOTHER_CORE)):
        for part, entries in zip(parts, about, strict=True):
            if entries.get(name) != about[0].get(name):
                raise ParameterError(text).tag("another_study", path=part.path, other=parts[0].path)
    if not {"points", "columns"} <= about[0].keys():
        raise ParameterError("{path} is not a part of a study. Name the files that --shard left").tag(
            "unknown_name", path=parts[0].path
        )
    fingerprint, count = about[0]["fingerprint"], int(about[0]["points"])
    _require_whole(parts, count)
    keys = {name: Quantity(name, "", kind=kind) for name, kind in own_json(about[0]["kinds"]).items()}
    state, table = table_state(out, keys, fingerprint, count)
    if state is StudyState.FINISHED and table is not None:
        return table
    previous = place_for_previous(out) if state is StudyState.ANOTHER else None
    columns = (*own_json(about[0]["columns"]), "study")
    return write_rows(out, columns, _merged_rows(parts), fingerprint, previous=previous)


def _merged_rows(parts: Sequence[KeptRows]) -> Iterator[tuple[int, Any]]:
    """Points with the values of their rows, in rising order, each once."""
    last: NumberedText | None = None
    for text in heapq.merge(*(part.texts() for part in parts)):
        if last is None or text[0] != last[0]:
            yield text[0], own_json(text[1])
        elif text[1] != last[1]:
            raise ParameterError("two parts have different rows for point {each}. Compute one of them again").tag(
                "contradiction", each=text[0] + 1
            )
        last = text


def _require_whole(parts: Sequence[KeptRows], count: int) -> None:
    """Reject parts that lack one of the `count` points."""
    is_there = bytearray(count)
    for part in parts:
        for number in part.numbers():
            if 0 <= number < count:  # all others are rejected with their row
                is_there[number] = True
    if missing := is_there.count(0):
        raise ParameterError(
            "{missing} of {count} points are in none of the parts, the first is point {first}. Compute or name the "
            "missing parts"
        ).tag("missing", missing=missing, count=count, first=is_there.index(0) + 1)
