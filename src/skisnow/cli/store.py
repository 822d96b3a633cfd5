"""``skisnow store``: keep campaigns byte for byte, and give them back."""

from __future__ import annotations

import argparse
import json
import sys
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from .._support.errors import StoreError
from .output import Progress

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from ..campaign.store import JournalHead, Side, Store, StoredCampaign, StorePlace

Json: TypeAlias = dict[str, object]
Answer: TypeAlias = tuple[Json, str, int]
"""What is printed with ``--json``, what is printed without, and the exit code."""


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``store`` and its actions to the command line."""
    every = argparse.ArgumentParser(add_help=False)
    place: dict[str, Any] = {
        "metavar": "PATH",
        "help": "file of the store, or postgresql://USER@HOST/DATABASE (default: the user's own file)",
    }
    alone: dict[str, Any] = {"action": "store_true", "help": "print JSON alone to standard output"}
    every.add_argument("--store", default=argparse.SUPPRESS, **place)  # an option before the action stays
    every.add_argument("--json", default=argparse.SUPPRESS, **alone)
    about = "Keep campaigns byte for byte, and give them back."
    parser = subparsers.add_parser("store", help="keep campaigns byte for byte", description=about)
    parser.add_argument("--store", **place)
    parser.add_argument("--json", **alone)
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    add = actions.add_parser("add", parents=[every], help="keep all files of a campaign's folder")
    add.add_argument("folder", type=Path, metavar="DIR", help="the campaign's folder")
    actions.add_parser("list", parents=[every], help="list the campaigns: stored files and lab entries")
    show = actions.add_parser("show", parents=[every], help="list the files of a campaign")
    export = actions.add_parser(
        "export", parents=[every], help="write a campaign as a folder, with the corrections made in the lab"
    )
    for with_id in (show, export):
        with_id.add_argument("id", metavar="ID", help="the campaign's id, or its first 4 digits or more")
    export.add_argument("--out", type=Path, metavar="DIR", required=True, help="folder to make")
    export.add_argument(
        "--as-added", action="store_true", help="write the stored files only, without corrections made in the lab"
    )
    actions.add_parser("verify", parents=[every], help="check every file in the store; exit code 1 if any is damaged")
    _add_sync(actions.add_parser, every)
    parser.set_defaults(run=run)


def _add_sync(add_parser: Callable[..., argparse.ArgumentParser], every: argparse.ArgumentParser) -> None:
    """Add the subcommand ``sync``."""
    syncing = add_parser(
        "sync",
        parents=[every],
        help="bring this store and the group's what each lacks; exit code 1 if conflicts are open",
    )
    syncing.add_argument(
        "group",
        metavar="URL",
        help="the group's store: postgresql://USER@HOST/DATABASE, or a file that is carried about",
    )
    syncing.add_argument(
        "--keep",
        action="append",
        type=_parse_choice,
        metavar="ID=SIDE",
        default=[],
        help="settle the conflict with this id, or all: here, there or both; what is not kept stays in the history",
    )
    syncing.add_argument("--who", default="", metavar="NAME", help="whose choice it is")


def run(args: argparse.Namespace) -> int:
    """Run an action on the store and print its result; returns 1 after damage, or open conflicts of sync, else 0."""
    from ..campaign.store import Store

    act = {"add": _add, "list": _list, "show": _show, "export": _export, "verify": _verify, "sync": _sync}
    with Store.open(args.store, create=args.action in ("add", "sync")) as store:
        answer, text, code = act[args.action](store, args)
    print(json.dumps(answer, indent=2, allow_nan=False) if args.json else text)
    return code


def _add(store: Store, args: argparse.Namespace) -> Answer:
    """Add a campaign's folder to the store; JSON, text and exit status."""
    with _percent_printed("keeping") as progress:
        added = store.add(args.folder, progress=progress)
    if added.check_failure is not None:
        print(f"The campaign is kept but could not be checked: {added.check_failure}", file=sys.stderr)
    did = "was in the store already" if added.already_stored else "is kept"
    text = f"{added.id}  {added.name}: {_size_text(added.n_files, added.n_bytes)}, {did}"
    if added.n_repaired:
        text += f"; damaged files made whole: {added.n_repaired}"
    if added.n_errors is not None:
        text += f"\nchecked: errors {added.n_errors}, warnings {added.n_warnings}"
        text += " (`skisnow check` lists them)" if added.n_errors or added.n_warnings else ""
    about = (*_JSON_NAMES, "already_stored", "n_repaired", "check_failure")
    return {name: getattr(added, name) for name in about}, text, 0


def _list(store: Store, _: argparse.Namespace) -> Answer:
    """List stored campaigns and those in entry; JSON, text and exit status."""
    from ..campaign.store import Journals

    stored, entered = store.list(), Journals(store).list()
    lines = [*map(_campaign_line, stored), *map(_entered_line, entered)] or ["The store holds no campaign."]
    answer: Json = {"campaigns": list(map(_as_json, stored)), "lab_campaigns": list(map(asdict, entered))}
    return answer, "\n".join(lines), 0


def _show(store: Store, args: argparse.Namespace) -> Answer:
    """Show a campaign and its files; JSON, text and exit status."""
    from ..campaign.store import JournalHead, entered_files, find_campaign

    campaign = find_campaign(store, args.id)
    if isinstance(campaign, JournalHead):
        first, as_json, files = _entered_line(campaign), asdict(campaign), entered_files(store, campaign.id)
    else:
        first, as_json, files = _campaign_line(campaign), _as_json(campaign), campaign.files
    lines = [first, *(f"{file.sha256}  {file.size:>12}  {file.path}" for file in files)]
    return {**as_json, "files": list(map(asdict, files))}, "\n".join(lines), 0


