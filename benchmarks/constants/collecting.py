"""Every constant number of the sources: `constexpr` of the core, upper-case numbers of the Python that a run uses."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).resolve().parents[2]
CORE: Final = ROOT / "src" / "core"
PACKAGE: Final = ROOT / "src" / "skisnow"
FOLDERS: Final = ("contact", "dynamics", "carving", "ski", "simulation", "skier", "forces")
REMARK: Final = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
_DECLARATION: Final = re.compile(
    r"(?P<words>(?:static |inline )*constexpr (?:static )?)"
    r"(?P<kind>double|float|int|long|std::size_t|std::int64_t|std::uint64_t) (?P<rest>\w+(?:\[[^\]]*\])?\s*=[^;]*);"
)
_NAMED: Final = re.compile(r"^(?P<name>\w+)(?P<array>\[[^\]]*\])?\s*=\s*(?P<value>.*)$", re.DOTALL)
_UPPER: Final = re.compile(r"^_?[A-Z][A-Z0-9_]*$")


@dataclass(frozen=True, slots=True)
class Constant:
    """A constant number.

    Attributes
    ----------
    file, name
        Path from `src`, and the name there.
    value
        Its text in the source.
    start, end
        Where that text is in the file; of a declaration in C++, of the whole of it.
    kind
        Type in C++, ``python`` in Python.
    is_array
        Whether it is several numbers.
    """

    file: str
    name: str
    value: str
    start: int
    end: int
    kind: str
    is_array: bool = False

    @property
    def key(self) -> str:
        """File and name."""
        return f"{self.file}:{self.name}"


def constants() -> list[Constant]:
    """All of them, by file."""
    core = [each for path in sorted(CORE.rglob("*.[hc]pp")) for each in in_cpp(path)]
    modules = [path for folder in FOLDERS for path in sorted((PACKAGE / folder).rglob("*.py"))]
    return [*core, *(each for path in modules for each in in_python(path))]


def in_cpp(path: Path) -> Iterator[Constant]:
    """Of a file of the core. Remarks are blanked, so that places stay."""
    text = REMARK.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), path.read_text(encoding="utf-8"))
    file = path.relative_to(ROOT / "src").as_posix()
    for found in _DECLARATION.finditer(text):
        for declared in split_at_commas(found["rest"]):
            named = _NAMED.match(declared.strip())
            if named is None:
                raise SystemExit(f"{file}: {found[0]!r} is no list of numbers with names")
            value = re.sub(r"\s+", " ", named["value"].strip())
            yield Constant(
                file, named["name"], value, found.start(), found.end(), found["kind"], named["array"] is not None
            )


def split_at_commas(text: str) -> list[str]:
    """The parts between commas that stand in no brackets.

    >>> split_at_commas("A = {1, 2}, B = max(3, 4)")
    ['A = {1, 2}', ' B = max(3, 4)']
    """
    parts, depth = [""], 0
    for each in text:
        depth += (each in "({[") - (each in ")}]")
        if each == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += each
    return parts


def in_python(path: Path) -> Iterator[Constant]:
    """Of a module: what stands in capitals for a number, alone or in a tuple of names."""
    text = path.read_text(encoding="utf-8")
    lines = [0]
    for line in text.splitlines(keepends=True):
        lines.append(lines[-1] + len(line))
    file = path.relative_to(ROOT / "src").as_posix()
    for node in ast.parse(text).body:
        for name, value in _assigned(node):
            if _UPPER.match(name) and _is_number(value):
                start, end = (
                    lines[row - 1] + len(text.splitlines()[row - 1].encode()[:column].decode())
                    for row, column in (
                        (value.lineno, value.col_offset),
                        (value.end_lineno or 0, value.end_col_offset or 0),
                    )
                )
                yield Constant(file, name, ast.unparse(value), start, end, "python")


def _assigned(node: ast.stmt) -> Iterator[tuple[str, ast.expr]]:
    if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and node.value is not None:
        yield node.target.id, node.value
    if not isinstance(node, ast.Assign) or len(node.targets) != 1:
        return
    target = node.targets[0]
    if isinstance(target, ast.Name):
        yield target.id, node.value
    elif isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple):
        for each, value in zip(target.elts, node.value.elts, strict=True):
            if isinstance(each, ast.Name):
                yield each.id, value


def _is_number(node: ast.expr) -> bool:
    """Whether it is a number, or arithmetic of numbers and functions of `math`."""
    if isinstance(node, ast.Constant):
        return isinstance(node.value, int | float) and not isinstance(node.value, bool)
    if isinstance(node, ast.UnaryOp):
        return _is_number(node.operand)
    if isinstance(node, ast.BinOp):
        return _is_number(node.left) and _is_number(node.right)
    if isinstance(node, ast.Call):
        return _of_math(node.func) and all(_is_number(each) for each in node.args)
    return _of_math(node) or (isinstance(node, ast.Name) and bool(_UPPER.match(node.id)))


def _of_math(node: ast.expr) -> bool:
    return isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in ("math", "np")
