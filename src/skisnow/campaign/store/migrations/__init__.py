"""Tables of an empty store, and migrations of older ones, one file of ``versions`` each.

skisnow runs them itself and reads no ``alembic.ini`` of the working directory.
"""

from __future__ import annotations

from threading import Lock

from alembic import command
from alembic.config import Config
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, inspect

from ..schema import APPLICATION_ID, campaign, metadata

_ALEMBIC = Lock()  # alembic keeps the running migration in module-level proxies: one at a time in a process


def alembic_config(connection: Connection | None = None) -> Config:
    """Configure alembic for these migrations, on a connection whose transaction the caller owns."""
    config = Config()
    config.set_main_option("script_location", "skisnow.campaign:store/migrations")
    if connection is not None:
        config.attributes["connection"] = connection
    return config


def is_known(revision: str) -> bool:
    """True if a store's revision is one of these migrations; an unknown revision comes from another version."""
    return revision in {script.revision for script in ScriptDirectory.from_config(alembic_config()).walk_revisions()}


def upgrade(connection: Connection) -> None:
    """Create the tables of an empty store, or run the missing migrations; inside the connection's transaction."""
    with _ALEMBIC:
        if inspect(connection).has_table(campaign.name):
            command.upgrade(alembic_config(connection), "head")
            return
        command.stamp(alembic_config(connection), "head")
        metadata.create_all(connection)
        if connection.dialect.name == "sqlite":
            connection.exec_driver_sql(f"PRAGMA application_id = {APPLICATION_ID}")


def downgrade(connection: Connection, revision: str) -> None:
    """Revert migrations down to a revision, inside the connection's transaction."""
    with _ALEMBIC:
        command.downgrade(alembic_config(connection), revision)
