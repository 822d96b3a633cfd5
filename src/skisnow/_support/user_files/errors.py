"""The error of a file that cannot be taken as it is."""

from __future__ import annotations

from ..errors import ParameterError


class GivenError(ParameterError):
    """A file, or a text in its stead, cannot be read.

    Parameters
    ----------
    what
        What is wrong and what is allowed, without the file.
    line
        Of the file, where one can be named.
    title
        The file, or what else the text is called by; empty until it is known.
    sentence
        The whole message, where it is not made of the others.
    """

    def __init__(self, what: str, *, line: int | None = None, title: str = "", sentence: str = "") -> None:
        place = ", ".join(part for part in (title, f"line {line}" if line else "") if part)
        super().__init__(sentence or (f"{place}: {what}" if place else what))
        self.what, self.line = what, line

    def of(self, title: str) -> GivenError:
        """The same of a file."""
        return GivenError(self.what, line=self.line, title=title)
