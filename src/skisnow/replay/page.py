"""A replay as one HTML file that needs nothing else: program, picture and numbers are inside it."""

from __future__ import annotations

import base64
import re
from dataclasses import replace
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from .._support.errors import ParameterError
from .._support.language import ENGLISH, catalogue, require_language
from .._support.staging import write_file
from ..simulation.run import Run
from .binary import replay_bytes
from .from_run import replay_of_run
from .replay import Replay
from .run_file import replay_of_file

if TYPE_CHECKING:
    from .replay import ReplayTrack

MODULES: Final = (
    "words.js", "three.core.min.js", "three.module.min.js", "binary.js", "motion.js", "colours.js", "snow_tile.js",
    "quads.js",
    "snow.js", "grid.js", "relief.js", "groove.js", "sledge.js", "skier.js", "skis.js", "labels.js", "landmarks.js",
    "force_arrows.js", "plume.js", "cameras.js", "sharpness.js", "controls.js", "mini_map.js", "takeaway.js",
    "gap.js",
    "stage.js", "replay.js",
)  # fmt: skip
"""The program, each file before those that import it."""
STYLE: Final = "replay.css"
_PACKAGE: Final = "skisnow.replay"
_ENDS_A_SCRIPT: Final = ("</script", "<!--")
_SAID: Final = re.compile(r'\bsaid\("([^"]+)"')
"""A text in the program that is looked up."""


def write_replay(
    run: Run | Replay | str | Path,
    path: str | Path,
    *,
    ghost: Run | Replay | str | Path | None = None,
    title: str | None = None,
    track: ReplayTrack | None = None,
    language: str = ENGLISH,
) -> Path:
    """Write a replay as one HTML file that opens without a server and without network.

    Parameters
    ----------
    run
        A run, its replay, or the folder or file that it was written to.
    path
        Of the HTML file, which is replaced where it exists.
    ghost
        A second run, shown translucent over the first at the same times.
    title
        What the reader sees; left out: the folder's name, or "A simulated run".
    track
        A measured track in the run's axes, shown beside; not with a replay, which has its own.
    language
        Of the page: en, or a language that there is a catalogue of (de).

    Returns
    -------
    Path
        Of the file.

    Raises
    ------
    ParameterError
        A folder holds no run that can be shown, or there are no texts of the language.
    OutputError
        The file cannot be written.
    """
    require_language(language)
    shown = [_replay(run, title, track)]
    if ghost is not None:
        shown.append(_replay(ghost, None, None))
    write_file(path, replay_page(*shown, language=language))
    return Path(path)


def _replay(run: Run | Replay | str | Path, title: str | None, track: ReplayTrack | None) -> Replay:
    if isinstance(run, Replay):
        if track is not None or title is not None:
            raise ParameterError("a replay has its own title and track: give them to replay_of_run or replay_of_file")
        return run
    if isinstance(run, Run):
        return replay_of_run(run, track=track) if title is None else replay_of_run(run, title=title, track=track)
    return replay_of_file(run, title=title, track=track)


def replay_page(run: Replay, ghost: Replay | None = None, *, language: str = ENGLISH) -> str:
    """The HTML of a replay in a language, a second run over it where there is one."""
    environment = Environment(loader=PackageLoader(_PACKAGE, "static"), autoescape=True, undefined=StrictUndefined)
    named = {"run": run} if ghost is None else {"run": run, "ghost": ghost}
    content = {name: replay_bytes(in_language(each, language)) for name, each in named.items()}
    return environment.get_template("replay.html").render(
        title=run.title,
        language=language,
        said=catalogue(language).translated,
        words=page_words(language),
        css=Markup(static_text(STYLE)),
        runs=[{"id": name, "base64": base64.b64encode(each).decode()} for name, each in content.items()],
        modules=[{"name": name, "text": _module(name)} for name in MODULES],
    )


@cache
def page_words(language: str) -> dict[str, str]:
    """What the page says in a language, by the English texts of its program; nothing for English."""
    if language == ENGLISH:
        return {}
    texts = {text for name in MODULES for text in _SAID.findall(static_text(name))}
    return {text: catalogue(language).as_given(text) for text in sorted(texts)}


def in_language(run: Replay, language: str) -> Replay:
    """A replay whose lines for the reader are in a language."""
    words = catalogue(language)
    facts = ((words.translated(name), words.with_numbers(words.translated(text))) for name, text in run.facts)
    return replace(run, facts=tuple(facts))


def static_text(name: str) -> str:
    """A file of the program as text."""
    return files(_PACKAGE).joinpath("static", name).read_text(encoding="utf-8")


def _module(name: str) -> Any:
    text = static_text(name)
    if any(words in text for words in _ENDS_A_SCRIPT):
        raise RuntimeError(f"{name} cannot stand in a page: it has {' or '.join(_ENDS_A_SCRIPT)} in it")
    return Markup(text)
