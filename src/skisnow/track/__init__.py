"""Tracks: where something was on a slope, read from files, looked at and held against each other."""
