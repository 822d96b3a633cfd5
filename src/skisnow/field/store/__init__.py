"""The embedded store: campaigns byte for byte, and journals (event sourcing) of campaigns that are being entered."""

from ...former_names import former_attributes
from .corrected_export import ExportedCampaign, add_corrections, corrected_files, export_corrected
from .journal import JournalHead, Journals, OvertakenError
from .journal_entry import JournalEntry, NewEntry
from .replayed import ReplayedCampaign, ReplayedRow, ReplayedTest, replayed
from .replayed_files import campaign_files, write_campaign
from .store import AddedCampaign, Finding, Store, StoredCampaign, StoredFile, default_path
from .stored_tables import StoredTable, stored_tables

__all__ = [
    "AddedCampaign",
    "ExportedCampaign",
    "Finding",
    "JournalEntry",
    "JournalHead",
    "Journals",
    "NewEntry",
    "OvertakenError",
    "ReplayedCampaign",
    "ReplayedRow",
    "ReplayedTest",
    "Store",
    "StoredCampaign",
    "StoredFile",
    "StoredTable",
    "add_corrections",
    "campaign_files",
    "corrected_files",
    "default_path",
    "export_corrected",
    "replayed",
    "stored_tables",
    "write_campaign",
]

__getattr__ = former_attributes(
    __name__, {"KeptTable": "StoredTable", "grown": "replayed", "kept_tables": "stored_tables"}
)
