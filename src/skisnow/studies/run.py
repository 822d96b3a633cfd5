"""Running a study: missing rows are computed, finished rows are stored, the complete table is written last."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path
from typing import Any, Self

from .._support.errors import OutputError, ParameterError
from .._support.processes.batch import ExecutorLike, Progress, compute_missing, require_executor, worker_count
from .._support.processes.kept_rows import KeptRows, json_text
from .._support.staging import cannot_write, write_file
from ..parameters import Quantity
from .points import Point
from .study import Study, StudyModel, read_study
from .table import StudyTable, read_table


class StudyState(Enum):
    """State of the file at the path of a study's table."""

    NEW = "new"
    FINISHED = "finished"
    ANOTHER = "another study"


def study_state(study: Study) -> StudyState:
    """State of the table of this study: complete, absent, or of another study.

    Raises ParameterError: a file that is not a study's table has its name: it is not replaced.
    """
    if not study.out.exists():
        return StudyState.NEW
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
    tally = table.tally()
    same = tally.rows == points and tally.studies == {fingerprint}
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
        rows = StudyRows.of(study)
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


@dataclass(frozen=True, slots=True)
class StudyRows:
    """Function that computes the values of a table row from the inputs of a point.

    subject: model that computes the values of a point.
    columns: columns of the table without the fingerprint of the study.
    """

    subject: StudyModel
    columns: tuple[str, ...]

    @classmethod
    def of(cls, study: Study) -> Self:
        """Rows of a study."""
        return cls(study.subject, study.columns[:-1])

    def __call__(self, point: Point) -> list[Any]:
        """Values in the order of the columns, None for missing values."""
        row = self.subject(point)
        return [row.get(name) for name in self.columns]
