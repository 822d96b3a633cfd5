"""Campaign folder of an import: tools, tables, campaign.toml with the template, original bytes, and the undo."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import Final, Literal

from ..._support.errors import OutputError
from ..._support.messages import Message
from ..._support.staging import prepare_folder, staged, write_file
from ..._support.user_files.json_text import own_json
from ..._support.user_files.text_files import toml_text
from ..reading.campaign_file import CAMPAIGN_FILE
from .answers import SECTION, Answers, Dialogue
from .columns import PLATE, TOOL, Note, gauge_steps_mm, length_mm, stated_observers, stated_plates, stated_tools
from .rows import ImportedTable

ORIGINAL: Final = "original"
RECORD: Final = f"{ORIGINAL}/import.json"


def description(
    name: str,
    data: bytes,
    template: Answers,
    tools: Iterable[ToolText],
    plates: Iterable[ToolText],
    notes: Sequence[Note],
) -> str:
    """Text of campaign.toml for an imported file (name and bytes), with the answers as a template for later imports."""
    title, gauges = PurePath(name).stem, gauge_steps_mm(notes)
    lines = [f"name = {toml_text(title)}", f"observers = {toml_text(stated_observers(notes))}"]
    lines += [f"gauge_resolution_mm = {step:g}" for step in gauges if len(gauges) == 1]
    for kind, described in (("tool", tools), ("plate", plates)):
        for entry in dict.fromkeys(described):
            keys = (f"{key} = {value}" for key, value in entry.keys)
            lines += ["", f"[[{kind}]]", f"name = {toml_text(entry.name)}", *keys]
    lines += ["", f"[{SECTION}]", f"template = {toml_text(title)}"]
    lines += [f"file = {toml_text(f'{ORIGINAL}/{PurePath(name).name}')}"]
    lines += [f'sha256 = "{hashlib.sha256(data).hexdigest()}"']
    texts = [f"{note.sheet}, {note.row}: {note.text}" for note in notes]
    return "\n".join((*lines, f"notes = {toml_text(texts)}", *template.toml_lines(), ""))


def campaign_files(tables: Mapping[str, str], described: str, name: str, data: bytes) -> dict[str, bytes]:
    """Files of the new campaign by path: tables, campaign.toml (`described`), the imported file, and their hashes."""
    texts = {CAMPAIGN_FILE: described, **tables}
    files = {path: text.encode() for path, text in texts.items()} | {f"{ORIGINAL}/{PurePath(name).name}": data}
    hashes = {path: hashlib.sha256(content).hexdigest() for path, content in files.items()}
    return files | {RECORD: json.dumps(hashes, ensure_ascii=False, indent=1).encode()}


def write_import(files: Mapping[str, bytes], folder: str | Path) -> None:
    """Write the files of a proposal to a new or empty folder.

    Raises OutputError: the folder has files already, or cannot be written; nothing is written then.
    """
    folder = Path(folder)
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise OutputError("{folder} is not an empty folder; nothing was written. Choose another one.").tag(
            "not_empty", folder=folder
        )
    prepare_folder(folder)
    with staged(folder, last=CAMPAIGN_FILE) as stage:
        for path, content in files.items():
            (stage.path / path).parent.mkdir(parents=True, exist_ok=True)
            write_file(stage.path / path, content)


def undo_import(folder: str | Path) -> list[str]:
    """Remove the files that an import wrote; returns their paths.

    Raises OutputError: the folder has no record of an import, or a file was changed since; nothing is removed then.
    """
    folder = Path(folder)
    try:
        hashes = own_json((folder / RECORD).read_bytes())
        inside = folder.resolve()
        if not isinstance(hashes, dict) or not all((folder / path).resolve().is_relative_to(inside) for path in hashes):
            raise ValueError(RECORD)
        changed = [path for path, digest in hashes.items() if _sha256(folder / path) != digest]
    except (OSError, ValueError) as failure:
        raise OutputError("{folder} has no {record}; nothing was removed.").tag(
            "no_import", folder=folder, record=RECORD
        ) from failure
    if changed:
        raise OutputError(
            "Changed since the import: {files}. Nothing was removed. Keep these files, and delete the folder."
        ).tag("changed_since", files=changed)
    removed = [*hashes, RECORD]
    for path in removed:
        (folder / path).unlink(missing_ok=True)
    for place in (folder / ORIGINAL, folder):
        if not any(place.iterdir()):
            place.rmdir()
    return removed


def _sha256(path: Path) -> str:
    """SHA-256 of a file in hexadecimal; "" if it does not exist."""
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.exists() else ""


TOOL_FORM: Final = "ski 200 x 62 mm"
PLATE_FORM: Final = "100 mm"
_CYLINDER: Final = re.compile(
    r"cylinder\s+r?\s*(\d+(?:[.,]\d+)?)\s*[x×]\s*(\d+(?:[.,]\d+)?)\s*(mm|cm|m)", re.IGNORECASE
)


@dataclass(frozen=True, slots=True)
class ToolText:
    """A tool or blade for campaign.toml: its name, and its other keys with their values as TOML."""

    name: str
    keys: tuple[tuple[str, str], ...]


def parse_tool(name: str, text: str) -> ToolText | None:
    """Tool from its shape and lengths as text, named `name` or else by the text; None if the text is not a tool.

    >>> parse_tool("", "ski 20 x 6,2 cm").keys
    (('shape', '"ski"'), ('length_mm', '200'), ('width_mm', '62'))
    """
    plain = text.strip()
    if match := TOOL.fullmatch(plain):
        return _tool_text(
            name or plain, "ski", length_mm=(match[2], match[3] or match[5]), width_mm=(match[4], match[5])
        )
    if match := re.fullmatch(r"disc\s+(\d+(?:[.,]\d+)?)\s*(mm|cm|m)", plain):
        return _tool_text(name or plain, "disc", diameter_mm=(match[1], match[2]))
    if match := _CYLINDER.fullmatch(plain):
        return _tool_text(name or plain, "cylinder", radius_mm=(match[1], match[3]), width_mm=(match[2], match[3]))
    return None


def _tool_text(name: str, shape: str, **lengths: tuple[str, str]) -> ToolText:
    """Tool of a shape from its lengths, each as a number and its unit."""
    texts = ((key, f"{length_mm(*length):g}") for key, length in lengths.items())
    return ToolText(name, (("shape", f'"{shape}"'), *texts))


def parse_plate(name: str, text: str) -> ToolText | None:
    """Blade from its length as text, such as "100 mm", named `name` or else by the text; None if it is not a length."""
    match = PLATE.fullmatch(text.strip())
    return ToolText(name or text.strip(), (("length_mm", f"{length_mm(match[2], match[3]):g}"),)) if match else None


_READING: Final = {"tool": (stated_tools, parse_tool, TOOL_FORM), "plate": (stated_plates, parse_plate, PLATE_FORM)}
"""Functions that find and parse the texts of tools and blades, and an example of such a text."""


def described_tools(
    kind: Literal["tool", "plate"], tables: Sequence[ImportedTable], dialogue: Dialogue, notes: Sequence[Note]
) -> dict[tuple[str, str], ToolText]:
    """Tools or blades by sheet and name in the table ("" without one); the dialogue asks about unclear ones."""
    stated_in, parse, form = _READING[kind]
    answers: Mapping[str, str] = getattr(dialogue.answers, kind)
    with_tables = {table.section.sheet.name for table in tables}
    described: dict[tuple[str, str], ToolText] = {}
    for table in tables:
        if kind not in table.form.names:
            continue
        sheet = table.section.sheet.name
        stated = stated_in([note for note in notes if note.sheet == sheet or note.sheet not in with_tables])
        for name in dict.fromkeys(row.cells.get(kind, "") for row in table.rows) or [""]:
            if (sheet, name) in described:
                continue
            texts = ({answers[name]} if name in answers else set()) | (set() if name else stated)
            tools = {parse(name, text) for text in texts}
            if len(tools) == 1 and (tool := tools.pop()) is not None:
                described[sheet, name] = tool
            elif name in answers and parse(name, answers[name]) is None:
                allowed = Message("lengths with a unit, such as {form}", form=form)
                answer = {"column": kind, "value": answers[name]}
                action = Message("Correct --{option}.", option=kind)
                dialogue.refuse("bad_answer", table.section.key, **answer, allowed=allowed, action=action)
            elif not dialogue.has_asked(kind, name):
                value = ", ".join(sorted(filter(None, texts))) or name or None
                dialogue.ask(kind, name, table.section.key, value=value, proposed=form)
    return described
