"""The plan of the packages: no file is reached again by what it imports, not even for a type."""

import ast
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from itertools import chain
from pathlib import Path

import pytest

import skisnow

SOURCE = Path(skisnow.__file__).parents[1]


def module_of(path: Path) -> str:
    return ".".join(path.relative_to(SOURCE).with_suffix("").parts).removesuffix(".__init__")


def statements(node: ast.AST) -> Iterator[ast.AST]:
    """All statements below a node: `ast.walk` visits expressions, too, and takes much longer."""
    parts = ("body", "handlers", "orelse", "finalbody", "cases")
    for each in chain.from_iterable(getattr(node, part, ()) for part in parts):
        yield each
        yield from statements(each)


def imported(path: Path, modules: set[str]) -> Iterator[str]:
    """Modules of the package that a file imports, anywhere in it; of a folder the file that the name stands in."""
    own = module_of(path).split(".")
    folder = own if path.name == "__init__.py" else own[:-1]
    for node in statements(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level:
            place = [*folder[: len(folder) - node.level + 1], *(node.module.split(".") if node.module else [])]
            for name in node.names:
                within = ".".join([*place, name.name])
                yield within if within in modules else ".".join(place)


UPWARD = {
    ("skisnow.estimation.analysis", "skisnow.estimation.results"),
    ("skisnow.estimation.analysis", "skisnow.report.campaign.summary"),
    ("skisnow.estimation.analysis", "skisnow.report.campaign.page"),
    ("skisnow.report.turn.chain", "skisnow.report.turn.page"),
    ("skisnow.report.turn.chain", "skisnow.report.turn.sentences"),
    ("skisnow.scenario.scenario", "skisnow.scenario.building"),
    ("skisnow.simulation.run", "skisnow.report.run.drawings"),
    ("skisnow.simulation.run", "skisnow.report.run.page"),
    ("skisnow.simulation.run", "skisnow.report.run.file"),
    ("skisnow.simulation.run", "skisnow.simulation.run_forces"),
}
"""Files that a method of a lower file imports when it is called."""


def test_no_circle_of_imports() -> None:
    """The package itself and `python -m` stand above: they fetch names when asked."""
    files = {module_of(path): path for path in (SOURCE / "skisnow").rglob("*.py")}
    above = {"skisnow", "skisnow.__main__"}
    graph = {
        name: set(imported(path, set(files))) - above - {name} for name, path in files.items() if name not in above
    }
    upward = {(name, other) for name, others in graph.items() for other in others if (name, other) in UPWARD}
    assert upward == UPWARD
    graph = {name: others - {other for lower, other in UPWARD if lower == name} for name, others in graph.items()}
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as circle:
        pytest.fail(" <- ".join(circle.args[1]))
