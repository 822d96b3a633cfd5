"""The web lab in a real browser: time to each page, and how soon it answers a hand."""
