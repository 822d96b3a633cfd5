"""Playwright's types for annotations: where it is not installed, tests that drive a browser are skipped."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Download, Locator, Page, WebSocketRoute
else:
    Browser = Download = Locator = Page = WebSocketRoute = Any

__all__ = ["Browser", "Download", "Locator", "Page", "WebSocketRoute"]