def _export(store: Store, args: argparse.Namespace) -> Answer:
    """Export a campaign with its corrections; with --as-added without them. JSON, text and exit status."""
    from ..campaign.store import ExportedCampaign, JournalHead, export_corrected, export_entered, find_campaign

    campaign = find_campaign(store, args.id)
    if isinstance(campaign, JournalHead):
        if args.as_added:
            raise StoreError("The campaign {id} consists of lab entries and has no stored files. Omit --as-added.").tag(
                "no_data", id=campaign.id
            )
        export_entered(store, campaign.id, args.out)
        text = f"{_entered_line(campaign)}, written to {args.out}"
        return {**asdict(campaign), "out": str(args.out)}, text, 0
    with _percent_printed("exporting") as progress:
        if args.as_added:
            exported = ExportedCampaign(store.export(args.id, args.out, progress=progress), 0)
        else:
            exported = export_corrected(store, args.id, args.out, progress=progress)
    stored, n = exported.stored, exported.n_corrections
    text = f"{stored.id}  {stored.name}: {_size_text(stored.n_files, stored.n_bytes)}, exported to {args.out}"
    text += f"\ncells corrected since, in corrections.csv: {n}" if n else ""
    return {**_as_json(stored), "n_corrections": n, "out": str(args.out)}, text, 0


def _verify(store: Store, _: argparse.Namespace) -> Answer:
    """Verify the store; JSON, text and exit status, which is 1 with a finding."""
    with _percent_printed("verifying") as progress:
        findings = store.verify(progress=progress)
    lines = [str(finding) for finding in findings] or ["All is sound."]
    return {"findings": [asdict(finding) for finding in findings]}, "\n".join(lines), 1 if findings else 0


def _sync(store: Store, args: argparse.Namespace) -> Answer:
    """Synchronise with the group's store; JSON, text and exit status, which is 1 with open conflicts or problems."""
    from ..campaign.store import Store, sync

    with Store.open(_group_place(args.group)) as group, _percent_printed("synchronising") as progress:
        done = sync(store, group, keep=dict(args.keep), who=args.who, progress=progress)
    lines = [
        f"given: {_counts_text(done.n_campaigns_given, done.n_entries_given)}; "
        f"taken: {_counts_text(done.n_campaigns_taken, done.n_entries_taken)}",
        *([f"conflicts settled: {done.n_settled}"] if done.n_settled else []),
        *(f"left where it is: {problem}" for problem in done.problems),
    ]
    for conflict in done.conflicts:
        choices = " or ".join(f"--keep {conflict.id}={side}" for side in conflict.choices)
        lines += ["", f"not carried over: {conflict}", f"    choose with {choices}"]
    return asdict(done), "\n".join(lines), 1 if done.conflicts or done.problems else 0


def _group_place(word: str) -> StorePlace:
    """Place of the group's store from an option; an error for a file in a folder that does not exist."""
    from ..campaign.store import store_place

    place = store_place(word)
    if isinstance(place, Path) and not place.parent.is_dir():
        raise StoreError("{parent} is not there; is the disk or stick with the group's store plugged in?").tag(
            "wrong_kind", parent=place.parent
        )
    return place


def _parse_choice(text: str) -> tuple[str, Side]:
    """Conflict (or "all") and side of --keep; an argparse error for another form."""
    id_, _, side = text.partition("=")
    if not id_ or side not in ("here", "there", "both"):
        raise argparse.ArgumentTypeError(f"{text!r} is not ID=here, ID=there or ID=both")
    return id_, side  # type: ignore[return-value]


def _counts_text(n_campaigns: int, n_entries: int) -> str:
    """Text with the numbers of stored campaigns and entries."""
    campaigns = f"{n_campaigns} stored campaign{'' if n_campaigns == 1 else 's'}"
    return f"{campaigns}, {n_entries} entr{'y' if n_entries == 1 else 'ies'}"


_JSON_NAMES: Final = ("id", "name", "n_files", "n_bytes", "sha256", "n_errors", "n_warnings")


def _as_json(stored: StoredCampaign) -> Json:
    """Values of a stored campaign for JSON."""
    return {"added_at": stored.added_at.isoformat(), **{name: getattr(stored, name) for name in _JSON_NAMES}}


def _entered_line(head: JournalHead) -> str:
    """Line of a campaign in entry: id, begin (UTC), name, number of entries."""
    begun, n = f"{head.begun_at[:10]} {head.begun_at[11:16]}", head.n_entries
    return f"{head.id}  {begun} UTC  {head.name or '(no name)'}: {n} lab entr{'y' if n == 1 else 'ies'}"


def _campaign_line(stored: StoredCampaign) -> str:
    """Line of a stored campaign: id, time of adding (UTC), name, size, results of its check."""
    checked = "not checked" if stored.n_errors is None else f"errors {stored.n_errors}, warnings {stored.n_warnings}"
    amount = _size_text(stored.n_files, stored.n_bytes)
    return f"{stored.id}  {stored.added_at:%Y-%m-%d %H:%M} UTC  {stored.name}: {amount}, {checked}"


def _size_text(n_files: int, n_bytes: int) -> str:
    """Text with the numbers of files and bytes."""
    return f"{n_files} file{'' if n_files == 1 else 's'}, {n_bytes} bytes"


@contextmanager
def _percent_printed(doing: str) -> Iterator[Callable[[int, int], None]]:
    """Yield a callback with processed and total bytes that prints the percentage of the work `doing`."""
    with Progress() as progress:
        yield lambda done_bytes, total_bytes: progress(f"{doing}: {100 * done_bytes // max(total_bytes, 1)} %")
