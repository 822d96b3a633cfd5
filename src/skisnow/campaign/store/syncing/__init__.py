"""Two stores made alike, a laptop's and its group's: what one lacks comes from the other, what contradicts is shown."""

from .conflict import Conflict, Side
from .sync import Synced, sync

__all__ = ["Conflict", "Side", "Synced", "sync"]
