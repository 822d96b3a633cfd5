"""Campaigns that are edited in the lab: entered ones from their journal, imported ones with their corrections."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, TypeAlias

from .._support.csv_text import UnreadableTextError, decode
from .._support.errors import FieldDataError, StoreError
from .._support.messages import Message, joined
from ..campaign import QUALITY_FLAGS, Campaign, campaign_of_files
from ..campaign.problems import Problem
from ..campaign.reading.campaign import ATTACHMENTS, READ_FILES
from ..campaign.reading.campaign_file import CAMPAIGN_FILE, CampaignFile, read_campaign_file
from ..campaign.reading.campaign_files import FilesInMemory
from ..campaign.reading.table_forms import CORRECTIONS, PENETRATION, SHEAR
from ..campaign.reading.workbook_files import unfold_workbooks
from ..campaign.store import (
    JournalEntry,
    Journals,
    NewEntry,
    ReplayedCampaign,
    ReplayedTest,
    StoredTable,
    campaign_in_memory,
    corrected_files,
    replay_journal,
    stored_tables,
)
from ..campaign.store.export import rows_of_file
from ..campaign.store.replayed import Reading
from ..campaign.store.stored_tables import cell_key
from ..estimation import quality_flags
from ..estimation.result_rows import experiment_hardness, experiment_results
from ..estimation.screening import screened_both
from ..report.campaign.verdicts import quick_verdicts
from ..report.charts import SeriesCurve, series_curves
from .settings import Lab
from .words import TABLES

TestKey: TypeAlias = tuple[str, str]
"""File of the table and name of the test: tests of different tables may have the same name."""


@dataclass(frozen=True, slots=True)
class QuickResults:
    """Results of the tests of one site that are computed while the campaign is entered, by file and name of the test.

    experiments: rows of results.json. Density samples and drop-cone tests have none.
    curves: readings and fitted law of each penetration series.
    flags: sentences of the quality flags of each test, by code.
    """

    experiments: dict[TestKey, dict[str, Any]]
    curves: dict[TestKey, SeriesCurve]
    flags: dict[TestKey, dict[str, str]]


class EditSession:
    """Reads and writes the journal of an entered campaign for one page; `refresh` reads the entries of other pages."""

    def __init__(self, lab: Lab, id_: str) -> None:
        self.id = id_
        self._journals = Journals(lab.store)
        self._last = 0
        self._campaign: ReplayedCampaign | None = None
        self.refresh()

    @property
    def campaign(self) -> ReplayedCampaign:
        """The campaign as of the last `refresh`."""
        assert self._campaign is not None  # `refresh` set it in the beginning
        return self._campaign

    @property
    def described(self) -> CampaignFile:
        """Contents of the campaign's campaign.toml."""
        problems: list[Problem] = []
        described = read_campaign_file(self.campaign.description, problems)
        assert described is not None  # it was read before it was written down
        return described

    def unit(self, file: str, column: str) -> str:  # noqa: ARG002
        """Unit of the cells of a column if it differs from that of its name; never for entered cells."""
        return ""

    def attached_in_files(self, file: str, test: str) -> list[dict[str, str]]:  # noqa: ARG002
        """Rows of the campaign's attachments.csv about a test; never for entered campaigns."""
        return []

    def refresh(self) -> None:
        """Read the journal's entries since the last call and update the campaign."""
        new = self._written_since()
        if new or self._campaign is None:
            self._last = max((entry.sequence for entry in new), default=self._last)  # a sync can add older ones later
            self._campaign = replay_journal(new, before=self._campaign)

    def _written_since(self) -> tuple[JournalEntry, ...]:
        """Entries of the journal that are newer than the last one that this session read."""
        return self._journals.entries(self.id, after=self._last)

    def write_down(self, entry: NewEntry, *, seen: int) -> JournalEntry:
        """Append an entry and update the state; OvertakenError if one after `seen` is about the same test."""
        written = self._journals.append(self.id, entry, seen=seen)
        self.refresh()
        return written

    def test(self, file: str, name: str) -> ReplayedTest:
        """A test as of the last `refresh`; an empty one if it does not exist."""
        return self.campaign.test(file, name)

    def tests_of_site(self, site: str) -> list[ReplayedTest]:
        """All tests at a site, with its density samples and drop-cone tests."""
        return [test for test in self.campaign.tests.values() if test.rows and test.rows[0].cells.get("site") == site]

    def quick_results(self, site: str) -> QuickResults:
        """Quick results of a site, computed as an analysis of the exported folder would."""
        return quick_results(campaign_in_memory(self.campaign, of=self.tests_of_site(site)), site)

    def quick_verdicts(self, file: str) -> list[Message]:
        """Comparisons of the sites by H_V or S_f over the whole campaign; empty for other tables."""
        quantity = {PENETRATION.file: "H_V", SHEAR.file: "S_f"}.get(file)
        return quick_verdicts(self.whole_campaign(), quantity) if quantity else []

    def whole_campaign(self) -> Campaign:
        """The campaign as an analysis of the exported folder would read it."""
        return campaign_in_memory(self.campaign)


