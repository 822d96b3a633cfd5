"""What workers compute of a study: the values of a row, where they have the same files."""

from __future__ import annotations

import hashlib
import platform
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from .._support.errors import SkisnowError
from .._support.user_files import is_file
from .points import Point
from .study import Study, StudyModel


@dataclass(frozen=True, slots=True)
class StudyRows:
    """From a point to the values of its row.

    Attributes
    ----------
    subject
        Who answers.
    columns
        Of the table, without the study's fingerprint.
    files
        What the points read, with the hash of each.
    """

    subject: StudyModel
    columns: tuple[str, ...]
    files: tuple[tuple[Path, str], ...]

    @classmethod
    def of(cls, study: Study) -> Self:
        """Of a study whose files are as they are now."""
        files = [path.absolute() for path in study.subject.files(study.numbered)]
        return cls(study.subject, study.columns[:-1], tuple((path, _hash(path)) for path in files))

    def __call__(self, point: Point) -> list[Any]:
        """Values in the order of the columns, None where a row has none."""
        row = self.subject(point)
        return [row.get(name) for name in self.columns]

    def require_files(self) -> None:
        """Refuse a worker on which a file is another one or is missing.

        Raises
        ------
        SkisnowError
            It names computer and file.
        """
        for path, wanted in self.files:
            if _hash(path) != wanted:
                raise SkisnowError(
                    f"the worker on {platform.node()} has not the {path} of this study. Put the study into a folder "
                    "that all computers share"
                )


def _hash(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest() if is_file(path) else "absent"
