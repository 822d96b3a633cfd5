"""Run by alembic for each command; the connection and its transaction are the caller's."""

from __future__ import annotations

from alembic import context

from skisnow.campaign.store.schema import metadata


def run() -> None:
    """Run the migrations in one transaction of the connection that Alembic's configuration carries."""
    context.configure(connection=context.config.attributes["connection"], target_metadata=metadata)
    with context.begin_transaction():
        context.run_migrations()


if hasattr(context, "config"):  # absent when the file is imported by anything but alembic, a doctest collector for one
    run()
