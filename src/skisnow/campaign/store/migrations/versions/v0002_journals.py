"""Journals: campaigns that are being entered, reading by reading."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "journal",
        sa.Column("id", sa.String(12), nullable=False),
        sa.Column("begun_at", sa.String(20), nullable=False),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_journal")),
    )
    op.create_table(
        "journal_entry",
        sa.Column("sequence", sa.Integer, nullable=False),
        sa.Column("journal_id", sa.String(12), nullable=False),
        sa.Column("at", sa.String(20), nullable=False),
        sa.Column("who", sa.Text, nullable=False),
        sa.Column("action", sa.String(8), nullable=False),
        sa.Column("file", sa.Text, nullable=False),
        sa.Column("test", sa.Text, nullable=False),
        sa.Column("position", sa.Integer),
        sa.Column("about", sa.Integer),
        sa.Column("cells", sa.Text, nullable=False),
        sa.Column("why", sa.Text, nullable=False),
        sa.PrimaryKeyConstraint("sequence", name=op.f("pk_journal_entry")),
        sa.CheckConstraint(
            "action IN ('describe', 'add', 'correct', 'cancel', 'undo')", name=op.f("ck_journal_entry_known_action")
        ),
        sa.CheckConstraint(
            "(about IS NULL) = (action IN ('describe', 'add', 'cancel'))", name=op.f("ck_journal_entry_about_an_entry")
        ),
        sa.ForeignKeyConstraint(
            ["journal_id"], ["journal.id"], name=op.f("fk_journal_entry_journal_id_journal"), ondelete="CASCADE"
        ),
        sa.ForeignKeyConstraint(
            ["about"], ["journal_entry.sequence"], name=op.f("fk_journal_entry_about_journal_entry")
        ),
    )
    op.create_index(op.f("ix_journal_entry_journal_id_file_test"), "journal_entry", ["journal_id", "file", "test"])


def downgrade() -> None:
    op.drop_table("journal_entry")
    op.drop_table("journal")
