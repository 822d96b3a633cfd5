"""A workbook in another layout becomes a campaign in the lab, in both languages, and is taken back."""

from __future__ import annotations

from pathlib import Path

import pytest

from skisnow import samples
from skisnow.campaign.importing import RECORD

from ..desk import Desk, in_this_process

WORKBOOK = (Path(samples.__file__).parent / "files" / "two-sites.xlsx").read_bytes()


@pytest.mark.parametrize(("language", "store"), [("en", "Store the campaign"), ("de", "Kampagne speichern")])
def test_workbook_is_proposed_stored_and_taken_back(
    desk: Desk, monkeypatch: pytest.MonkeyPatch, language: str, store: str
) -> None:
    in_this_process(monkeypatch, "transfer", "pages.import_file")
    answer = desk.post("/import", language, files={"files": ("two-sites.xlsx", WORKBOOK)})
    assert answer.status_code == 303
    page = desk.open(answer.headers["location"], language)
    page.shows("1.163")
    page.press(store)
    page.told("open ")
    (stored,) = desk.lab.store.list()
    assert {file.path for file in stored.files} == {
        "campaign.toml", "penetration.csv", "shear.csv", "original/two-sites.xlsx", RECORD,
    }  # fmt: skip
    assert desk.lab.store.contents(stored.id, {"original/two-sites.xlsx"})[1].popitem()[1] == WORKBOOK
    assert stored.n_errors == 0
    desk.do(lambda: desk.lab.store.remove(stored.id))
    assert desk.lab.store.list() == ()
    assert desk.lab.store.verify() == ()