def quick_results(campaign: Campaign, site: str) -> QuickResults:
    """Quick results of one site of a campaign."""
    screened = screened_both(campaign, geometry="extended")
    results = experiment_results(campaign, screened=screened)
    experiments = {
        (form.file, row["experiment"]): row
        for kind, form in (("penetration", PENETRATION), ("shear", SHEAR))
        for row in results[kind]["experiments"]
        if row["site"] == site
    }
    curves = {
        (PENETRATION.file, curve.experiment): curve for curve in series_curves(campaign, experiment_hardness(campaign))
    }
    return QuickResults(
        experiments=experiments,
        curves={key: curve for key, curve in curves.items() if key in experiments},
        flags=_flag_sentences(quality_flags(campaign, screened=screened)),
    )


def _flag_sentences(problems: list[Problem]) -> dict[TestKey, dict[str, str]]:
    """Sentences about quality flags by test and code, with the value found and the action."""
    sentences: dict[TestKey, dict[str, str]] = {}
    for problem in problems:
        key, flag = (problem.file, problem.experiment or ""), QUALITY_FLAGS[problem.code].sentence
        sentence = joined([flag, problem.action])
        if problem.value is not None:
            sentence = Message(
                "{flag} Found: {value}; not flagged would be {allowed}. {action}",
                flag=flag, value=problem.value, allowed=problem.allowed, action=problem.action,
            )  # fmt: skip
        sentences.setdefault(key, {})[problem.code] = sentence
    return sentences


OWN_SHEET: Final = Message(
    "The corrections of this campaign are in a sheet of its workbook. Correct it there, and import the workbook again."
)


class CorrectionSession(EditSession):
    """Access of one page to an imported campaign and the journal of its corrections."""

    def __init__(self, lab: Lab, id_: str) -> None:
        self.stored, self._files = lab.store.contents(id_, READ_FILES)
        _, attached = lab.store.contents(id_, {ATTACHMENTS})
        self._attached = attached.get(ATTACHMENTS, b"")
        self._tables = unfold_workbooks(FilesInMemory(self._files))
        self._entries: tuple[JournalEntry, ...] = ()
        stored = stored_tables(self._tables)
        self.tables: dict[str, StoredTable] = {file: table for file, table in stored.items() if file in TABLES}
        super().__init__(lab, self.stored.id)

    @property
    def described(self) -> CampaignFile:
        """Contents of campaign.toml, or of the sheets in its place; a FieldDataError or StoreError if unreadable."""
        problems: list[Problem] = []
        try:
            text = decode(self._tables.read(CAMPAIGN_FILE) or b"").text
        except (FileNotFoundError, UnreadableTextError) as error:
            raise StoreError("{file} of this campaign cannot be read, so nothing in it can be.").tag(
                "cannot_read", file=CAMPAIGN_FILE
            ) from error
        described = read_campaign_file(text, problems)
        if described is None:
            raise FieldDataError(problems)
        return described

    def _written_since(self) -> tuple[JournalEntry, ...]:
        """Corrections that are newer than the last one read; also adds them to the session's entries."""
        new = self._journals.corrections(self.id, after=self._last)
        self._entries += new
        return new

    def test(self, file: str, name: str) -> ReplayedTest:
        """A test with its current cells by line and column."""
        corrected = self.campaign.test(file, name)
        if corrected.rows or name not in self.tables[file].tests:
            return corrected
        entry = JournalEntry(action="add", file=file, test=name, cells=self.file_cells(file, name), sequence=0, at="")
        return ReplayedTest(file, name, rows=[Reading(entry)])

    def unit(self, file: str, column: str) -> str:
        """Unit of the cells of a column if it differs from that of its name, otherwise ""."""
        conversion = self.tables[file].conversions.get(column)
        return conversion.name if conversion is not None else ""

    def attached_in_files(self, file: str, test: str) -> list[dict[str, str]]:
        """Rows of the campaign's attachments.csv about a test."""
        return rows_of_file(self._attached, file, test)

    def file_cells(self, file: str, name: str) -> dict[str, str]:
        """Cells of a test as in the files, without corrections."""
        rows = self.tables[file].tests.get(name, {}) if file in self.tables else {}  # none of a photo
        return {cell_key(line, column): text for line, cells in rows.items() for column, text in cells.items()}

    def write_down(self, entry: NewEntry, *, seen: int) -> JournalEntry:
        """Store an entry as `Journals.correct` does; StoreError if the corrections are in a sheet of the workbook."""
        if CORRECTIONS.file in self._tables.places and entry.file != ATTACHMENTS:
            raise StoreError(OWN_SHEET).tag("in_a_workbook")
        standing = self.file_cells(entry.file, entry.test)
        written = self._journals.correct(self.id, entry, seen=seen, standing=standing)
        self.refresh()
        return written

    def quick_results(self, site: str) -> QuickResults:
        """Quick results of a site, computed as an analysis of the exported folder would."""
        return quick_results(self.whole_campaign(), site)

    def whole_campaign(self) -> Campaign:
        """The campaign as an analysis of the exported folder would read it."""
        return campaign_of_files(corrected_files(self._files, self._entries))
