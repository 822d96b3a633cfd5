"""A study: its definition in STUDY.toml, its points, its model, and the path of its table."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Annotated, Any, Final, TypeAlias

from .._support.errors import ParameterError
from .._support.units import Facts, Shown
from .._support.user_files.text_files import is_file, read_toml
from ..parameters import Allowed, Quantity, build_declared, checked_table, suggest_and_list
from .points import Axis, Point, grid_points, hypercube_points
from .subjects import CarveModel, ScenarioModel, StudyModel

FORMS: Final = ("grid", "latin_hypercube")
OWN_KEYS: Final[Mapping[str, tuple[str, ...]]] = {"grid": (), "latin_hypercube": ("n", "seed")}
"""Keys of each form that are not inputs."""
TOP_KEYS: Final = ("out", "scenario", "fixed", *FORMS)

ModelReader: TypeAlias = Callable[[Path], StudyModel]
"""Function that makes a model whose relative paths start at a folder."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Study(Shown):
    """A study as defined in its file.

    Attributes
    ----------
    file
        The file it was read from.
    out
        Where the table goes.
    subject
        Model that computes the points.
    varied
        Names of the inputs that vary, in the order of the file: the last varies fastest.
    points
        Inputs of every point.

    See Also
    --------
    skisnow.read_study
    """

    file: Path
    out: Path
    subject: StudyModel
    varied: tuple[str, ...]
    points: Sequence[Point]

    def _repr_facts(self) -> Facts:
        """Title with the number of points and the file, and rows with the model, inputs and table."""
        subject = type(self.subject).__name__
        rows = (("of", subject), ("varied", ", ".join(self.varied)), ("table", str(self.out)))
        return Facts(f"of {len(self.points)} points, {self.file}", rows)

    @property
    def columns(self) -> tuple[str, ...]:
        """Columns of the table."""
        return (*self.subject.keys, *self.subject.results, "study")

    @property
    def partial(self) -> Path:
        """Path of the finished points until the table is complete."""
        return self.out.with_name(f"{self.out.name}.partial")

    def place_for_previous(self) -> Path:
        """Free path to which another study's table is moved, if it is at the path of this one's table."""
        return place_for_previous(self.out)

    def fingerprint(self) -> str:
        """Sixteen hexadecimal digits that change with any point, any file that points name, and skisnow's version."""
        digest = hashlib.sha256(repr((version("skisnow"), self.columns)).encode())
        for point in self.points:
            digest.update(repr(point).encode())
        for path in self.subject.files(self.points):
            digest.update(b"\0" + (path.read_bytes() if is_file(path) else b"absent"))
        return digest.hexdigest()[:16]


def place_for_previous(out: Path) -> Path:
    """Free path in the same folder to which another study's table at `out` is moved."""
    place, count = out.with_name(f"{out.stem}.previous{out.suffix}"), 1
    while place.exists():
        count += 1
        place = out.with_name(f"{out.stem}.previous-{count}{out.suffix}")
    return place


@dataclass(frozen=True, slots=True)
class Sample:
    """Number of points of a sample, and the seed."""

    n: Annotated[int, Quantity("n", "number of points"), Allowed(1)]
    seed: Annotated[int, Quantity("seed", "a whole number that the points follow from"), Allowed(0)]


def read_study(path: str | Path, *, subject: ModelReader = CarveModel) -> Study:
    """Read a study from its file, without computing it.

    Parameters
    ----------
    path
        STUDY.toml. Paths in it are relative to its folder.
    subject
        Function that makes the study's model from its folder, if the file names no scenario.

    Returns
    -------
    Study
        Its points, not yet computed.

    Raises
    ------
    ParameterError
        The file cannot be read, a key is unknown (the message names the nearest), missing, repeated or of the wrong
        kind, or the inputs are incomplete; or a value under [fixed] is out of range, or names a ski or a snow that
        cannot be read. Such a value of a varied input is an error of its points, not of the study.

    See Also
    --------
    skisnow.study : computes them.

    References
    ----------
    * McKay, Beckman and Conover (1979), "A comparison of three methods for selecting values of input variables in the
      analysis of output from a computer code", Technometrics 21, 239-245, doi 10.1080/00401706.1979.10489755.
    * The page docs/files/carve.md.
    """
    path = Path(path)
    values = read_toml(path)
    try:
        return _make_study(path, values, subject)
    except ParameterError as error:
        raise error.at(path) from error


