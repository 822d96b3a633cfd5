"""``skisnow serve``: the web lab, on this machine."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from .._support.errors import ParameterError
from .options import add_scheduler, checked_scheduler, whole_number


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the program's."""
    parser = commands.add_parser(
        "serve",
        help="open the web lab: enter a campaign, look at it, play with the turn",
        description="Serve the web lab. The first line printed is its address; Ctrl-C ends it. No network is used. "
        "With --host 0.0.0.0 phones in the same network can open it: addresses and a code for the camera are printed.",
    )
    parser.add_argument("--host", default="127.0.0.1", help="address to listen on (default: only this machine)")
    parser.add_argument(
        "--port", type=whole_number(0, 65_535), default=8765, help="port, 0 for a free one (default: 8765)"
    )
    parser.add_argument("--token", help="password of the pages; required with any other host")
    parser.add_argument(
        "--certificate",
        type=Path,
        metavar="FILE",
        help="PEM file with a certificate and its private key: pages and token are then encrypted on their way",
    )
    parser.add_argument("--certificate-key", type=Path, metavar="FILE", help="PEM file of the key, where it is another")
    parser.add_argument(
        "--store",
        metavar="PATH",
        help="file of the store, or postgresql://USER@HOST/DATABASE (default: the user's own file)",
    )
    add_scheduler(parser)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Serve until interrupted; 1 where the web lab is not installed."""
    try:
        from ..web.server import Certificate, require_allowed, serve
    except ModuleNotFoundError as missing:
        if missing.name is None or missing.name.split(".")[0] == "skisnow":
            raise
        text = f"skisnow: the web lab needs {missing.name}; install it with: pip install 'skisnow[web]'"
        print(text, file=sys.stderr)
        return 1
    from ..campaign.store import ServerAddress, Store, default_path, store_place
    from ..web.settings import Lab

    require_allowed(options.host, options.token)
    if options.certificate is None and options.certificate_key is not None:
        raise ParameterError("--certificate-key goes with --certificate", code="contradiction")
    certificate = None if options.certificate is None else Certificate(options.certificate, options.certificate_key)
    scheduler = checked_scheduler(options.scheduler)
    place = store_place(options.store) if options.store is not None else default_path()
    beside = default_path() if isinstance(place, ServerAddress) else place  # runs stay here
    with Store.open(place) as store:
        serve(
            Lab(store, beside.parent / "lab", scheduler=scheduler),
            host=options.host,
            port=options.port,
            token=options.token,
            tell=_printed,
            certificate=certificate,
        )
    return 0


def _printed(address: str) -> None:
    print(address, flush=True)
