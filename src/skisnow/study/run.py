"""Running a study: what is finished is kept, what is missing is computed, the table is complete or not there."""

from __future__ import annotations

from enum import Enum
from pathlib import Path

from ..errors import ParameterError
from ..files import cannot_write, write_file
from ..parallel.batch import Progress, run_batch
from ..parallel.kept_rows import KeptRows
from ..parallel.pool import workers_in_force
from .study import Study
from .study_file import read_study
from .table import StudyTable, read_table


class StudyState(Enum):
    """What stands at the place of a study's table."""

    NEW = "new"
    FINISHED = "finished"
    ANOTHER = "another study"


def study_state(study: Study) -> StudyState:
    """Whether the table of this study, or of another one, is there.

    Raises
    ------
    ParameterError
        A file that is no study's table stands in its place: it is not replaced.
    """
    if not study.out.exists():
        return StudyState.NEW
    try:
        table = read_table(study.out, study.subject.keys)
    except ParameterError as error:
        raise ParameterError(f"{error}. It is not replaced: name another place in out, or move it away") from error
    names = {row["study"] for row in table.rows}
    same = names == {study.fingerprint()} and len(table.rows) == len(study.points)
    return StudyState.FINISHED if same else StudyState.ANOTHER


def run_study(study: Study | str | Path, *, workers: int | None = None, progress: Progress | None = None) -> StudyTable:
    """Ask one question over a grid or a sample of its inputs: compute the points that are missing, write the table.

    Parameters
    ----------
    study
        What to do, or the path of its STUDY.toml. A table of the same study is read and not computed again; one of
        another study is moved to `Study.place_for_previous`. A table in which no point could be asked is not written.
    workers
        Number of processes; None: one for each core. The table does not depend on it.
    progress
        Called with the number of finished points and that of all.

    Returns
    -------
    StudyTable
        A row for each point, in their order; the table is written when it is complete.

    Raises
    ------
    ParameterError
        Finished points of another study stand beside the table, or something that is no table stands in its place;
        or the number of workers is below 1.
    OutputError
        The table's place cannot be written.

    See Also
    --------
    skisnow.read_study : the study of a file.
    skisnow.run_batch : points and a function of your own.

    References
    ----------
    * McKay, Beckman and Conover (1979), "A comparison of three methods for selecting values of input variables in the
      analysis of output from a computer code", Technometrics 21, 239-245, doi 10.1080/00401706.1979.10489755.
    * The page docs/how-to/study.md.
    """
    workers = workers_in_force(workers)
    study = study if isinstance(study, Study) else read_study(study)
    fingerprint = study.fingerprint()
    state = study_state(study)
    if state is StudyState.FINISHED:
        if study.partial.exists():  # a kill between writing the one and removing the other
            KeptRows.opened(study.partial, fingerprint).remove()
        return read_table(study.out, study.subject.keys, varied=study.varied)
    kept = KeptRows.opened(study.partial, fingerprint)
    try:
        rows = run_batch(study.points, study.subject, kept=kept, workers=workers, progress=progress)
        table = StudyTable(study.columns, [row | {"study": fingerprint} for row in rows], study.varied)
        if table.answers():
            if state is StudyState.ANOTHER:
                _move(study.out, study.place_for_previous())
            write_file(study.out, table.csv())
        kept.remove()
    finally:
        kept.close()
    return table


def _move(table: Path, place: Path) -> None:
    try:
        table.rename(place)
    except OSError as error:
        raise cannot_write(place, error) from error
