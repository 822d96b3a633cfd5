"""Tracks of receivers and simulated runs: reading, quality flags, motion, turns, runs, courses."""
