"""Files of users: plain bytes, TOML, JSON and workbooks, each within limits, every refusal in words.

All TOML and JSON of users is read here and nowhere else: campaigns, scenarios, skis, studies, results, design files.
"""

from .json_text import MOST_JSON_BYTES, json_value, own_json, read_json, read_record
from .text_files import (
    MOST_TOML_BYTES,
    ContentError,
    is_file,
    natural_number,
    plain_bytes,
    plain_text,
    read_toml,
    shown_value,
    toml_text,
    toml_values,
)
from .workbook import workbook_sheets
from .xml_elements import Element, xml_tree

__all__ = [
    "MOST_JSON_BYTES",
    "MOST_TOML_BYTES",
    "ContentError",
    "Element",
    "is_file",
    "json_value",
    "natural_number",
    "own_json",
    "plain_bytes",
    "plain_text",
    "read_json",
    "read_record",
    "read_toml",
    "shown_value",
    "toml_text",
    "toml_values",
    "workbook_sheets",
    "xml_tree",
]
