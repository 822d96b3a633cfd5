"""Bodies pressed into snow: contact area and displaced volume. Knows no snow."""

from .tools import Disc, GeometryForm, LyingCylinder, PlainWedge, SkiPiece, Tool, in_form

__all__ = ["Disc", "GeometryForm", "LyingCylinder", "PlainWedge", "SkiPiece", "Tool", "in_form"]
