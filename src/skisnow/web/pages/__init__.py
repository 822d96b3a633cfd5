"""The pages of the lab, one module each.

A page is a module with ``PATH`` (its address), ``TITLE`` (its name in the navigation) and ``add_page(lab)``, which adds
it to the application. To add a page, add a module and its name in `PAGES`.
"""

from __future__ import annotations

from typing import Final

PAGES: Final = ("campaigns", "skis", "carve", "design", "simulate", "study", "replay")
"""Modules of this folder, in the order of the navigation."""

INNER: Final = ("import_file", "describe", "enter", "analysis", "study_table")
"""Modules of pages without a link in the navigation."""
