"""The option ``--scheduler``: who computes in place of processes of this computer."""

from __future__ import annotations

import argparse
import sys

LOCAL = ("processes", "threads")


def add_scheduler(parser: argparse.ArgumentParser) -> None:
    """Add the option to a command's."""
    about = "who computes: processes (left out) or threads of this computer, or the workers of a Dask scheduler"
    parser.add_argument("--scheduler", metavar="WORD|URL|FILE.toml", help=about)


def scheduler_of(options: argparse.Namespace) -> str | None:
    """Who computes, refused where nothing can come of it; that a network must be trusted is said.

    Raises
    ------
    ParameterError
        It is no scheduler, its file cannot be read, or Dask is not installed.
    """
    asked: str | None = options.scheduler
    if asked is not None and asked not in LOCAL and options.workers is not None:
        from .._support.errors import ParameterError

        raise ParameterError(
            "--workers counts processes of this computer; a scheduler has its own. Leave one of them out"
        )
    return checked_scheduler(asked)


def checked_scheduler(asked: str | None) -> str | None:
    """The same of what was given to the option.

    Raises
    ------
    ParameterError
        As of `scheduler_of`.
    """
    if asked is None or asked in LOCAL:
        return asked
    from .._support.processes.dask_cluster import is_plain, require_scheduler

    require_scheduler(asked)
    if is_plain(asked):
        told = "what is sent to the workers is not encrypted, and whoever reaches it can run programs on them"
        print(f"{asked}: {told}: for trusted networks alone. tls:// with certificates is for others.", file=sys.stderr)
    return asked
