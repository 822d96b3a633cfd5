"""Figures of runs, tracks, courses and identifications, and the shared style of all figures."""
