"""Readers of tracks, one file for each format: from bytes to a `Recording`."""
