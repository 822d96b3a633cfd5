"""Questions of an import, and answers of the user: options of the command, and the template in campaign.toml."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any, Final, Self

from ..._support.errors import ParameterError
from ..._support.messages import Message
from ..._support.staging import write_file
from ..._support.user_files.text_files import read_toml, toml_text, toml_values
from ..problems import Problem, error
from ..reading.campaign_file import CAMPAIGN_FILE, IMPORT_ANSWERS
from ..reading.headings import plain_heading

SECTION: Final = "import"
NONE: Final = "-"
"""Answer for a table or column that is not imported."""
TEMPLATES: Final = "import-templates"
_NAME: Final = re.compile(r"[^\W_][\w .()-]{0,59}")


@dataclass(frozen=True, slots=True)
class Answers:
    """Answers of the user to questions of an import, by option of the command.

    table: table ("penetration", or "-" for none) by heading row, as SHEET:ROW.
    column, unit: column or "-", and unit, by heading, or by TABLE.HEADING.
    site: site by sheet, or by heading row as SHEET:ROW.
    tool, plate: shape with lengths, such as "ski 200 x 62 mm" and "100 mm", by the name in the table; "" for all rows.
    cells: "decimal" and "thousands": "," or "."; "fill-down": "yes" if a blank name or angle is that of the row above;
        "hidden", "struck": "yes" to import what is hidden or struck through, "no" to leave it out.
    ignore: rows, columns and cells that are not imported, as SHEET!5, SHEET!H or SHEET!H5, each with "yes".
    """

    table: Mapping[str, str] = field(default_factory=dict)
    column: Mapping[str, str] = field(default_factory=dict)
    unit: Mapping[str, str] = field(default_factory=dict)
    site: Mapping[str, str] = field(default_factory=dict)
    tool: Mapping[str, str] = field(default_factory=dict)
    plate: Mapping[str, str] = field(default_factory=dict)
    cells: Mapping[str, str] = field(default_factory=dict)
    ignore: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def of_options(cls, options: Mapping[str, Iterable[str]]) -> Self:
        """Answers from texts such as ``Last=load_N``; tools and plates may have no name, ``ignore`` has no value."""
        return cls(**{kind: dict(_split(kind, text) for text in options.get(kind) or ()) for kind in IMPORT_ANSWERS})

    def with_(self, kind: str, key: str, value: str) -> Self:
        """Copy with one more answer: value of an option `kind` for a key."""
        return replace(self, **{kind: {**getattr(self, kind), key: value}})

    def updated(self, other: Answers) -> Self:
        """Copy with the answers of another object, which override those of this one."""
        names = [entry.name for entry in fields(self)]
        return replace(self, **{name: {**getattr(self, name), **getattr(other, name)} for name in names})

    def of_heading(self, kind: str, table: str, heading: str) -> str:
        """Answer of an option `kind` for TABLE.HEADING, or else for the heading; "" without one."""
        plain = {plain_heading(key): value for key, value in getattr(self, kind).items()}
        return plain.get(plain_heading(f"{table}.{heading}"), plain.get(plain_heading(heading), ""))

    def toml_lines(self) -> list[str]:
        """Lines of the tables ``[import.KIND]`` in campaign.toml, one key per answer; empty without answers."""
        tables = {entry.name: getattr(self, entry.name) for entry in fields(self)}
        return [
            line
            for kind, pairs in tables.items()
            if pairs
            for line in ("", f"[{SECTION}.{kind}]", *(f"{toml_text(key)} = {toml_text(pairs[key])}" for key in pairs))
        ]


def _split(kind: str, text: str) -> tuple[str, str]:
    """Key and value of an option such as "name=value"; the value is "yes" for `ignore`; rejects a missing "="."""
    key, equals, value = text.rpartition("=")
    if kind == "ignore":
        return text, "yes"
    if not equals and kind not in {"tool", "plate"}:
        raise ParameterError("--{option} {text}: write a name, an equals sign and a value.").tag(
            "no_pair", option=kind, text=text
        )
    return key.strip(), value.strip()


def read_template(place: str | Path, *, named: Path | None = None) -> Answers:
    """Read the answers of an earlier import.

    place: name of a saved template, folder of a campaign, or a campaign.toml.
    named: folder of the saved templates (default: the user's own).
    Raises ParameterError: no such template or campaign; the file has no ``[import]``, or an answer is not a text.
    """
    saved = saved_templates(named)
    path = Path(place) / CAMPAIGN_FILE if Path(place).is_dir() else saved.get(str(place), Path(place))
    if not path.exists():
        raise ParameterError("{name} is neither a saved template nor a campaign. Saved: {saved}.").tag(
            "no_template", name=str(place), saved=list(saved) or Message("none")
        )
    return _template_answers(read_toml(path), str(path))


def saved_templates(folder: Path | None = None) -> dict[str, Path]:
    """Files of the saved templates by name, in a folder or the user's own."""
    return {path.stem: path for path in sorted(_templates_folder(folder).glob("*.toml"))}


def _templates_folder(folder: Path | None) -> Path:
    """Folder of import templates: the given one, or for None that in the user's data folder."""
    from platformdirs import user_data_path

    return folder or user_data_path("skisnow") / TEMPLATES


def save_template(name: str, campaign: bytes, *, folder: Path | None = None) -> Path:
    """Save the answers of an import as a template under a name; returns the path of its file.

    name: letters, digits, spaces and ``-_.()``; its first character is a letter or digit.
    campaign: contents of the campaign.toml of the import.
    folder: folder of the saved templates (default: the user's own).
    Raises ParameterError: another name is needed, also because a template with other answers has it.
    """
    if not _NAME.fullmatch(name):
        raise ParameterError(
            "{name!r} is not a name of a template. Allowed: up to 60 letters, digits, spaces and -_.(), beginning with "
            "a letter or digit."
        ).tag("bad_name", name=name)
    text = "\n".join(parse_template(campaign.decode(), name).toml_lines()).lstrip() + "\n"
    path = _templates_folder(folder) / f"{name}.toml"
    if path.exists() and path.read_text(encoding="utf-8") != text:
        raise ParameterError("A template {name} with other answers exists. Take another name, or remove {file}.").tag(
            "name_in_use", name=name, file=path
        )
    path.parent.mkdir(parents=True, exist_ok=True)
    write_file(path, text)
    return path


def parse_template(text: str, name: str) -> Answers:
    """Answers of an import from the text of a campaign.toml; `name`: name in messages; errors as `read_template`."""
    return _template_answers(toml_values(text.replace("\r\n", "\n")), name)


def _template_answers(values: Mapping[str, Any], name: str) -> Answers:
    """Answers in the section [import] of a campaign.toml; rejects a file without them or with other types."""
    section = values.get(SECTION)
    answers = {kind: section.get(kind, {}) for kind in IMPORT_ANSWERS} if isinstance(section, Mapping) else {}
    texts = all(
        isinstance(pairs, Mapping) and all(isinstance(value, str) for value in pairs.values())
        for pairs in answers.values()
    )
    if not answers or not texts:
        raise ParameterError("{file} has no [import] with texts. Choose a campaign that skisnow import wrote.").tag(
            "no_template", file=name
        )
    return Answers(**answers)


@dataclass(frozen=True, slots=True)
class Question:
    """A question of an import that no heading, row of units or note of the file answers.

    option, key: option of the command, and the name before its equals sign.
    choices: possible answers; () for any text.
    proposed: answer that skisnow infers, or "".
    problem: error if it is not answered.
    """

    option: str
    key: str
    choices: tuple[str, ...]
    proposed: str
    problem: Problem


WORDS = {
    "table": Message("a stated table"),
    "column": Message("a stated column"),
    "unit": Message("a stated unit"),
    "site": Message("a stated site"),
    "tool": Message("a stated tool with its lengths and their unit"),
    "plate": Message("a stated length of the blade with its unit"),
    "decimal": Message("numbers with one decimal mark"),
    "thousands": Message("numbers without thousands separators"),
    "fill-down": Message("a name and an angle in each row"),
    "hidden": Message("visible rows, columns and sheets"),
    "struck": Message("rows without cells that are struck through"),
    "ignore": Message("rows and notes without a doubt"),
}
"""Required statement of each option, or of each key of --cells."""
IMPORT_OR_NOT: Final = {"yes": Message("yes (import it)"), "no": Message("no (leave it out)")}


@dataclass(slots=True)
class Dialogue:
    """State of an import: answers of the user, and the open questions and errors so far."""

    answers: Answers
    open: list[Question | Problem] = field(default_factory=list)

    def ask(
        self,
        option: str,
        key: str,
        place: str,
        *,
        value: str | None = None,
        choices: tuple[str, ...] = (),
        proposed: str = "",
        row: int | None = None,
    ) -> None:
        """Add a question about a key of an option, with the error for a missing answer at place, row and value."""
        answer = key if option == "ignore" else f"{key}={proposed or 'ANSWER'}" if key else proposed or "ANSWER"
        text = f'--{option} "{answer}"'
        words = [IMPORT_OR_NOT.get(choice, choice) if key in {"hidden", "struck"} else choice for choice in choices]
        action = Message("State it in the file or by {option}.", option=text)
        if choices:
            action = Message("State it in the file or by {option}. Choices: {choices}.", option=text, choices=words)
        allowed = WORDS[key if option == "cells" else option]
        problem = error("not_stated", place, row=row, column=key or None, value=value, allowed=allowed, action=action)
        self.open.append(Question(option, key, choices, proposed, problem))

    def refuse(self, code: str, place: str, **further: Any) -> None:
        """Add an error at a sheet or table; parameters as of `problems.error`."""
        self.open.append(error(code, place, **further))

    def has_asked(self, option: str, key: str) -> bool:
        """True if one of the questions has this option and key."""
        return any(isinstance(item, Question) and (item.option, item.key) == (option, key) for item in self.open)
