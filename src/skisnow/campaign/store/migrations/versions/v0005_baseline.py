"""Baseline: all tables of the store.

Its number is the schema's, so that stores which already have these tables open without a migration.
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = None
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Create all tables of the store."""
    is_file = op.get_bind().dialect.name == "sqlite"
    _create_campaign_tables(is_file)
    _create_journal_tables()


def _create_campaign_tables(is_file: bool) -> None:
    if is_file:
        op.execute("PRAGMA application_id = 0x536B6953")  # a literal: constants can change later
    op.create_table(
        "campaign",
        sa.Column("id", sa.String(12), nullable=False),
        sa.Column("sha256", sa.String(64), nullable=False),
        sa.Column("name", sa.Text, nullable=False),
        sa.Column("added_at", sa.String(20), nullable=False),
        sa.Column("n_errors", sa.Integer),
        sa.Column("n_warnings", sa.Integer),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_campaign")),
        sa.CheckConstraint("id = substr(sha256, 1, 12)", name=op.f("ck_campaign_id_from_sha256")),
        sa.CheckConstraint("(n_errors IS NULL) = (n_warnings IS NULL)", name=op.f("ck_campaign_both_counts_or_none")),
        sa.UniqueConstraint("sha256", name=op.f("uq_campaign_sha256")),
        comment="campaigns of a store of skisnow",  # which a server keeps
    )
    op.create_table(
        "content",
        sa.Column("sha256", sa.String(64), nullable=False),
        sa.Column("size", sa.Integer if is_file else sa.BigInteger, nullable=False),
        sa.PrimaryKeyConstraint("sha256", name=op.f("pk_content")),
        sa.CheckConstraint("size >= 0", name=op.f("ck_content_size_not_negative")),
    )
    op.create_table(
        "chunk",
        sa.Column("sha256", sa.String(64), nullable=False),
        sa.Column("position", sa.Integer, nullable=False),
        sa.Column("data", sa.LargeBinary, nullable=False),
        sa.PrimaryKeyConstraint("sha256", "position", name=op.f("pk_chunk")),
        sa.ForeignKeyConstraint(
            ["sha256"], ["content.sha256"], name=op.f("fk_chunk_sha256_content"), ondelete="CASCADE"
        ),
    )
    op.create_table(
        "campaign_file",
        sa.Column("campaign_id", sa.String(12), nullable=False),
        sa.Column("path", sa.Text, nullable=False),
        sa.Column("sha256", sa.String(64), nullable=False),
        sa.PrimaryKeyConstraint("campaign_id", "path", name=op.f("pk_campaign_file")),
        sa.ForeignKeyConstraint(
            ["campaign_id"],
            ["campaign.id"],
            name=op.f("fk_campaign_file_campaign_id_campaign"),
            ondelete="CASCADE",
        ),
        sa.ForeignKeyConstraint(["sha256"], ["content.sha256"], name=op.f("fk_campaign_file_sha256_content")),
    )
    op.create_index(op.f("ix_campaign_file_sha256"), "campaign_file", ["sha256"])


def _create_journal_tables() -> None:
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
        sa.Column("once", sa.Text),
        sa.Column("sha256", sa.String(64)),
        sa.Column("sums", sa.Text),
        sa.Column("uid", sa.String(31)),
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
    op.create_index(op.f("ix_journal_entry_journal_id_once"), "journal_entry", ["journal_id", "once"], unique=True)
    op.create_index(op.f("ix_journal_entry_uid"), "journal_entry", ["uid"], unique=True)


def downgrade() -> None:
    op.drop_table("journal_entry")
    op.drop_table("journal")
    op.drop_table("campaign_file")
    op.drop_table("chunk")
    op.drop_table("content")
    op.drop_table("campaign")
    if op.get_bind().dialect.name == "sqlite":
        op.execute("PRAGMA application_id = 0")
