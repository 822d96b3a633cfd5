"""Page with the lists of entered and imported campaigns; import and export."""

from __future__ import annotations

import json
from functools import partial
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from nicegui import run, ui

from ..._support.errors import StoreError
from ..._support.messages import Message, template
from ...campaign import write_reference
from ...campaign.importing.folder import RECORD
from ...campaign.store import Journals, StoredCampaign
from ...replay.page import STYLE, page_words
from ...report.formatting import counted
from ..edit_session import EditSession
from ..elements import Words, button, heading, link, named, page_frame, sentence
from ..page_requests import analysis, correction_address, entry_address, export, file_input, submit_button, upload_form
from ..replay_addresses import FILES, FIRST_SCRIPT
from ..replay_addresses import LIST as REPLAYS
from ..settings import Lab
from ..transfer import IMPORT
from ..words import TABLES, language_of, minute_words, said

PATH: Final = "/"
TITLE: Final = Message("Campaigns")
WHAT_THIS_IS: Final = Message(
    "skisnow turns measurements on a slope into snow hardness and shear stress, and these into turns of a ski: enter "
    "tests, analyse them, carve and simulate."
)
SAMPLE_SEED: Final = 1
CARDS: Final = (
    (Message("Enter tests"), Message("From plate tests on a slope to snow hardness and shear stress."), "/describe"),
    (Message("Try a ski"), Message("Depth, radius and grip of a carving ski on your snow."), "/carve"),
    (Message("Simulate a turn"), Message("A sledge or a skier down a slope, as a replay."), "/simulate"),
)
"""Title, explanation and address of each way to begin."""


def add_page(lab: Lab) -> None:
    """Add the page that lists the campaigns of the lab and imports further ones."""

    @ui.page(PATH)
    def campaigns(added: str = "") -> None:
        with page_frame(Message("Campaigns"), here=PATH):
            if added:
                sentence(Message("The campaign is imported."), "good").props("role=status")
                if added in {campaign.id for campaign in lab.store.list()}:
                    with ui.element("div").classes("acts"):
                        link(Message("Analysis of this campaign"), analysis("kept", added), "main")
            _add_introduction()
            is_first = not Journals(lab.store).list() and not lab.store.list()
            if is_first:
                sentence(WHAT_THIS_IS)
            with ui.element("div").classes("acts"):
                link(Message("New campaign"), "/describe", "main")
                if is_first:
                    button(Message("Look at a sample campaign"), lambda: _add_sample(lab), once=True)
            _list_drafts(lab)
            _list_imported(lab)
            _import_form(lab)


def _add_introduction() -> None:
    """Replay of a skier, and the three ways to begin."""
    words = escape(json.dumps(page_words(language_of()), ensure_ascii=False))
    ui.add_head_html(
        f'<link rel="stylesheet" href="{FILES}/{STYLE}"><script src="{FIRST_SCRIPT}" data-words="{words}"></script>'
    )
    with ui.element("div").classes("first"):
        with ui.element("div").classes("cards"):
            for title, about, address in CARDS:
                with ui.element("a").props(f'href="{address}"').classes("way"):
                    Words(title).classes("way-title")
                    Words(about).classes("quiet")
        named(ui.element("div").props("id=first-replay role=figure"), Message("A simulated skier through gates"))


def _list_drafts(lab: Lab) -> None:
    """List the campaigns in entry, newest first, as cards with links; a damaged one shows its error."""
    heads = Journals(lab.store).list()
    heading(Message("Drafts"))
    if not heads:
        sentence(Message("None. Begin one with New campaign."), "quiet")
    for head in reversed(heads):
        try:
            session = EditSession(lab, head.id)
        except StoreError as error:  # the campaign is damaged
            with ui.element("section").classes("card"):
                heading(head.id, 3)
                sentence(error.message, "bad")
            continue
        tests = [test for test in session.campaign.tests.values() if test.rows and test.file in TABLES]
        with ui.element("section").classes("card"):
            heading(session.described.name or Message("(no name)"), 3)
            words = [
                session.described.place,
                counted(len(tests), "{count} test", "{count} tests"),
                Message("last entry {minute_words}", minute_words=minute_words(head.last_at)),
            ]
            sentence(" · ".join(said(text) for text in words if text), "quiet")
            with ui.element("div").classes("acts"):
                link(Message("Enter tests"), entry_address(head.id), "main")
                link(Message("Analysis"), analysis("entry", head.id))
                link(Message("Export"), export("entry", head.id))


def _list_imported(lab: Lab) -> None:
    """List the stored campaigns, newest first, with links; an import without corrections can be undone."""
    heading(Message("Imported"))
    stored = lab.store.list()
    if not stored:
        sentence(Message("None. Import one below."), "quiet")
    for campaign in reversed(stored):
        with ui.element("section").classes("card"):
            heading(campaign.name, 3)
            added, result = minute_words(campaign.added_at), _check_result(campaign)
            words = template("{id} · added {minute_words} · {check_result}")
            sentence(Message(words, id=campaign.id, minute_words=added, check_result=result), "quiet")
            with ui.element("div").classes("acts"):
                link(Message("Correct"), correction_address(campaign.id))
                link(Message("Analysis"), analysis("kept", campaign.id))
                link(Message("Export"), export("kept", campaign.id))
                is_from_other_layout = any(file.path == RECORD for file in campaign.files)
                if is_from_other_layout and not Journals(lab.store).corrections(campaign.id):
                    button(Message("Undo the import"), partial(_undo_import, lab, campaign.id), once=True)


def _undo_import(lab: Lab, id_: str) -> None:
    """Remove a stored campaign and show the page again."""
    lab.store.remove(id_)
    ui.navigate.to(PATH)


def _check_result(campaign: StoredCampaign) -> str:
    """Numbers of errors and warnings of a campaign in words, or "not checked"."""
    if campaign.n_errors is None or campaign.n_warnings is None:
        return Message("not checked")
    errors = counted(campaign.n_errors, "{count} error", "{count} errors")
    return f"{errors}, {counted(campaign.n_warnings, '{count} warning', '{count} warnings')}"


async def _add_sample(lab: Lab) -> None:
    """Store a synthetic campaign and show its analysis."""
    id_ = await run.io_bound(_store_sample, lab)
    if id_ is not None:
        ui.navigate.to(analysis("kept", id_))


def _store_sample(lab: Lab) -> str:
    """Store the synthetic sample campaign and return its id."""
    with TemporaryDirectory(prefix="skisnow-sample-") as name:
        folder = Path(name) / "sample"
        write_reference(folder, seed=SAMPLE_SEED)
        return lab.store.add(folder).id


def _import_form(lab: Lab) -> None:
    """Add the forms that upload a campaign as a folder, files or a zip."""
    heading(Message("Import"))
    sentence(
        Message(
            "A campaign's folder, its files, a zip, or a workbook (.xlsx) or CSV file in any layout. The files "
            "are kept unchanged; corrections are separate. At most {most} files.",
            most=lab.limits.files,
        ),
        "quiet",
    )
    for id_, text, further in (
        ("folder", (Message("Folder"), Message("Import folder")), "webkitdirectory"),
        ("files", (Message("Files or zip"), Message("Import files or zip")), ""),
    ):
        with upload_form(IMPORT).classes("acts"):
            file_input("files", text[0], f"import-{id_}", f"multiple {further}")
            submit_button(text[1])
    with ui.element("div").classes("acts"):
        link(Message("Add a measured track"), REPLAYS)
