"""Translations: extraction of the templates from the sources, files for translators, compiled files for gettext.

``python build_backend/messages.py update`` adds new templates to the files of translators and removes unused ones;
``compile`` writes the files that skisnow reads. Both use Babel.
"""

from __future__ import annotations

import ast
import re
import sys
import tempfile
import tomllib
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from string import Formatter
from typing import Any

SOURCES = Path(__file__).resolve().parents[1] / "src" / "skisnow"
FOLDER = SOURCES / "_support" / "translations"


def python_calls(
    source: Any,
    keywords: Any,
    _tags: Any,
    options: Any,  # noqa: ARG001 -- as Babel calls it
) -> Iterator[tuple[int, str, list[str | None], list[str]]]:
    """Literals among the first three arguments of each call of a keyword, also of a nested one."""
    for node in ast.walk(ast.parse(source.read())):
        name = node.func.id if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) else ""
        if isinstance(node, ast.Call) and name in keywords:
            literals = [ast.literal_eval(arg) if isinstance(arg, ast.Constant) else None for arg in node.args[:3]]
            yield node.lineno, name, literals, []


def sources_of_skis(
    file: Any,
    keywords: Any,
    _tags: Any,
    options: Any,  # noqa: ARG001 -- as Babel calls it
) -> Iterator[tuple[int, str, str, list[str]]]:
    """Origin of the numbers of a ski of the catalogue."""
    if source := tomllib.load(file).get("source"):
        yield 1, next(iter(keywords)), source, []


ERRORS = ("Content", "Parameter", "Fit", "Solver", "Store", "Overtaken", "Output", "Skisnow")
WARNINGS = ("Range", "ModelLimit", "Fit")
CLASSES = {**{f"{name}Error": None for name in ERRORS}, **{f"{name}Warning": None for name in WARNINGS}}
COUNTED = {"count_message": (1, 2), "counted": (2, 3)}
KEYWORDS: dict[str, tuple[Any, dict[str, Any]]] = {
    "**.py": (python_calls, {"Message": None, "template": None, "prose": None, **COUNTED, **CLASSES}),
    # {% trans %} is one of the calls
    "**.html": ("jinja2.ext:babel_extract", {"gettext": None, "said": None, "ngettext": (1, 2), "prose": None}),
    "**.js": ("javascript", {"said": None}),
    "catalogue/*.toml": (sources_of_skis, {"template": None}),
}
WITH_KEYS = ("carving", "scenario", "snow", "track")
"""Packages whose calls of Quantity and Word have as second argument the meaning of a key, which pages show."""
OPTIONS = {"**.html": {"newstyle_gettext": "true", "trimmed": "true"}}
HEAD = """msgid ""
msgstr ""
"Language: {language}\\n"
"Content-Type: text/plain; charset=utf-8\\n"
"Plural-Forms: {plurals}\\n"

"""
COLUMNS = 120
BEFORE_ALL = datetime(2000, 1, 1, tzinfo=UTC)
Template = str | tuple[str, ...]


def languages() -> list[str]:
    """Codes of the languages with a folder of translations."""
    return sorted(path.name for path in FOLDER.iterdir() if path.is_dir())


def packages() -> list[str]:
    """Packages of skisnow; each has its own file in each language."""
    return sorted(path.parent.name for path in SOURCES.glob("*/__init__.py"))


def extract(package: str) -> list[Template]:
    """Templates of a package in the order of its files; a pair has a singular and a plural."""
    from babel.messages.extract import extract_from_dir

    templates: dict[Template, None] = {}
    for pattern, (method, keywords) in KEYWORDS.items():
        every = keywords | (dict.fromkeys(("Quantity", "Word"), (2,)) if package in WITH_KEYS else {})
        calls = extract_from_dir(SOURCES / package, [(pattern, method)], OPTIONS, every)
        templates.update((message, None) for _, _, message, _, _ in sorted(calls, key=lambda call: call[:2]))
    return [template for template in templates if _has_words(template)]


def unread_templates(source: str | bytes) -> list[int]:
    """Lines whose template is composed, such as f"{size} m" or "a" if alone else "b": no extraction finds its text.

    Texts that become fields of a message are typed as `Message`, so that mypy rejects plain ones.
    """
    composed = (ast.JoinedStr, ast.IfExp, ast.BoolOp, ast.BinOp)
    return [
        node.lineno
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in KEYWORDS["**.py"][1]
        for argument in node.args[:3]
        if isinstance(argument, composed) and any(map(_is_text, ast.iter_child_nodes(argument)))
    ]


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))


