"""Tables of the store.

A campaign is a list of paths, each with a content. A content is a SHA-256 and its bytes in chunks, so that a file of
any size needs the memory of one chunk. Campaigns that share a file share its content.

A change of these tables needs a migration of the stores that exist and a new ``REVISION``.
"""

from __future__ import annotations

from typing import Final

import sqlalchemy as sa

REVISION: Final = "0005"
"""Newest migration; tests compare it with the migrations themselves."""

APPLICATION_ID: Final = 0x536B6953
"""Number in the file's header ("SkiS") that tells a store from other people's SQLite files."""

MARK: Final = "campaigns of a store of skisnow"
"""Comment on a table that tells a store on a server from other people's tables."""

CHUNK_BYTES: Final = 1 << 20

metadata = sa.MetaData(
    naming_convention={
        "ix": "ix_%(table_name)s_%(column_0_N_name)s",
        "uq": "uq_%(table_name)s_%(column_0_N_name)s",
        "ck": "ck_%(table_name)s_%(constraint_name)s",
        "fk": "fk_%(table_name)s_%(column_0_N_name)s_%(referred_table_name)s",
        "pk": "pk_%(table_name)s",
    }
)

campaign = sa.Table(
    "campaign",
    metadata,
    sa.Column("id", sa.String(12), primary_key=True),
    sa.Column("sha256", sa.String(64), nullable=False, unique=True),
    sa.Column("name", sa.Text, nullable=False),
    sa.Column("added_at", sa.String(20), nullable=False),
    sa.Column("n_errors", sa.Integer),
    sa.Column("n_warnings", sa.Integer),
    sa.CheckConstraint("id = substr(sha256, 1, 12)", name="id_from_sha256"),
    sa.CheckConstraint("(n_errors IS NULL) = (n_warnings IS NULL)", name="both_counts_or_none"),
    comment=MARK,
)
"""``added_at``: UTC, ISO 8601. Counts are NULL where the campaign could not be checked."""

content = sa.Table(
    "content",
    metadata,
    sa.Column("sha256", sa.String(64), primary_key=True),
    sa.Column("size", sa.BigInteger().with_variant(sa.Integer, "sqlite"), nullable=False),
    sa.CheckConstraint("size >= 0", name="size_not_negative"),
)

chunk = sa.Table(
    "chunk",
    metadata,
    sa.Column("sha256", sa.String(64), nullable=False, primary_key=True),
    sa.Column("position", sa.Integer, nullable=False, primary_key=True),
    sa.Column("data", sa.LargeBinary, nullable=False),
    sa.ForeignKeyConstraint(["sha256"], ["content.sha256"], ondelete="CASCADE"),
)
"""``position`` counts a content's chunks from 0; an empty file has no chunk."""

campaign_file = sa.Table(
    "campaign_file",
    metadata,
    sa.Column("campaign_id", sa.String(12), sa.ForeignKey("campaign.id", ondelete="CASCADE"), primary_key=True),
    sa.Column("path", sa.Text, primary_key=True),
    sa.Column("sha256", sa.String(64), sa.ForeignKey("content.sha256"), nullable=False, index=True),
)
"""``path``: relative to the campaign's folder, parts joined by ``/``."""

journal = sa.Table(
    "journal",
    metadata,
    sa.Column("id", sa.String(12), primary_key=True),
    sa.Column("begun_at", sa.String(20), nullable=False),
)
"""A campaign that is still being entered. Its state is replayed from its entries alone (event sourcing)."""

journal_entry = sa.Table(
    "journal_entry",
    metadata,
    sa.Column("sequence", sa.Integer, primary_key=True),
    sa.Column("journal_id", sa.String(12), sa.ForeignKey("journal.id", ondelete="CASCADE"), nullable=False),
    sa.Column("at", sa.String(20), nullable=False),
    sa.Column("who", sa.Text, nullable=False),
    sa.Column("action", sa.String(8), nullable=False),
    sa.Column("file", sa.Text, nullable=False),
    sa.Column("test", sa.Text, nullable=False),
    sa.Column("position", sa.Integer),
    sa.Column("about", sa.Integer, sa.ForeignKey("journal_entry.sequence")),
    sa.Column("cells", sa.Text, nullable=False),
    sa.Column("why", sa.Text, nullable=False),
    sa.Column("once", sa.Text),
    sa.Column("sha256", sa.String(64)),
    sa.Column("uid", sa.String(31)),
    sa.CheckConstraint("action IN ('describe', 'add', 'correct', 'cancel', 'undo')", name="known_action"),
    sa.CheckConstraint("(about IS NULL) = (action IN ('describe', 'add', 'cancel'))", name="about_an_entry"),
    sa.Index(None, "journal_id", "file", "test"),
    sa.Index(None, "journal_id", "once", unique=True),
    sa.Index(None, "uid", unique=True),
)
"""Entries are only ever added. ``about``: the entry that is corrected or undone; ``cells``: a JSON object of texts;
``once``: what tells an entry that is sent again from a new one; ``sha256``: of all that the entry says; ``uid``: what
the entry is called in every store that has it. Older stores have a further column ``sums``, which is not read."""
