"""The link from a run's report to its replay, where the replay was written later."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

from .._support.errors import OutputError
from .._support.language import ENGLISH, codes
from .._support.staging import write_file
from .._support.user_files import GivenError, plain_text
from .run_report import REPLAY, REPLAY_FACT
from .translated import translated_html

MOST_BYTES: Final = 1 << 26

PAGE: Final = "report.html"
_FACTS: Final = re.compile(r'(<dl class="facts">\n(?:<dt>.*</dd>\n)*)(</dl>)')
_LANGUAGE: Final = re.compile(r'<html lang="([a-z]+)">')


def link_replay(folder: str | Path) -> Path | None:
    """Put the link to replay.html among the facts of a run's report that lies beside it.

    The page is replaced in one piece; all else in it stays as it is, and one that has the link already is not touched.

    Parameters
    ----------
    folder
        Of the run.

    Returns
    -------
    Path or None
        Of the page that was changed; None where there is no report, or none that a run left, or the link is there.

    Raises
    ------
    OutputError
        The page cannot be read or written.
    """
    path = Path(folder) / PAGE
    if not path.is_file():
        return None
    try:
        page = plain_text(path, most_bytes=MOST_BYTES)
    except GivenError as error:
        raise OutputError(f"{path} cannot be read: {error}. The replay is written; the report has no link") from error
    linked = with_link(page)
    if linked == page:
        return None
    write_file(path, linked)
    return path


def with_link(page: str) -> str:
    r"""The page with the link, in its own language; the same page where that is no report of a run, or has the link.

    Examples
    --------
    >>> page = '<html lang="de">\n<p>skisnow</p><dl class="facts">\n<dt>Schnee</dt><dd>S</dd>\n</dl>\n'
    >>> print(with_link(page + '<h2 id="scenario">1</h2>'))
    <html lang="de">
    <p>skisnow</p><dl class="facts">
    <dt>Schnee</dt><dd>S</dd>
    <dt>Replay</dt><dd><a href="replay.html">der Lauf in drei Dimensionen</a></dd>
    </dl>
    <h2 id="scenario">1</h2>
    """
    said = _LANGUAGE.search(page)
    language = said[1] if said and said[1] in codes() else ENGLISH
    if f'href="{REPLAY}"' in page or "skisnow" not in page or 'id="scenario"' not in page:
        return page
    fact = translated_html(REPLAY_FACT, language)
    return _FACTS.sub(lambda found: f"{found[1]}{fact}\n{found[2]}", page, count=1)
