"""The languages that pages and reports are read in: English, and one file of translations for each further one."""

from __future__ import annotations

from ..messages import ENGLISH
from .catalogues import Catalogue, catalogue, codes, languages, require_language

__all__ = ["ENGLISH", "Catalogue", "catalogue", "codes", "languages", "require_language"]
