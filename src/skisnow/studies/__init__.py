"""Studies: one question over a grid or a sample of its inputs, in parallel and resumable, as one table."""

from .run import Shard, StudyState, merge_shards, run_shard, run_study, study_state
from .study import Study, read_study
from .table import StudyTable, read_table

__all__ = [
    "Shard", "Study", "StudyState", "StudyTable", "merge_shards", "read_study", "read_table", "run_shard", "run_study",
    "study_state",
]  # fmt: skip
