"""From the files of a campaign to records: decoding, tables, corrections, checks."""

from .campaign import CAMPAIGN_FILES, READ_FILES, campaign_of_cells, campaign_of_files, check_campaign, read_campaign
from .campaign_files import FilesInMemory
from .workbook_files import unfold_workbooks

__all__ = [
    "CAMPAIGN_FILES",
    "READ_FILES",
    "FilesInMemory",
    "campaign_of_cells",
    "campaign_of_files",
    "check_campaign",
    "read_campaign",
    "unfold_workbooks",
]
