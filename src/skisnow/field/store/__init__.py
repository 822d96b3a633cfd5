"""The embedded store: campaigns byte for byte, and journals of campaigns that are being entered."""

from .grown import GrownCampaign, GrownRow, GrownTest, grown
from .grown_files import campaign_files, write_campaign
from .journal import JournalEntry, JournalHead, Journals, NewEntry, OvertakenError
from .store import AddedCampaign, Finding, Store, StoredCampaign, StoredFile, default_path

__all__ = [
    "AddedCampaign",
    "Finding",
    "GrownCampaign",
    "GrownRow",
    "GrownTest",
    "JournalEntry",
    "JournalHead",
    "Journals",
    "NewEntry",
    "OvertakenError",
    "Store",
    "StoredCampaign",
    "StoredFile",
    "campaign_files",
    "default_path",
    "grown",
    "write_campaign",
]
