"""A study: its points, who answers them, and where the table goes."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any, Protocol, TypeAlias

from .._support.display import Facts, Shown
from .._support.processes.kept_rows import Row
from .._support.user_files import is_file
from ..parameters import Quantity
from .points import ListedPoints, Point, Points


class StudyModel(Protocol):
    """What can be studied. It is pickled for each worker; one more subject is one more class."""

    @property
    def keys(self) -> Mapping[str, Quantity]:
        """The inputs by name, in the order of the table's columns."""
        ...

    @property
    def results(self) -> tuple[str, ...]:
        """The columns of results."""
        ...

    def named(self, table: Mapping[str, Any]) -> dict[str, Any]:
        """The values of a table of the study under the names of `keys`; a name that is none may stay."""
        ...

    def require_sound(self, points: Points, fixed: Point) -> None:
        """Refuse points that cannot be a study: an input is missing, two say the same, what is fixed cannot be read."""
        ...

    def files(self, points: Points) -> list[Path]:
        """Files that the points name: when one of them changes, the study is another."""
        ...

    def __call__(self, point: Point) -> Row:
        """Inputs and results of one point; never raises for a bad point."""
        ...


ModelReader: TypeAlias = Callable[[Path], StudyModel]
"""Makes a subject whose relative paths start at a folder."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Study(Shown):
    """A study as its file says it.

    Attributes
    ----------
    file
        The file it was read from.
    out
        Where the table goes.
    subject
        What is studied.
    varied
        Names of the inputs that vary, in the order of the file: the last varies fastest.
    points
        The inputs of every point: a list of them, or what makes each from its number.

    See Also
    --------
    skisnow.read_study
    """

    file: Path
    out: Path
    subject: StudyModel
    varied: tuple[str, ...]
    points: Sequence[Point]

    def _facts(self) -> Facts:
        subject = type(self.subject).__name__
        rows = (("of", subject), ("varied", ", ".join(self.varied)), ("table", str(self.out)))
        return Facts(f"of {len(self.points)} points, {self.file}", rows)

    @property
    def numbered(self) -> Points:
        """The points as such."""
        return self.points if isinstance(self.points, Points) else ListedPoints(self.points)

    @property
    def columns(self) -> tuple[str, ...]:
        """Columns of the table."""
        return (*self.subject.keys, *self.subject.results, "study")

    @property
    def partial(self) -> Path:
        """Where finished points are kept until the table is complete."""
        return self.out.with_name(f"{self.out.name}.partial")

    def place_for_previous(self) -> Path:
        """Where another study's table goes that stands in this one's place: a name that is free."""
        return place_for_previous(self.out)

    def fingerprint(self) -> str:
        """Sixteen hexadecimal digits that change with any point, any file that points name, and skisnow's version."""
        points = self.numbered
        digest = hashlib.sha256(json.dumps([version("skisnow"), self.columns])[:-1].encode())
        lead = ", ["
        for text in points.json_texts():
            digest.update(f"{lead}{text}".encode())
            lead = ", "
        digest.update(b"]]")
        for path in self.subject.files(points):
            digest.update(b"\0" + (path.read_bytes() if is_file(path) else b"absent"))
        return digest.hexdigest()[:16]


def place_for_previous(out: Path) -> Path:
    """Where a table of another study goes: a name beside its own that is free."""
    place, count = out.with_name(f"{out.stem}.previous{out.suffix}"), 1
    while place.exists():
        count += 1
        place = out.with_name(f"{out.stem}.previous-{count}{out.suffix}")
    return place