def _has_words(template: Template) -> bool:
    """False for templates such as "{place}: {problem}", which need no translation."""
    literals = (literal for text in _texts(template) for literal, *_ in Formatter().parse(text))
    return any(letter.isalnum() for literal in literals for letter in literal)


def read(language: str, package: str) -> Any:
    """Catalog of a package in a language; empty if it has no file."""
    from babel.messages.catalog import Catalog
    from babel.messages.pofile import read_po

    path = FOLDER / language / f"{package}.po"
    if not path.exists():
        return Catalog(locale=language)
    with path.open("rb") as file:
        return read_po(file, locale=language, abort_invalid=True)


def update(language: str, package: str) -> None:
    """Write the file of a package again: its templates in the order of the sources, with their translations so far."""
    from babel.messages.catalog import Catalog
    from babel.messages.pofile import write_po

    known, templates = read(language, package), extract(package)
    path = FOLDER / language / f"{package}.po"
    if not templates:
        path.unlink(missing_ok=True)
        return
    catalog = Catalog(locale=language)
    for template in templates:
        before = known.get(template if isinstance(template, str) else template[0])
        catalog.add(template, before.string if before else "", flags=(before.flags & {"fuzzy"}) if before else ())
    with path.open("wb") as file:
        file.write(HEAD.format(language=language, plurals=catalog.plural_forms).encode())
        write_po(file, catalog, width=COLUMNS, omit_header=True, no_location=True)


def faults(language: str) -> list[str]:
    """Templates without translation, unused translations, and those with other fields or different in two files."""
    found: list[str] = []
    seen: dict[Template, list[str]] = {}
    for package in packages():
        catalog, templates = read(language, package), extract(package)
        used = {template if isinstance(template, str) else template[0] for template in templates}
        found += [f"{package}: unused: {entry.id!r}" for entry in catalog if entry.id and _id(entry) not in used]
        for template in templates:
            entry = catalog.get(template if isinstance(template, str) else template[0])
            texts = _texts(entry.string) if entry else []
            if not texts or not all(texts) or entry.fuzzy:
                found.append(f"{package}: not translated: {template!r}")
            elif any(_fields(text) - {"count"} != _fields(entry_id) - {"count"}
                     for text in texts for entry_id in _texts(template)):  # fmt: skip
                found.append(f"{package}: other fields: {template!r}")
            elif seen.setdefault(template, texts) != texts:
                found.append(f"{package}: translated in two ways: {template!r}")
    return found


def _id(entry: Any) -> str:
    return _texts(entry.id)[0]


def _texts(text: Any) -> list[str]:
    return [text] if isinstance(text, str) else list(text)


def _fields(text: str) -> set[str]:
    names = [name for _, name, _, _ in Formatter().parse(text) if name is not None]
    return {name or str(number) for number, name in enumerate(names)} | set(re.findall(r"%\((\w+)\)s", text))


def compile_language(language: str) -> None:
    """Write the compiled file of a language from its files of all packages."""
    from babel.messages.catalog import Catalog
    from babel.messages.mofile import write_mo

    catalog = Catalog(locale=language, creation_date=BEFORE_ALL, revision_date=BEFORE_ALL)  # the same bytes each time
    for package in packages():
        for entry in read(language, package):
            if entry.id and not entry.fuzzy:
                catalog.add(entry.id, entry.string)
    with tempfile.NamedTemporaryFile(dir=FOLDER, delete=False) as file:  # tests may compile it at the same time
        write_mo(file, catalog)
    Path(file.name).chmod(0o644)
    Path(file.name).replace(FOLDER / f"{language}.mo")


def compile_changed() -> None:
    """Compile each language whose compiled file is older than its translations."""
    for language in languages():
        compiled = FOLDER / f"{language}.mo"
        newest = max(path.stat().st_mtime_ns for path in (FOLDER / language).glob("*.po"))
        if not compiled.exists() or compiled.stat().st_mtime_ns < newest:
            compile_language(language)


if __name__ == "__main__":
    if sys.argv[1] == "update":
        for code in languages():
            for name in sys.argv[2:] or packages():
                update(code, name)
    compile_changed()
