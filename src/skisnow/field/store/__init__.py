"""The embedded store: campaigns byte for byte, and journals of campaigns that are being entered."""

from .grown import ReplayedCampaign, ReplayedRow, ReplayedTest, grown
from .grown_files import campaign_files, write_campaign
from .journal import JournalHead, Journals, OvertakenError
from .journal_entry import JournalEntry, NewEntry
from .kept import ExportedCampaign, add_corrections, corrected_files, export_corrected
from .kept_tables import KeptTable, kept_tables
from .store import AddedCampaign, Finding, Store, StoredCampaign, StoredFile, default_path

__all__ = [
    "AddedCampaign",
    "ExportedCampaign",
    "Finding",
    "JournalEntry",
    "JournalHead",
    "Journals",
    "KeptTable",
    "NewEntry",
    "OvertakenError",
    "ReplayedCampaign",
    "ReplayedRow",
    "ReplayedTest",
    "Store",
    "StoredCampaign",
    "StoredFile",
    "add_corrections",
    "campaign_files",
    "corrected_files",
    "default_path",
    "export_corrected",
    "grown",
    "kept_tables",
    "write_campaign",
]
