"""A problem in a campaign: place, problem, allowed values, fix."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import KW_ONLY, asdict, dataclass, replace
from functools import partial
from types import MappingProxyType
from typing import Final, Literal, TypeAlias

from .._support.messages import Message, joined, template

Severity: TypeAlias = Literal["error", "warning", "flag"]

_SEVERITIES: Final = {"error": Message("error"), "warning": Message("warning"), "flag": Message("flag")}
LONGEST_VALUE: Final = 200
"""Characters of a value that its sentence shows."""


@dataclass(frozen=True, slots=True)
class Problem:
    """A problem of a campaign. ``row`` is the line of the file (header: 1); fields that do not apply are None.

    ``needs_action`` is False for a note on how a file was read.
    """

    severity: Severity
    code: str
    file: str
    _: KW_ONLY
    row: int | None = None
    column: str | None = None
    experiment: str | None = None
    value: str | None = None
    allowed: Message
    action: Message
    needs_action: bool = True

    def __str__(self) -> str:
        """The problem in one line."""
        return str(self.message)

    def text(self, language: str) -> str:
        """One line in a language with severity, code and sentence of the problem."""
        return self.message.text(language)

    @property
    def message(self) -> Message:
        """One line with severity, code and sentence of the problem."""
        severity = _SEVERITIES[self.severity]
        return Message("{severity} {code}: {problem}", severity=severity, code=self.code, problem=self.sentence)

    @property
    def sentence(self) -> Message:
        """Text with place, value, allowed values and fix, without severity and code."""
        place: str = self.file
        if self.row is not None:
            place = Message("{place}, row {row}", place=place, row=self.row)
        if self.column is not None:
            place = Message("{place}, column {column}", place=place, column=self.column)
        if self.experiment is not None:
            place = Message("{place} (experiment {experiment})", place=place, experiment=self.experiment)
        fields = {"place": place, "allowed": self.allowed, "action": self.action}
        if self.value is None:
            return Message("{place}: allowed: {allowed}. {action}", **fields)
        value = self.value if len(self.value) <= LONGEST_VALUE else f"{self.value[:LONGEST_VALUE]}…"
        return Message("{place}: found {value!r}; allowed: {allowed}. {action}", **fields, value=value)

    def as_dict(self) -> dict[str, str | int | None]:
        """Fields of the problem by name, as in the JSON of ``skisnow check --json``."""
        return {name: value for name, value in asdict(self).items() if name != "needs_action"}


error: Final = partial(Problem, "error")
"""Problem with which the campaign cannot be used."""
warning: Final = partial(Problem, "warning")
"""Problem with which the campaign can still be used."""


def with_sheet_name(problem: Problem, places: Mapping[str, str]) -> Problem:
    """Copy of a problem with workbook and sheet instead of the CSV file, if the table is a sheet; else unchanged."""
    place = places.get(problem.file)
    return problem if place is None else replace(problem, file=place)


MOST_ALIKE: Final = 10
"""Problems of one kind in one column that a terminal shows one by one."""


def _limited_lines(problems: Sequence[Problem]) -> Iterator[Message]:
    """One line for each problem; of many problems of a kind in a column the first ones and the number of others."""
    kinds = [(problem.severity, problem.code, problem.file, problem.column) for problem in problems]
    counts, shown = Counter(kinds), Counter[tuple[object, ...]]()
    for kind, problem in zip(kinds, problems, strict=True):
        shown[kind] += 1
        if shown[kind] <= MOST_ALIKE or counts[kind] == MOST_ALIKE + 1:
            yield problem.message
        elif shown[kind] == counts[kind]:
            column = Message("{place}, column {column}", place=problem.file, column=problem.column)
            yield Message(
                "{severity} {code}: {place}: {count} more like these, up to row {row}; --json lists all",
                severity=_SEVERITIES[problem.severity],
                code=problem.code,
                place=column if problem.column else problem.file,
                count=counts[kind] - MOST_ALIKE,
                row=problem.row,
            )


def lines_of(problems: Iterable[Problem]) -> list[Message]:
    """Lines for a terminal: one for each problem, and one for all notes that need no action.

    >>> told = [warning("separator", f"{name}.csv", value="semicolon", allowed="", action="", needs_action=False)
    ...         for name in ("shear", "density")]
    >>> print(*lines_of(told))
    note: no action is needed: semicolon in shear.csv, density.csv.
    """
    every = list(problems)
    files: dict[str, list[str]] = {}
    for problem in every:
        if not problem.needs_action:
            as_text = Message("column {column!r} kept as text", column=problem.value)
            note = as_text if problem.code == "unknown_column" else problem.value
            files.setdefault(note or problem.code, []).append(problem.file)
    notes = [Message("{note} in {files}", note=note, files=list(dict.fromkeys(names))) for note, names in files.items()]
    lines = list(_limited_lines([problem for problem in every if problem.needs_action]))
    no_action = Message("note: no action is needed: {notes}.", notes=joined(notes, "; "))
    return [*lines, no_action] if notes else lines


@dataclass(frozen=True, slots=True)
class AppliedCorrection:
    """A correction that was applied to a cell; ``row`` is the line of the raw file."""

    file: str
    experiment: str
    row: int
    column: str
    old: str
    new: str
    who: str
    when: str
    why: str


FEWEST_LOADS: Final = 3
"""Fewer load steps do not show whether the law holds (modelling assumption)."""
RESOLUTIONS: Final = 5.0
"""A depth of fewer gauge resolutions is read with more than some 6 % of standard uncertainty: 1/(5 √12) (modelling
assumption)."""
CREEP_STEPS: Final = 2.0
"""Growth under a constant load that a gauge distinguishes from its own rounding (modelling assumption)."""
CREEP_SHARE: Final = 0.01
"""The same as a share of the depth: of an edged tool it moves H_V by 2 %, as much as its readings scatter (modelling
assumption). The paper cancelled a series whose depth "constantly and slowly increased", without a number."""


ALWAYS_EXCLUDE: Final = frozenset({"cancelled", "zero_depth"})
"""A campaign may choose which flags exclude, but not these: the observers took the test back, or there is no value."""


_FLAG_NAMES: Final = (
    template("cancelled"), template("too few loads"), template("loads not rising"), template("depth shrinks"),
    template("zero depth"), template("beyond tool"), template("below resolution"), template("layered"),
    template("creeps"), template("unloading not falling"), template("unloading sinks"), template("rebound unresolved"),
    template("hardness outlier"),
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class QualityFlag:
    """A quality flag: code, the sentence that explains it, and whether it excludes by default."""

    code: str
    sentence: str
    excludes_by_default: bool = False

    @property
    def name(self) -> Message:
        """Readable name of the flag in lists, such as "too few loads"."""
        return Message(self.code.replace("_", " "))


_ALL: Final = (
    QualityFlag("cancelled", Message("The experiment was cancelled by an entry in the column status."), True),
    QualityFlag("too_few_loads", Message("The series has fewer than {fewest_loads} load steps.",
                                         fewest_loads=FEWEST_LOADS), True),
    QualityFlag("loads_not_rising", Message("A load of the series is not above the one before it."), True),
    QualityFlag("depth_shrinks", Message("A depth of the series is below the one before it, although the load was "
                                         "raised."), True),
    QualityFlag("zero_depth", Message("The depth is zero (of a series: at its largest load), so that no parameter "
                                      "follows."), True),
    QualityFlag("beyond_tool", Message("The tool went deeper than the geometry that its area and volume are computed "
                                       "with.")),
    QualityFlag("below_resolution", Message("The depth (of a series: at its largest load) is below {resolutions:g} "
                                            "steps of the gauge.", resolutions=RESOLUTIONS)),
    QualityFlag("layered", Message("The hardness of the snow changes with depth, or the depth zero is off by several "
                                   "tenths of a millimetre.")),
    QualityFlag("creeps", Message("Under one load the depth grew by more than {creep_steps:g} steps of the gauge and "
                                  "{creep_share:.0%} of it.", creep_steps=CREEP_STEPS, creep_share=CREEP_SHARE)),
    QualityFlag("unloading_not_falling", Message("A load of the unloading is not below the one before it, so that no "
                                                 "unloading ratio follows.")),
    QualityFlag("unloading_sinks", Message("The tool went deeper while the discs were taken off: the snow was still "
                                           "giving way.")),
    QualityFlag("rebound_unresolved", Message("The tool came back by too little to measure how steep the unloading "
                                              "is: the ratio is only known from below.")),
    QualityFlag("hardness_outlier", Message("The logarithm of the hardness is further than 3.5 scaled median absolute "
                                            "deviations from its site's median.")),
)  # fmt: skip
QUALITY_FLAGS: Final[Mapping[str, QualityFlag]] = MappingProxyType({flag.code: flag for flag in _ALL})
"""Every flag by its code, in the order in which they are listed."""

NEED_HARDNESS: Final = frozenset({"layered", "rebound_unresolved", "hardness_outlier"})
"""Flags that are set where hardness is estimated."""
