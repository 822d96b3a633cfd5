"""Campaign folder of an import: tables, campaign.toml with the template, original bytes, and the undo."""

from __future__ import annotations

import csv
import hashlib
import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Final

from ..._support.errors import OutputError
from ..._support.messages import Message
from ..._support.staging import staged, tidied, write_file
from ..reading.campaign_file import CAMPAIGN_FILE
from .answers import SECTION

if TYPE_CHECKING:
    from ..reading.table_forms import TableForm
    from .answers import Answers
    from .tools import ToolText

ORIGINAL: Final = "original"
RECORD: Final = f"{ORIGINAL}/import.json"


def csv_text(form: TableForm, rows: Sequence[Mapping[str, str]]) -> str:
    """CSV of rows with the columns that they have, those of the form first."""
    present = {name for row in rows for name in row}
    columns = [*(name for name in form.known if name in present), *sorted(present - set(form.known))]
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([row.get(column, "") for column in columns] for row in rows)
    return stream.getvalue()


def description(
    title: str,
    *,
    file: str,
    sha256: str,
    template: Answers,
    tools: Sequence[ToolText],
    plates: Sequence[ToolText],
    gauges: set[float],
    observers: Sequence[str],
    notes: Sequence[str],
) -> str:
    """Text of campaign.toml; the step of the gauge only if the notes agree."""
    lines = [f"name = {_quoted(title)}", f"observers = {_list(observers)}"]
    lines += [f"gauge_resolution_mm = {step:g}" for step in gauges if len(gauges) == 1]
    for kind, described in (("tool", tools), ("plate", plates)):
        for each in described:
            keys = (f"{key} = {value}" for key, value in each.keys)
            lines += ["", f"[[{kind}]]", f"name = {_quoted(each.name)}", *keys]
    lines += [
        "",
        f"[{SECTION}]",
        f"template = {_quoted(title)}",
        f"file = {_quoted(f'{ORIGINAL}/{PurePath(file).name}')}",
    ]
    lines += [f'sha256 = "{sha256}"', f"notes = {_list(notes)}", *template.toml_lines()]
    return "\n".join((*lines, ""))


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _list(texts: Sequence[str]) -> str:
    return f"[{', '.join(map(_quoted, texts))}]"


def campaign_files(tables: Mapping[str, str], described: str, name: str, data: bytes) -> dict[str, bytes]:
    """Contents of the folder by path, with a record of their hashes for the undo."""
    texts = {CAMPAIGN_FILE: described, **tables}
    files = {path: text.encode() for path, text in texts.items()} | {f"{ORIGINAL}/{PurePath(name).name}": data}
    hashes = {path: hashlib.sha256(content).hexdigest() for path, content in files.items()}
    return files | {RECORD: json.dumps(hashes, ensure_ascii=False, indent=1).encode()}


def write_import(files: Mapping[str, bytes], folder: str | Path) -> None:
    """Write the files of a proposal to a new or empty folder.

    Raises
    ------
    OutputError
        The folder has files already, or cannot be written; nothing is written then.
    """
    folder = Path(folder)
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise OutputError(
            Message("{folder} is not an empty folder; nothing was written. Choose another one.", folder=folder),
            code="not_empty",
        )
    tidied(folder)
    with staged(folder, last=CAMPAIGN_FILE) as stage:
        for path, content in files.items():
            (stage.path / path).parent.mkdir(parents=True, exist_ok=True)
            write_file(stage.path / path, content)


def undo_import(folder: str | Path) -> list[str]:
    """Remove the files that an import wrote; returns their paths.

    Raises
    ------
    OutputError
        The folder has no record of an import, or a file was changed since; nothing is removed then.
    """
    folder = Path(folder)
    try:
        hashes = json.loads((folder / RECORD).read_text(encoding="utf-8"))
        if not isinstance(hashes, dict) or not all(_is_inside(folder, path) for path in hashes):
            raise ValueError(RECORD)
        changed = [path for path, digest in hashes.items() if _sha256(folder / path) != digest]
    except (OSError, ValueError) as failure:
        raise OutputError(
            Message("{folder} has no {record}; nothing was removed.", folder=folder, record=RECORD), code="no_import"
        ) from failure
    if changed:
        raise OutputError(
            Message(
                "Changed since the import: {files}. Nothing was removed. Keep these files, and delete the folder.",
                files=changed,
            ),
            code="changed_since",
        )
    removed = [*hashes, RECORD]
    for path in removed:
        (folder / path).unlink(missing_ok=True)
    for place in (folder / ORIGINAL, folder):
        if not any(place.iterdir()):
            place.rmdir()
    return removed


def _is_inside(folder: Path, path: str) -> bool:
    return (folder / path).resolve().is_relative_to(folder.resolve())


def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.exists() else ""
