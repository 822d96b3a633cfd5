"""Readings that the browser kept while the server was unreachable: each is stored once."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Final

from nicegui import ui

from ..._support.errors import ParameterError, StoreError
from ...campaign.reading.table_forms import BRANCH
from ...campaign.store import NewEntry
from ...campaign.store.stored_tables import FORMS, checked_cell
from ..language import number_said, said, said_template
from ..page_requests import LONGEST
from .readings import problem_said

if TYPE_CHECKING:
    from collections.abc import Callable

    from nicegui.events import GenericEventArguments

    from ..edit_session import EditSession

FILE: Final = "penetration.csv"
HEAD: Final = ("experiment", "site", "spot", "tool", "edge_angle_deg")
"""What a series has once."""
READING: Final = ("load_N", "depth_mm", BRANCH)
MOST: Final = 10_000


def take_resent(session: EditSession, changed: Callable[[set[str]], object]) -> None:
    """Let the page take readings that were typed before it was loaded.

    Parameters
    ----------
    session
        The campaign.
    changed
        Called with the names of the series that have a reading more.
    """
    client = ui.context.client

    def take(event: GenericEventArguments) -> None:
        given = event.args if isinstance(event.args, list) else []
        answers, series = [], set[str]()
        for record in given[:MOST]:
            once, refusal = _once(record), ""
            try:
                series.add(_stored(session, record, once))
            except (StoreError, ParameterError) as error:
                refusal = said_template("Not stored: {}: {}", _words_said(record), problem_said(error))
            answers.append((once, refusal))
        changed(series)
        client.run_javascript(f"lab.resent({json.dumps(answers)})")

    ui.on("resent", take)


def _once(record: Any) -> str:
    once = record.get("once") if isinstance(record, dict) else None
    return once if isinstance(once, str) and 0 < len(once) <= LONGEST else ""


def _cells(record: Any) -> dict[str, str]:
    said = record.get("cells") if isinstance(record, dict) else None
    if not isinstance(said, dict):
        return {}
    cells = {column: str(said.get(column) or "") for column in (*HEAD, *READING)}
    return cells if cells[BRANCH] else {column: text for column, text in cells.items() if column != BRANCH}


def _words_said(record: Any) -> str:
    cells = _cells(record)
    if not cells:
        return said("a reading")
    return said_template(
        "{} mm under {} N in series {}", cells["depth_mm"], number_said(cells["load_N"]), cells["experiment"]
    )


def _stored(session: EditSession, record: Any, once: str) -> str:
    """Store a reading; gives the name of its series."""
    said = _cells(record)
    if not once or not said:
        raise ParameterError("this is no reading")
    cells = {column: checked_cell(FORMS[FILE], column, text) for column, text in said.items()}
    if cells["tool"] not in session.described.tools:
        raise ParameterError(f"the campaign has no tool {cells['tool']!r}")
    test = session.test(FILE, cells["experiment"])
    there = test.row_under(cells["load_N"], cells.get(BRANCH, ""))
    if there is not None and there.entered.once != once:
        raise ParameterError(f"a reading of {there.cells['depth_mm']} mm is there already")
    if test.rows and test.rows[0].cells["site"] != cells["site"]:
        raise ParameterError(f"that series is at the site {test.rows[0].cells['site']}")
    who = str(record.get("who") or "")[:LONGEST]
    place = test.next_position
    entry = NewEntry(action="add", file=FILE, test=test.name, cells=cells, position=place, who=who, once=once)
    session.write_down(entry, seen=test.last)
    return test.name
