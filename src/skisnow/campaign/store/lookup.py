"""Campaigns of both kinds, stored files and lab entries: found by the beginning of an id, exported as a folder."""

from __future__ import annotations

from hashlib import sha256
from typing import TYPE_CHECKING, TypeAlias

from .engine import database_errors, file_errors, reading
from .folder import StoredFile, new_folder
from .journal import JournalHead, Journals
from .replayed import campaign_files, replayed, write_campaign
from .rows import ID_DIGITS, NamedId, StoredCampaign, known_campaigns, required_digits, unclear_id

if TYPE_CHECKING:
    from pathlib import Path

    from .store import Store

FoundCampaign: TypeAlias = StoredCampaign | JournalHead


def find_campaign(store: Store, id: str) -> FoundCampaign:  # noqa: A002 (as in Store)
    """The campaign whose id begins so: stored files or lab entries.

    Raises
    ------
    StoreError
        No campaign or several begin so; the message lists those that may be meant.
    """
    beginning = required_digits(id)
    heads = {head.id: head for head in Journals(store).list()}
    with database_errors(store.path, "could not be read"), reading(store.engine) as connection:
        stored = known_campaigns(connection)
    entered = [NamedId(head.id, head.name) for head in heads.values()]
    matching = [each for each in entered if str(each.id).startswith(beginning)]
    stored_too = [each for each in stored if str(each.id).startswith(beginning[:ID_DIGITS])]
    if len(matching) == 1 and not stored_too:
        return heads[str(matching[0].id)]
    if stored_too and not matching:
        return store.show(beginning)
    raise unclear_id(beginning, [*stored_too, *matching], [*stored, *entered])


def entered_files(store: Store, id: str) -> tuple[StoredFile, ...]:  # noqa: A002
    """The files that `export_entered` writes, sorted by path; raises as it does."""
    texts = campaign_files(replayed(Journals(store).entries(id)))
    contents = {path: text.encode() for path, text in sorted(texts.items())}
    return tuple(StoredFile(path, len(data), sha256(data).hexdigest()) for path, data in contents.items())


def export_entered(store: Store, id: str, folder: Path) -> None:  # noqa: A002
    """Write a campaign that consists of lab entries as a new folder, which `read_campaign` reads.

    Raises
    ------
    StoreError
        There is no such campaign, an entry is damaged, or the folder exists and is not empty.
    """
    campaign = replayed(Journals(store).entries(id))
    with file_errors(folder, "could not be written"), new_folder(folder) as filling:
        write_campaign(campaign, filling)
