"""Citations of the program, its papers and a campaign, as text and as BibTeX; the same as in CITATION.cff."""

from __future__ import annotations

from importlib.metadata import version
from typing import TYPE_CHECKING, Any, Final

from .symbols import latex_escaped

if TYPE_CHECKING:
    from collections.abc import Mapping

CITED: Final = (
    "The skisnow developers, skisnow {version}; Mössner, Innerhofer, Schindelwig, Kaps, Schretter, Nachbauer (2013), "
    "Measurement of mechanical properties of snow for simulation of skiing, Journal of Glaciology; Mössner, Heinrich, "
    "Schindelwig, Kaps, Schretter, Nachbauer (2013), Modeling the ski-snow contact in skiing turns using a hypoplastic "
    "vs an elastic force-penetration relation, Scandinavian Journal of Medicine & Science in Sports, "
    "doi 10.1111/sms.12035."
)
"""Citations on a page: the program and the papers of its methods."""
_BIBTEX: Final = """\
@software{{skisnow,
  author = {{{{The skisnow developers}}}},
  title = {{skisnow}},
  version = {{{version}}}
}}
@article{{moessner2013measurement,
  author = {{Mössner, Martin and Innerhofer, Gerhard and Schindelwig, Kurt and Kaps, Peter and Schretter, Herwig and Nachbauer, Werner}},
  title = {{Measurement of mechanical properties of snow for simulation of skiing}},
  journal = {{Journal of Glaciology}},
  year = {{2013}}
}}
@article{{moessner2013modeling,
  author = {{Mössner, Martin and Heinrich, Dieter and Schindelwig, Kurt and Kaps, Peter and Schretter, Herwig and Nachbauer, Werner}},
  title = {{Modeling the ski-snow contact in skiing turns using a hypoplastic vs an elastic force-penetration relation}},
  journal = {{Scandinavian Journal of Medicine \\& Science in Sports}},
  year = {{2013}},
  doi = {{10.1111/sms.12035}}
}}
"""  # noqa: E501
_CAMPAIGN: Final = """\
@misc{{campaign,
  author = {{{authors}}},
  title = {{{title}}},
  howpublished = {{Field campaign{place}}}{files}
}}
"""


def cited_text() -> str:
    """Citations of the program and its papers in a sentence."""
    return CITED.format(version=version("skisnow"))


def bibtex(campaign: Mapping[str, Any] | None = None) -> str:
    """BibTeX of the program and its papers, and of a campaign with the SHA-256 of its files.

    Parameters
    ----------
    campaign
        ``campaign`` of results.json.
    """
    own = _BIBTEX.format(version=version("skisnow"))
    if campaign is None:
        return own
    observers = " and ".join(f"{{{latex_escaped(name)}}}" for name in campaign["observers"]) or "{not stated}"
    hashes = campaign.get("files", {})
    listed = ", ".join(f"{latex_escaped(name)} SHA-256 {digest}" for name, digest in hashes.items())
    files = f",\n  note = {{{listed}}}" if listed else ""
    place = f", {latex_escaped(campaign['place'])}" if campaign["place"] else ""
    return own + _CAMPAIGN.format(authors=observers, title=latex_escaped(campaign["name"]), place=place, files=files)
