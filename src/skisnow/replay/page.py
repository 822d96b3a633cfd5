"""Replay as one self-contained HTML file with scripts, styles and data."""

from __future__ import annotations

import base64
import re
from dataclasses import replace
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any, Final

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from .._support.errors import ParameterError, require_language
from .._support.messages import ENGLISH, translated, translations
from .._support.staging import write_file
from ..simulation.run import Run
from .binary import replay_bytes
from .from_run import replay_of_run
from .replay import Replay
from .run_file import replay_of_file

MODULES: Final = (
    "words.js", "three.core.min.js", "three.module.min.js", "binary.js", "motion.js", "colours.js", "snow_tile.js",
    "quads.js",
    "snow.js", "grid.js", "relief.js", "groove.js", "sledge.js", "skier.js", "skis.js", "labels.js", "landmarks.js",
    "force_arrows.js", "plume.js", "cameras.js", "sharpness.js", "controls.js", "mini_map.js", "takeaway.js",
    "gap.js",
    "stage.js", "replay.js",
)  # fmt: skip
"""Scripts, each one before those that import it."""
STYLE: Final = "replay.css"
_PACKAGE: Final = "skisnow.replay"
_ENDS_A_SCRIPT: Final = ("</script", "<!--")
_SAID: Final = re.compile(r'\bsaid\("([^"]+)"')
"""Pattern of a translated text in a script."""


def write_replay(
    run: Run | Replay | str | Path,
    path: str | Path,
    *,
    ghost: Run | Replay | str | Path | None = None,
    title: str | None = None,
    language: str = ENGLISH,
) -> Path:
    """Write a replay as one HTML file that opens without a server and without network.

    run: a run, its replay, or its folder or file.
    path: path of the HTML file; an existing file is replaced.
    ghost: second run, shown translucent at the same times.
    title: title for the reader (default: the folder's name, or "A simulated run").
    language: language of the page (en, de).
    Returns: path of the file.
    Raises ParameterError: a folder has no run that can be shown, or the language is unknown.
    Raises OutputError: the file cannot be written.
    """
    require_language(language)
    shown = _make_replay(run, title)
    write_file(path, replay_page(shown, None if ghost is None else _make_replay(ghost), language=language))
    return Path(path)


def _make_replay(run: Run | Replay | str | Path, title: str | None = None) -> Replay:
    if isinstance(run, Replay):
        if title is not None:
            raise ParameterError("a replay has its own title: give it to replay_of_run or replay_of_file").tag(
                "not_together"
            )
        return run
    if isinstance(run, Run):
        return replay_of_run(run) if title is None else replay_of_run(run, title=title)
    return replay_of_file(run, title=title)


def replay_page(run: Replay, ghost: Replay | None = None, *, language: str = ENGLISH) -> str:
    """HTML of a replay in a language, with a second run if one is given."""
    environment = Environment(loader=PackageLoader(_PACKAGE, "static"), autoescape=True, undefined=StrictUndefined)
    named = {"run": run} if ghost is None else {"run": run, "ghost": ghost}
    content = {name: replay_bytes(in_language(replay, language)) for name, replay in named.items()}
    return environment.get_template("replay.html").render(
        title=run.title,
        language=language,
        said=translations(language).gettext,
        words=page_words(language),
        css=Markup(static_text(STYLE)),
        runs=[{"id": name, "base64": base64.b64encode(data).decode()} for name, data in content.items()],
        modules=[{"name": name, "text": _script_text(name)} for name in MODULES],
    )


@cache
def page_words(language: str) -> dict[str, str]:
    """Translated texts of the scripts by English text; empty for English."""
    if language == ENGLISH:
        return {}
    texts = {text for name in MODULES for text in _SAID.findall(static_text(name))}
    return {text: translations(language).gettext(text) for text in sorted(texts)}


def in_language(run: Replay, language: str) -> Replay:
    """Replay with the facts for the reader in a language."""
    facts = ((translated(name, language), translated(text, language)) for name, text in run.facts)
    return replace(run, facts=tuple(facts))


def static_text(name: str) -> str:
    """Text of a script or style sheet."""
    return files(_PACKAGE).joinpath("static", name).read_text(encoding="utf-8")


def _script_text(name: str) -> Any:
    text = static_text(name)
    if any(words in text for words in _ENDS_A_SCRIPT):
        raise RuntimeError(f"{name} cannot be put into a page: it has {' or '.join(_ENDS_A_SCRIPT)} in it")
    return Markup(text)
