"""All single errors that can be planted in a file, each as a replaced piece of its text."""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

_OTHERS: Final[dict[str, tuple[str, ...]]] = {
    "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",), "//": ("/",), "%": ("*",), "**": ("*",), "@": ("*",),
    "&": ("|",), "|": ("&",), "^": ("&",), "<<": (">>",), ">>": ("<<",),
    "<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",),
    "is not": ("is",), "is": ("is not",), "not in": ("in",), "in": ("not in",), "and": ("or",), "or": ("and",),
}  # fmt: skip
_TOKEN: Final = re.compile(r"#[^\n]*|(is\s+not|not\s+in|\*\*|//|<<|>>|<=|>=|==|!=|\b(?:is|in|and|or)\b|[-+*/%@&|^<>])")
SYMMETRIC: Final = frozenset({"hypot", "max", "maximum", "min", "minimum"})
"""Functions that give the same whatever the order of their arguments."""


@dataclass(frozen=True)
class Mutant:
    """A file's text with one error: characters `start` to `stop` are replaced by `text`."""

    kind: str
    start: int
    stop: int
    text: str

    def planted(self, source: str) -> str:
        """The file with the error."""
        return source[: self.start] + self.text + source[self.stop :]

    def is_another_program(self, source: str) -> bool:
        """False where what is planted cannot be read, or reads the same."""
        try:
            return ast.dump(ast.parse(self.planted(source))) != ast.dump(ast.parse(source))
        except SyntaxError:
            return False


def mutants(source: str) -> list[Mutant]:
    """Every error that can be tried, in the order of the text."""
    text = _Text(source)
    found = {mutant: None for node in _walked(ast.parse(source)) for mutant in text.errors_at(node)}
    return sorted(found, key=lambda each: (each.start, each.stop))


def _walked(node: ast.AST) -> Iterator[ast.AST]:
    """All nodes but those of types and of what only a type checker reads."""
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST) and not _is_left_out(child):
                yield child
                yield from _walked(child)


def _is_left_out(node: ast.AST) -> bool:
    type_checking = isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test)
    a_cast = isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "cast"
    a_type = isinstance(node, ast.AnnAssign) and "TypeAlias" in ast.dump(node.annotation)
    # Python 3.11 does not say where the parts of an f-string stand
    return type_checking or a_cast or a_type or isinstance(node, ast.JoinedStr)


class _Text:
    """A file's text, and where the nodes of its tree are in it."""

    def __init__(self, source: str) -> None:
        self.source = source
        self.lines = [line.encode() for line in source.splitlines(keepends=True)]
        self.starts = [0]
        for line in self.lines:
            self.starts.append(self.starts[-1] + len(line.decode()))

    def errors_at(self, node: ast.AST) -> Iterator[Mutant]:
        """All errors at one node."""
        yield from self._operators(node)
        yield from self._values(node)
        yield from self._conditions(node)
        if isinstance(node, ast.Call):
            yield from self._swapped_arguments(node)

    def _span(self, node: ast.AST) -> tuple[int, int]:
        """First character and the one after the last: a tree counts bytes in lines, a text characters."""
        line, last = node.lineno - 1, (node.end_lineno or 1) - 1  # type: ignore[attr-defined]
        start = self.starts[line] + len(self.lines[line][: node.col_offset].decode())  # type: ignore[attr-defined]
        return start, self.starts[last] + len(self.lines[last][: node.end_col_offset].decode())  # type: ignore[attr-defined]

    def _whole(self, kind: str, node: ast.AST, form: str) -> Mutant:
        start, stop = self._span(node)
        return Mutant(kind, start, stop, form.format(self.source[start:stop]))

    def _operators(self, node: ast.AST) -> Iterator[Mutant]:
        match node:
            case ast.BinOp(left=left, right=right) | ast.AugAssign(target=left, value=right):
                yield from self._between("arithmetic", left, right)
            case ast.Compare(left=left, comparators=others):
                yield from self._between("comparison", left, *others)
            case ast.BoolOp(values=values):
                yield from self._between("and, or", *values)
            case ast.UnaryOp(op=ast.USub() | ast.Not(), operand=operand):
                start, stop = self._span(node)[0], self._span(operand)[0]
                yield Mutant("sign", start, stop, "(" * self.source[start:stop].count("("))

    def _between(self, kind: str, *parts: ast.AST) -> Iterator[Mutant]:
        for left, right in pairwise(parts):
            tokens = _TOKEN.finditer(self.source, self._span(left)[1], self._span(right)[0])
            token = next(each for each in tokens if each[1])
            for other in _OTHERS[" ".join(token[1].split())]:
                yield Mutant(kind, *token.span(1), other)

    def _values(self, node: ast.AST) -> Iterator[Mutant]:
        match node:
            case ast.Constant(value=bool(value)):
                yield self._whole("constant", node, str(not value))
            case ast.Constant(value=int(value) | float(value)):
                yield from (self._whole("constant", node, repr(value + by)) for by in (1, -1))
            case ast.Return(value=ast.expr() as returned):
                yield self._whole("returned value", returned, "None")
            case ast.Raise() | ast.Expr(value=ast.Call()):
                yield self._whole("statement", node, "pass")

    def _conditions(self, node: ast.AST) -> Iterator[Mutant]:
        tests = [node.test] if isinstance(node, ast.If | ast.IfExp | ast.While) else []
        tests += node.ifs if isinstance(node, ast.comprehension) else []
        yield from (self._whole("condition", test, "(not ({}))") for test in tests)

    def _swapped_arguments(self, call: ast.Call) -> Iterator[Mutant]:
        name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
        if name in SYMMETRIC:
            return
        for left, right in pairwise(call.args):
            if not isinstance(left, ast.Starred) and not isinstance(right, ast.Starred):
                (start, end), (begin, stop) = self._span(left), self._span(right)
                text = self.source[begin:stop] + self.source[end:begin] + self.source[start:end]
                yield Mutant("arguments", start, stop, text)
