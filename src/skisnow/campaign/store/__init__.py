"""The store, a file or on a server: campaigns byte for byte, and journals (event sourcing) of those being entered."""

from .conflict import Conflict, Side
from .export import (
    ExportedCampaign,
    FoundCampaign,
    Position,
    attachments_of,
    corrected_files,
    entered_files,
    export_corrected,
    export_entered,
    find_campaign,
    photo_entry,
    position_entry,
    write_campaign,
)
from .journal import JournalEntry, JournalHead, Journals, NewEntry, OvertakenError
from .replayed import Reading, ReplayedCampaign, ReplayedTest, campaign_files, campaign_in_memory, replay_journal
from .server import ServerAddress, StorePlace, store_place
from .store import AddedCampaign, Finding, Store, StoredCampaign, StoredFile, default_path
from .stored_tables import StoredTable, stored_tables
from .sync import SyncResult, sync

__all__ = [
    "AddedCampaign", "Conflict", "ExportedCampaign", "Finding", "FoundCampaign", "JournalEntry", "JournalHead",
    "Journals", "NewEntry", "OvertakenError", "Position", "Reading", "ReplayedCampaign", "ReplayedTest",
    "ServerAddress", "Side", "Store", "StorePlace", "StoredCampaign", "StoredFile", "StoredTable", "SyncResult",
    "attachments_of", "campaign_files", "campaign_in_memory", "corrected_files", "default_path", "entered_files",
    "export_corrected", "export_entered", "find_campaign", "photo_entry", "position_entry", "replay_journal",
    "store_place", "stored_tables", "sync", "write_campaign",
]  # fmt: skip
