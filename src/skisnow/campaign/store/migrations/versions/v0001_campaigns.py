"""Campaigns and their raw files."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None
branch_labels = None
depends_on = None


def upgrade() -> None:
    is_file = op.get_bind().dialect.name == "sqlite"
    if is_file:
        op.execute("PRAGMA application_id = 0x536B6953")  # as it was then: a migration never follows today's constants
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


def downgrade() -> None:
    op.drop_table("campaign_file")
    op.drop_table("chunk")
    op.drop_table("content")
    op.drop_table("campaign")
    if op.get_bind().dialect.name == "sqlite":
        op.execute("PRAGMA application_id = 0")
