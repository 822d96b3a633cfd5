"""Migrations of the store's schema, one file of ``versions`` each: a baseline with all tables, then later changes.

skisnow runs them itself and reads no ``alembic.ini`` of the working directory.
"""

from __future__ import annotations

from threading import Lock
from typing import TYPE_CHECKING

from alembic import command
from alembic.config import Config
from alembic.script import ScriptDirectory

if TYPE_CHECKING:
    from sqlalchemy import Connection

_ALEMBIC = Lock()  # alembic keeps the running migration in module-level proxies: one at a time in a process


def alembic_config(connection: Connection | None = None) -> Config:
    """Configure alembic for these migrations, on a connection whose transaction the caller owns."""
    config = Config()
    config.set_main_option("script_location", "skisnow.campaign:store/migrations")
    config.set_main_option("path_separator", "os")
    if connection is not None:
        config.attributes["connection"] = connection
    return config


def is_known(revision: str) -> bool:
    """True if a store's revision is one of these migrations; an unknown revision comes from another version."""
    return revision in {script.revision for script in ScriptDirectory.from_config(alembic_config()).walk_revisions()}


def upgrade(connection: Connection, revision: str = "head") -> None:
    """Run the missing migrations inside the connection's transaction."""
    with _ALEMBIC:
        command.upgrade(alembic_config(connection), revision)


def downgrade(connection: Connection, revision: str) -> None:
    """Revert migrations down to a revision, inside the connection's transaction."""
    with _ALEMBIC:
        command.downgrade(alembic_config(connection), revision)
