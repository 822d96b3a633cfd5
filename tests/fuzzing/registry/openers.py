"""The functions of skisnow that open files, found in its source, and those among them that read no file of a user."""

import ast
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Final

import skisnow

_ROOT: Final = Path(skisnow.__file__).parent
_FUNCTIONS: Final = frozenset({
    "plain_bytes", "plain_text", "read_toml", "read_json", "read_record", "csv_rows", "netcdf_file", "connect", "open",
    "load_certificate", "memmap", "loadtxt", "genfromtxt",
})  # fmt: skip
"""Functions."""
_METHODS: Final = frozenset({
    "read_bytes", "read_text", "ZipFile", "ParquetFile", "load_cert_chain", "load_verify_locations", "open", "memmap",
    "loadtxt", "genfromtxt", "fromfile", "load_workbook",
})  # fmt: skip
"""Methods, and functions of modules."""
_NAMES: Final = tuple(f"{name}(" for name in _FUNCTIONS | _METHODS)
_WRITING: Final = frozenset("wxa+")

NO_READERS: Final[Mapping[str, str]] = {
    "compiled.sources:fingerprint": "sources of the core beside the package",
    "scenario.reading:scenario_text": "package data",
    "cli.shell:json_schema": "package data",
    "samples:run_samples": "package data",
    "samples:_contents": "sample files that the program has just made",
    "cli.beginning:write_samples": "sample files that the program has just made",
    "_support.messages:translations": "package data",
    "replay.page:static_text": "package data",
    "report.sheet:render_template": "package data",
    "interop.fmu:_write_fmu": "the library of the package",
    "interop.fmu:_licence": "package data",
    "identification.data:fingerprint": "bytes for a SHA-256",
    "identification.result:identification_dict": "bytes for a SHA-256",
    "identification.data:_require_different": "bytes for a SHA-256",
    "simulation.run_summary:_provenance_json": "bytes for a SHA-256",
    "studies.study:Study.fingerprint": "bytes for a SHA-256",
    "campaign.importing.answers:save_template": "the template that it would overwrite, to compare",
    "campaign.importing.folder:_sha256": "bytes for a SHA-256",
    "campaign.importing.folder:undo_import": "hashes that the import has written; none leads out of the folder",
    "campaign.store.folder:read_chunks": "bytes for the store, whatever they say",
    "campaign.store.export:_add_later_files": "a file of the campaign that it has just exported",
    "campaign.store.engine:_find_damage": "a store that is known to be damaged, for the integrity check",
    "web.lab_skis:LabSkis.texts": "the text of a ski, shown in a field",
    "web.lab_skis:texts_of_ski": "the file that it has just written",
    "web.transfer:FileImports.name": "the name that it has just written",
    "web.transfer:FileImports.content": "bytes for cli.campaign:_ask_questions's reader",
    "web.uploads:files_below": "bytes for a download",
    "web.pages.replay:_outcome_words": "summary.json, by read_record as web.runs:Runs._over",
    "report.summaries:_slope_angle_from_summary": "summary.json of a run, by read_json as other records",
    "web.replay_addresses:add_addresses.first": "package data",
    "web.replay_addresses:RunFolders.title": "job of a run, by read_record as web.runs:Runs._over",
    "web.server:Certificate.__post_init__": "a certificate, parsed by OpenSSL",
    "_support.environment:load_certificate": "a certificate, parsed by OpenSSL",
    "cli.replay:serve_lab": "opens the store as campaign.store.store:Store.open",
    "cli.store:run": "opens the store as campaign.store.store:Store.open",
    "cli.store:_sync": "opens the store as campaign.store.store:Store.open",
}
"""Why a function needs no reader in the registry."""


def openers() -> set[str]:
    """Functions of skisnow that open a file for reading, as ``module:qualified.name``."""
    found: set[str] = set()
    for path in sorted(_ROOT.rglob("*.py")):
        module = ".".join(path.relative_to(_ROOT).with_suffix("").parts).removesuffix(".__init__")
        text = path.read_text(encoding="utf-8")
        if not module.startswith("_support.user_files.") and any(name in text for name in _NAMES):  # all others use it
            found.update(f"{module}:{name}" for name in _opening(ast.parse(text), ()))
    return found


def _opening(node: ast.AST, outer: tuple[str, ...]) -> Iterator[str]:
    for child in ast.iter_child_nodes(node):
        is_scope = isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef)
        inner = (*outer, child.name) if is_scope else outer  # type: ignore[attr-defined]
        if isinstance(child, ast.Call) and _opens(child):
            yield ".".join(inner)
        yield from _opening(child, inner)


def _opens(call: ast.Call) -> bool:
    words = {each.value for each in call.args if isinstance(each, ast.Constant) and isinstance(each.value, str)}
    if any(set(word) & _WRITING and set(word) <= set("rwxabt+") for word in words):
        return False
    if isinstance(call.func, ast.Name):
        return call.func.id in _FUNCTIONS
    text = ast.unparse(call.func)
    return text == "sqlite3.connect" or (text.rpartition(".")[2] in _METHODS and not text.startswith("os."))
