"""List what skisnow offers, to compare before and after a large change: python -m tests.inventory > FILE.

One line each: commands and options, keys of files and results (from the schemas), laws, formats, built-in names,
texts of the lab's controls, public Python names.
"""

import argparse
import ast
import importlib
import pkgutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

import skisnow

PACKAGE = Path(skisnow.__file__).resolve().parent
CONTROLS = {
    "button", "input", "number", "select", "checkbox", "switch", "radio", "toggle", "upload", "textarea", "tab",
    "heading", "link", "plain_page", "choice", "framed", "asking_button", "field",
}  # fmt: skip


def commands(parser: argparse.ArgumentParser, name: str = "") -> Iterator[str]:
    """Commands with their options and choices."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for command, part in action.choices.items():
                yield f"command {name} {command}".replace("  ", " ")
                yield from commands(part, f"{name} {command}".strip())
        else:
            choices = f" {{{','.join(map(str, action.choices))}}}" if action.choices else ""
            yield f"option {name}: {'/'.join(action.option_strings) or action.dest}{choices}"


def schema_keys(schema: Any, path: str = "") -> Iterator[str]:
    """Dotted keys of all objects in a JSON schema."""
    if isinstance(schema, dict):
        for key, part in schema.get("properties", {}).items():
            yield f"{path}.{key}".strip(".")
            yield from schema_keys(part, f"{path}.{key}".strip("."))
        for word, part in schema.items():
            if word != "properties":
                yield from schema_keys(part, path)
    elif isinstance(schema, list):
        for part in schema:
            yield from schema_keys(part, path)


def controls() -> Iterator[str]:
    """First texts of the calls in `web` that make a control."""
    for path in (PACKAGE / "web").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute | ast.Name):
                continue
            name = node.func.attr if isinstance(node.func, ast.Attribute) else node.func.id
            texts = [part.value for part in node.args if isinstance(part, ast.Constant) and isinstance(part.value, str)]
            if name in CONTROLS and texts:
                yield f"control {name}: {texts[0]}"


def public_names() -> Iterator[str]:
    """Names in `__all__` of the package and of each of its packages."""
    yield from (f"name skisnow.{name}" for name in skisnow.__all__)
    for module in pkgutil.iter_modules(skisnow.__path__):
        loaded = importlib.import_module(f"skisnow.{module.name}") if module.ispkg else None
        yield from (f"name skisnow.{module.name}.{name}" for name in getattr(loaded, "__all__", ()))


def laws_and_formats() -> Iterator[str]:
    """Force laws, formats of tracks, built-in skis, snows, scenarios and courses."""
    from skisnow.forces import friction, penetration, shear
    from skisnow.track.read import TrackFormat

    for kind, package in (("friction", friction), ("penetration", penetration), ("shear", shear)):
        yield from (f"law {kind}: {law.__name__}" for law in package.LAWS)
    yield from (f"track format {name}" for name in get_args(TrackFormat))
    for kind in ("ski_names", "snow_names", "scenario_names", "course_names"):
        yield from (f"{kind}: {name}" for name in getattr(skisnow, kind)())


def schemas() -> Iterator[str]:
    """Keys of every schema, with the file's name."""
    from skisnow.cli.shell import NAMES, json_schema

    for name in NAMES:
        yield from (f"key {name}.schema.json: {key}" for key in schema_keys(json_schema(name)))


def main() -> None:
    """Print all lines, sorted, each once."""
    from skisnow.cli import build_parser

    lines = {*commands(build_parser()), *schemas(), *controls(), *public_names(), *laws_and_formats()}
    print("\n".join(sorted(lines)))


if __name__ == "__main__":
    main()
