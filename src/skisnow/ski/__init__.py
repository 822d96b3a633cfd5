"""Skis: their shape, stiffness and mass, their files and a catalogue. Knows no snow."""

from .ski import Ski, SkiSections

__all__ = ["Ski", "SkiSections"]
