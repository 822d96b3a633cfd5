"""Corrections of an imported campaign: its files stay as they came in, and what is corrected stands beside them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from .._support.errors import FieldDataError, StoreError
from ..campaign import campaign_of_files
from ..campaign.reading import READ_FILES, FilesInMemory, unfolded
from ..campaign.reading.campaign_file import CAMPAIGN_FILE, read_campaign_file
from ..campaign.reading.table_forms import CORRECTIONS
from ..campaign.reading.text import UnreadableTextError, decode
from ..campaign.store import corrected_files, stored_tables
from ..campaign.store.journal_entry import JournalEntry
from ..campaign.store.replayed import ReplayedRow, ReplayedTest
from ..campaign.store.stored_tables import cell_key
from .edit_session import EditSession, QuickResults, quick_results
from .words import TABLES

if TYPE_CHECKING:
    from ..campaign.problems import Problem
    from ..campaign.reading.campaign_file import CampaignFile
    from ..campaign.store import NewEntry, StoredTable
    from .settings import Lab

OWN_SHEET: Final = (
    "The corrections of this campaign stand in a sheet of its workbook. Correct it there, and import the workbook "
    "again."
)


class CorrectionSession(EditSession):
    """A kept campaign as one page sees it."""

    def __init__(self, lab: Lab, id_: str) -> None:
        self.stored, self._files = lab.store.contents(id_, READ_FILES)
        self._tables = unfolded(FilesInMemory(self._files))
        self._entries: tuple[JournalEntry, ...] = ()
        stored = stored_tables(self._tables)
        self.tables: dict[str, StoredTable] = {file: table for file, table in stored.items() if file in TABLES}
        super().__init__(lab, self.stored.id)

    @property
    def described(self) -> CampaignFile:
        """What its campaign.toml says, or the sheets that stand for it.

        Raises
        ------
        FieldDataError, StoreError
            It cannot be read.
        """
        found: list[Problem] = []
        try:
            text = decode(self._tables.read(CAMPAIGN_FILE) or b"").text
        except (FileNotFoundError, UnreadableTextError) as error:
            raise StoreError(f"{CAMPAIGN_FILE} of this campaign cannot be read, so nothing in it can be.") from error
        described = read_campaign_file(text, found)
        if described is None:
            raise FieldDataError(found)
        return described

    def _written_since(self) -> tuple[JournalEntry, ...]:
        new = self._journals.corrections(self.id, after=self._last)
        self._entries += new
        return new

    def test(self, file: str, name: str) -> ReplayedTest:
        """A test with its cells by line and column as they are now, whether or not it was ever spoken of."""
        corrected = self.campaign.test(file, name)
        if corrected.rows or name not in self.tables[file].tests:
            return corrected
        said = JournalEntry(action="add", file=file, test=name, cells=self.standing(file, name), sequence=0, at="")
        return ReplayedTest(file, name, rows=[ReplayedRow(said)])

    def unit(self, file: str, column: str) -> str:
        """Unit of the cells of a column, if it is another one than its name states."""
        found = self.tables[file].conversions.get(column)
        return found.name if found is not None else ""

    def standing(self, file: str, name: str) -> dict[str, str]:
        """Every cell of a test as the files say it."""
        rows = self.tables[file].tests.get(name, {})
        return {cell_key(line, column): text for line, cells in rows.items() for column, text in cells.items()}

    def write_down(self, entry: NewEntry, *, seen: int) -> JournalEntry:
        """Store a correction, a cancelling or an undoing; see `Journals.correct`.

        Raises
        ------
        StoreError
            As there; or the campaign's own corrections stand in a sheet, which no rows can follow.
        """
        if CORRECTIONS.file in self._tables.places:
            raise StoreError(OWN_SHEET)
        standing = self.standing(entry.file, entry.test)
        written = self._journals.correct(self.id, entry, seen=seen, standing=standing)
        self.refresh()
        return written

    def quick_results(self, site: str) -> QuickResults:
        """What the tests of a site say, by the same way that an analysis of the exported folder would take."""
        return quick_results(campaign_of_files(corrected_files(self._files, self._entries)), site)
