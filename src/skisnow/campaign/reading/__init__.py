"""From the files of a campaign to records: decoding, tables, corrections, checks."""
