"""A campaign in entry that is damaged in the store does not hide the others, and none of its cells is shown."""

from __future__ import annotations

import sqlite3
import urllib.error
import urllib.request
from contextlib import closing
from typing import TYPE_CHECKING

import pytest

from skisnow.campaign.store import Journals, Store

if TYPE_CHECKING:
    from .conftest import Served


def test_a_damaged_campaign_is_named_beside_the_others(served: Served) -> None:
    with Store.open(served.store) as store:
        broken, sound = (Journals(store).begin(f'name = "{name}"\n') for name in ("broken", "sound"))
    with closing(sqlite3.connect(served.store)) as connection, connection:
        connection.execute("UPDATE journal_entry SET cells = replace(cells, 'broken', 'bsoken')")
    with urllib.request.urlopen(served.address) as answer:
        page = answer.read().decode()
    assert f"/enter/{sound}" in page and f"/enter/{broken}" not in page and "bsoken" not in page
    assert f"The entry 1 of the campaign in entry {broken} is damaged in the store" in page
    with pytest.raises(urllib.error.HTTPError) as refused:
        urllib.request.urlopen(f"{served.address}enter/{broken}")
    with refused.value as answer:
        said = answer.read().decode()
    assert "is damaged in the store" in said and "bsoken" not in said
