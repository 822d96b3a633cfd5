"""Jinja environment of the pages of reports in a language."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from .._support.messages import Message, translated, translations

if TYPE_CHECKING:
    from collections.abc import Callable


def page_environment(language: str, *, package: str = "skisnow.report", folder: str = "templates") -> Environment:
    """Environment whose pages have ``{% trans %}``; ``{{ message }}`` and ``{{ value | text }}`` are translated."""

    def text(value: object) -> str:
        return translated(value, language)

    environment = Environment(
        loader=PackageLoader(package, folder), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        extensions=["jinja2.ext.i18n"], finalize=_finalize(text),
    )  # fmt: skip
    environment.policies["ext.i18n.trimmed"] = True
    environment.filters["text"] = text
    install: Callable[..., None] = environment.install_gettext_translations  # type: ignore[attr-defined]
    install(translations(language), newstyle=True)
    return environment


def _finalize(text: Callable[[object], str]) -> Callable[[Any], Any]:
    return lambda value: text(value) if isinstance(value, Message) else value
