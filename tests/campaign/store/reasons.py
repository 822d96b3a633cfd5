"""Reasons why a store cannot be used, for tests that do not assert their wording."""

import sqlite3

from skisnow._support.sqlite_file import _PLACE_REASONS, NO_ROOM, READ_ONLY
from skisnow.campaign.store.engine import _NO_STORE as NO_STORE
from skisnow.campaign.store.engine import _NOT_ALLOWED as NOT_ALLOWED

__all__ = ["CANNOT_OPEN", "LOCKED", "NOT_ALLOWED", "NO_ROOM", "NO_STORE", "READ_ONLY"]

LOCKED = _PLACE_REASONS[sqlite3.SQLITE_BUSY]
CANNOT_OPEN = _PLACE_REASONS[sqlite3.SQLITE_CANTOPEN]
