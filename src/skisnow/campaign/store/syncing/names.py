"""The names of campaigns, and which from two sources bear the same."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from sqlalchemy import Connection, select

from ..entered_name import entered_name
from ..schema import campaign, journal

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping


@dataclass(frozen=True, slots=True)
class Names:
    """Names by id, of stored campaigns and of those in entry; damaged ones have none."""

    stored: Mapping[str, str]
    entered: Mapping[str, str]

    @property
    def all(self) -> dict[str, str]:
        """Both kinds."""
        return {**self.entered, **self.stored}


def names_of(connection: Connection) -> Names:
    """The names of a store's campaigns."""
    rows = connection.execute(select(campaign.c.id, campaign.c.name)).all()
    stored = {str(id_): name for id_, name in rows if isinstance(name, str)}
    ids = set(connection.execute(select(journal.c.id)).scalars()) - {id_ for id_, _ in rows}
    return Names(stored, {id_: name for id_ in ids if (name := entered_name(connection, id_))})


def same_names(here: Names, there: Names) -> Iterator[str]:
    """Campaigns of one kind and name that meet for the first time, in words."""
    for what, of_here, of_there in (
        ("stored campaigns", here.stored, there.stored),
        ("campaigns in entry", here.entered, there.entered),
    ):
        met = {
            (name, other, id_)
            for id_, name in of_there.items()
            if id_ not in of_here
            for other, its_name in of_here.items()
            if its_name == name
        }
        for name, other, id_ in sorted(met):
            yield (
                f"Two {what} are called {name!r}: {other}, which was here, and {id_} from there. "
                "They are kept apart; give one another name if they are not the same."
            )
