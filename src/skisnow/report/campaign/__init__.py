"""Report of an analysed campaign: its tables, sentences and page."""
