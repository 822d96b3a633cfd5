"""From the files of a campaign to records: decoding, tables, corrections, checks."""

from .campaign import check_campaign, read_campaign

__all__ = ["check_campaign", "read_campaign"]
