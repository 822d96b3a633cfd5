"""From the files of a campaign to records: decoding, tables, corrections, checks."""

from .campaign import CAMPAIGN_FILES, campaign_of_files, check_campaign, is_read, read_campaign
from .campaign_files import FilesInMemory
from .workbook_files import unfolded

__all__ = [
    "CAMPAIGN_FILES",
    "FilesInMemory",
    "campaign_of_files",
    "check_campaign",
    "is_read",
    "read_campaign",
    "unfolded",
]
