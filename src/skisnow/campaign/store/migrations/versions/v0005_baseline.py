"""Baseline: stores with this revision have the tables that ``schema`` had when the first migration was written.

An empty store gets the current tables at once (`upgrade` of this package), so the baseline itself creates none.
"""

from __future__ import annotations

from alembic import op

from skisnow.campaign.store.schema import metadata

revision = "0005"
down_revision = None
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Do nothing: this revision is the schema that a new store has."""


def downgrade() -> None:
    """Remove all tables and, with SQLite, the application's number."""
    metadata.drop_all(op.get_bind())
    if op.get_bind().dialect.name == "sqlite":
        op.execute("PRAGMA application_id = 0")
