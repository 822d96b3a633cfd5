"""Migrations of the store: how its tables came about, one step per file of ``versions``.

They travel with the package and are run by it, never through an ``alembic.ini`` of the working directory.
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


def knows(revision: str) -> bool:
    """Tell whether a store's revision is one of ours; an unknown one comes from a newer program."""
    return revision in {each.revision for each in ScriptDirectory.from_config(alembic_config()).walk_revisions()}


def upgrade(connection: Connection, revision: str = "head") -> None:
    """Run the missing migrations inside the connection's transaction."""
    with _ALEMBIC:
        command.upgrade(alembic_config(connection), revision)


def downgrade(connection: Connection, revision: str) -> None:
    """Take migrations back inside the connection's transaction."""
    with _ALEMBIC:
        command.downgrade(alembic_config(connection), revision)
