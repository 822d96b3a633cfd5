"""Entries that are sent again: each is written down once."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("journal_entry", sa.Column("once", sa.Text))
    op.create_index(op.f("ix_journal_entry_journal_id_once"), "journal_entry", ["journal_id", "once"], unique=True)


def downgrade() -> None:
    op.drop_index(op.f("ix_journal_entry_journal_id_once"), "journal_entry")
    op.drop_column("journal_entry", "once")
