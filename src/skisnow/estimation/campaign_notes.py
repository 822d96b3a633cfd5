"""Notes on a campaign whose files are valid one by one: sites that nearly agree, sites without tests, unread files."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..campaign.records import Campaign


def campaign_notes(campaign: Campaign) -> tuple[str, ...]:
    """Sentences about site names that nearly agree, snow data of sites without tests, and files that were not read."""
    return (*_alike(campaign), *_without_tests(campaign), *_unread(campaign))


def _tested(campaign: Campaign) -> set[str]:
    return {site for tests in (campaign.penetration, campaign.shear) if tests is not None for site in tests.site}


def _described(campaign: Campaign) -> dict[str, set[str]]:
    tables = {
        "density.csv": campaign.density,
        "drop_cone.csv": campaign.drop_cone,
        "snow_micro_pen.csv": campaign.snow_micro_pen,
    }
    return {name: set(table.site) for name, table in tables.items() if table is not None}


def _alike(campaign: Campaign) -> Iterator[str]:
    """Names that differ by capitals and spaces alone."""
    names: dict[str, set[str]] = {}
    for site in _tested(campaign).union(*_described(campaign).values()):
        names.setdefault("".join(site.split()).casefold(), set()).add(site)
    for variants in sorted(sorted(variants) for variants in names.values() if len(variants) > 1):
        listed = ", ".join(repr(name) for name in variants)
        yield f"The sites {listed} differ by capitals or spaces alone; they count as different sites. Is one meant?"


def _without_tests(campaign: Campaign) -> Iterator[str]:
    tested = _tested(campaign)
    for name, sites in _described(campaign).items():
        lost = sorted(sites - tested)
        if lost:
            listed = ", ".join(repr(site) for site in lost)
            yield f"{name} describes {listed}, where no test was made: these rows are not included. Is a site misspelt?"


def _unread(campaign: Campaign) -> Iterator[str]:
    if campaign.unread_files:
        listed = ", ".join(campaign.unread_files)
        yield f"Not read, as no table of a campaign has this name: {listed}."
