"""What a new campaign's description says: its keys with units, a tool, a plate."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from ..reading.campaign_file import CAMPAIGN_KEYS
from .tables import GAUGE_RESOLUTION_MM, LOADS_N, PLATE, PLATE_LENGTH_MM, TEMPLATES, TOOL, TOOL_LENGTHS_MM

if TYPE_CHECKING:
    from ...parameters import Quantity

LENGTH_MM, WIDTH_MM = TOOL_LENGTHS_MM
GIVEN: Final[dict[str, str]] = {
    "place": "",
    "gauge_resolution_mm": f"{GAUGE_RESOLUTION_MM:g}",
    "load_steps_N": "; ".join(f"{load:g}" for load in LOADS_N),
}
"""Values that a new campaign begins with, as a cell holds them; the name is asked for."""


def keys_with_values(name: str) -> Iterator[tuple[str, str, Quantity]]:
    """Every key of one value or a list of numbers, with what a new campaign of this name begins with."""
    for key, quantity in CAMPAIGN_KEYS.items():
        yield key, name if key == "name" else GIVEN.get(key, ""), quantity


def campaign_toml(name: str) -> str:
    """The text of campaign.toml."""
    keys = "".join(_line(*each) for each in keys_with_values(name))
    tables = "".join(
        f"# {template.form.file}\n" + "".join(f"#   {column}: {words}\n" for column, words in template.explained())
        for template in TEMPLATES
    )
    return f"""\
# A campaign to be filled in: this file, and one row as an example in each table. Keys and columns carry their units.
# The status of the example rows keeps them out of every estimate; write over them or delete them.
{keys}
# Tables that have other headings: say which column each stands for (skisnow check proposes it)
# columns."Kantwinkel [°]" = "edge_angle_deg"

[[tool]]
name = "{TOOL}"
shape = "ski"       # or "disc" with diameter_mm, or "cylinder" with radius_mm and width_mm
length_mm = {LENGTH_MM:g}
width_mm = {WIDTH_MM:g}

[[plate]]
name = "{PLATE}"
length_mm = {PLATE_LENGTH_MM:g}

{tables}"""


def _line(key: str, cell: str, quantity: Quantity) -> str:
    about = f"# {quantity.meaning}{f' ({quantity.unit})' if quantity.unit else ''}\n"
    if quantity.kind == "text":
        return f'{about}{key} = "{cell}"\n'
    if quantity.kind == "numbers":
        return f"{about}{key} = [{cell.replace(';', ',')}]\n"
    return f"{about}{key} = {cell}\n" if cell else f"{about}# {key} =\n"