def _make_study(path: Path, values: Mapping[str, Any], subject: ModelReader) -> Study:
    """Study from a file's values; rejects unknown keys, and a study without a varied input."""
    for key in values:
        if key not in TOP_KEYS:
            raise ParameterError("{key} is not a key of a study. {allowed}").tag(
                "unknown_name", key=key, allowed=suggest_and_list(key, TOP_KEYS)
            )
    subject_ = _make_model(path, values, subject)
    forms = [form for form in FORMS if form in values]
    if len(forms) != 1:
        raise ParameterError("a study has either [grid] or [latin_hypercube]; {count} of them are there").tag(
            "contradiction", count=len(forms)
        )
    form = forms[0]
    fixed = _read_fixed(subject_.named(_read_section(values, "fixed")), subject_.keys)
    varying = _read_section(values, form)
    inputs = subject_.named({name: value for name, value in varying.items() if name not in OWN_KEYS[form]})
    axes = [_make_axis(form, name, value, subject_.keys, fixed) for name, value in inputs.items()]
    if not axes:
        raise ParameterError("[{form}] contains no varied input; write one, such as edge_angle_deg = [30, 45, 60]").tag(
            "missing", form=form
        )
    if form == "grid":
        points = grid_points(axes, fixed)
    else:
        own = {name: varying[name] for name in OWN_KEYS[form] if name in varying}
        sample = build_declared(Sample, checked_table(Sample, own, "[latin_hypercube]"))
        points = hypercube_points(axes, fixed, sample.n, sample.seed)
    subject_.require_sound(points, fixed)
    return Study(path, _table_path(path, values), subject_, tuple(axis.key.name for axis in axes), points)


def _make_model(path: Path, values: Mapping[str, Any], subject: ModelReader) -> StudyModel:
    """Model of a study: the scenario that it names, otherwise that of `subject`."""
    if "scenario" not in values:
        return subject(path.parent)
    word = values["scenario"]
    if not isinstance(word, str) or not word.strip():
        raise ParameterError('scenario is {word!r}; it is a name or a file, such as scenario = "carved-46m"').tag(
            "wrong_kind", word=word
        )
    return ScenarioModel(path.parent, word)


def _read_section(values: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    """Section of a study, empty if it is missing; rejects anything but a table."""
    table = values.get(name, {})
    if not isinstance(table, dict):
        raise ParameterError("{name} is {table!r}; it must be a table, begun by the line [{name}]").tag(
            "wrong_kind", name=name, table=table
        )
    return table


def _read_fixed(table: Mapping[str, Any], keys: Mapping[str, Quantity]) -> Point:
    """Fixed inputs, one value each; rejects unknown names and values out of range."""
    fixed = {}
    for name, value in table.items():
        _require_key("fixed", name, keys)
        if isinstance(value, dict) or (isinstance(value, list) and keys[name].kind != "three numbers"):
            raise ParameterError("fixed.{name} is {value!r}; it takes one value. Put varying values into [grid]").tag(
                "wrong_kind", name=name, value=value
            )
        try:
            fixed[name] = keys[name].in_range(value)
        except ParameterError as error:
            raise ParameterError("fixed.{problem}").tag(error.code, problem=error) from error
    return fixed


def _make_axis(form: str, name: str, value: object, keys: Mapping[str, Quantity], fixed: Point) -> Axis:
    """Axis of a varied input; rejects an unknown name, or an input that is also fixed."""
    _require_key(form, name, (*OWN_KEYS[form], *keys))
    if name in fixed:
        raise ParameterError("{name} is in [{form}] and in [fixed]. Remove one of them").tag(
            "contradiction", name=name, form=form
        )
    return Axis.of(keys[name], value)


def _require_key(table: str, name: str, keys: Collection[str]) -> None:
    """Reject a name that is no input."""
    if name not in keys:
        raise ParameterError("{table}.{name} is not an input. {allowed}").tag(
            "unknown_name", table=table, name=name, allowed=suggest_and_list(name, keys)
        )


def _table_path(path: Path, values: Mapping[str, Any]) -> Path:
    """Path of the result table, in the study's folder; its name must end in .csv."""
    out = values.get("out")
    if not isinstance(out, str) or not out.strip():
        raise ParameterError('out is {out!r}; it is the place of the table, such as out = "table.csv"').tag(
            "wrong_kind", out=out
        )
    require_csv(out)
    return path.parent / out


def require_csv(out: str | Path) -> None:
    """Raise a ParameterError for the name of a table that does not end in .csv."""
    if Path(out).suffix.lower() != ".csv":
        raise ParameterError("out is {out!r}; the name of the table must end in .csv").tag("wrong_ending", out=str(out))
