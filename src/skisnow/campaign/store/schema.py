"""Tables of the store.

A campaign is a list of paths, each with a content. A content is a SHA-256 and its bytes in chunks, so that a file of
any size needs the memory of one chunk. Campaigns that share a file share its content.

A change of these tables needs a migration of the stores that exist and a new ``REVISION``.
"""

from __future__ import annotations

from typing import Final

from sqlalchemy import (
    BigInteger,
    CheckConstraint,
    Column,
    ForeignKey,
    ForeignKeyConstraint,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    String,
    Table,
    Text,
)

REVISION: Final = "0005"
"""Newest migration; tests compare it with the migrations themselves."""

APPLICATION_ID: Final = 0x536B6953
"""Number in the file's header ("SkiS") that tells a store from other people's SQLite files."""

MARK: Final = "campaigns of a store of skisnow"
"""Comment on a table that tells a store on a server from other people's tables."""

CHUNK_BYTES: Final = 1 << 20

metadata = MetaData(
    naming_convention={
        "ix": "ix_%(table_name)s_%(column_0_N_name)s",
        "uq": "uq_%(table_name)s_%(column_0_N_name)s",
        "ck": "ck_%(table_name)s_%(constraint_name)s",
        "fk": "fk_%(table_name)s_%(column_0_N_name)s_%(referred_table_name)s",
        "pk": "pk_%(table_name)s",
    }
)

campaign = Table(
    "campaign",
    metadata,
    Column("id", String(12), primary_key=True),
    Column("sha256", String(64), nullable=False, unique=True),
    Column("name", Text, nullable=False),
    Column("added_at", String(20), nullable=False),
    Column("n_errors", Integer),
    Column("n_warnings", Integer),
    CheckConstraint("id = substr(sha256, 1, 12)", name="id_from_sha256"),
    CheckConstraint("(n_errors IS NULL) = (n_warnings IS NULL)", name="both_counts_or_none"),
    comment=MARK,
)
"""``added_at``: UTC, ISO 8601. Counts are NULL where the campaign could not be checked."""

content = Table(
    "content",
    metadata,
    Column("sha256", String(64), primary_key=True),
    Column("size", BigInteger().with_variant(Integer, "sqlite"), nullable=False),
    CheckConstraint("size >= 0", name="size_not_negative"),
)

chunk = Table(
    "chunk",
    metadata,
    Column("sha256", String(64), nullable=False, primary_key=True),
    Column("position", Integer, nullable=False, primary_key=True),
    Column("data", LargeBinary, nullable=False),
    ForeignKeyConstraint(["sha256"], ["content.sha256"], ondelete="CASCADE"),
)
"""``position`` counts a content's chunks from 0; an empty file has no chunk."""

campaign_file = Table(
    "campaign_file",
    metadata,
    Column("campaign_id", String(12), ForeignKey("campaign.id", ondelete="CASCADE"), primary_key=True),
    Column("path", Text, primary_key=True),
    Column("sha256", String(64), ForeignKey("content.sha256"), nullable=False, index=True),
)
"""``path``: relative to the campaign's folder, parts joined by ``/``."""

journal = Table(
    "journal", metadata, Column("id", String(12), primary_key=True), Column("begun_at", String(20), nullable=False)
)
"""A campaign that is still being entered. Its state is replayed from its entries alone (event sourcing)."""

journal_entry = Table(
    "journal_entry",
    metadata,
    Column("sequence", Integer, primary_key=True),
    Column("journal_id", String(12), ForeignKey("journal.id", ondelete="CASCADE"), nullable=False),
    Column("at", String(20), nullable=False),
    Column("who", Text, nullable=False),
    Column("action", String(8), nullable=False),
    Column("file", Text, nullable=False),
    Column("test", Text, nullable=False),
    Column("position", Integer),
    Column("about", Integer, ForeignKey("journal_entry.sequence")),
    Column("cells", Text, nullable=False),
    Column("why", Text, nullable=False),
    Column("once", Text),
    Column("sha256", String(64)),
    Column("uid", String(31)),
    CheckConstraint("action IN ('describe', 'add', 'correct', 'cancel', 'undo')", name="known_action"),
    CheckConstraint("(about IS NULL) = (action IN ('describe', 'add', 'cancel'))", name="about_an_entry"),
    Index(None, "journal_id", "file", "test"),
    Index(None, "journal_id", "once", unique=True),
    Index(None, "uid", unique=True),
)
"""Entries are only ever added. ``about``: the entry that is corrected or undone; ``cells``: a JSON object of texts;
``once``: what tells an entry that is sent again from a new one; ``sha256``: of all that the entry says; ``uid``: what
the entry is called in every store that has it. Older stores have a further column ``sums``, which is not read."""
