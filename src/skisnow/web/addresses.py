"""The addresses that a lab answers at, and how a phone gets there."""

from __future__ import annotations

import io
import ipaddress
from typing import TYPE_CHECKING, Final

import ifaddr
import segno

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

EVERY: Final = ("0.0.0.0", "::")
"""Hosts that stand for all addresses of this machine."""
IN_CLEAR: Final = (
    "What goes between the machines is not encrypted, the token neither: anybody in the same network can read it. Use "
    "a network of your own, such as this machine's hotspot, or give --certificate."
)
ENCRYPTED: Final = (
    "What goes between the machines is encrypted. A browser asks once whether it may trust a certificate of your own."
)


def lab_addresses(host: str, port: int, *, secure: bool, own: Iterable[str] | None = None) -> list[str]:
    """The addresses that others can open the lab at, those of home and office networks first.

    Parameters
    ----------
    host, port
        That it listens on.
    secure
        Whether it has a certificate.
    own
        Addresses of this machine; those of its adapters where they are not given.

    Examples
    --------
    >>> lab_addresses("0.0.0.0", 8765, secure=False, own=["127.0.0.1", "203.0.113.9", "192.168.1.7"])
    ['http://192.168.1.7:8765/', 'http://203.0.113.9:8765/']
    >>> lab_addresses("127.0.0.1", 80, secure=True)
    ['https://127.0.0.1:80/']
    """
    hosts = [host]
    if host in EVERY:
        known = _adapters(host) if own is None else own
        others = [each for each in known if not ipaddress.ip_address(each).is_loopback]
        hosts = sorted(others, key=lambda each: not ipaddress.ip_address(each).is_private) or ["127.0.0.1"]
    scheme = "https" if secure else "http"
    return [f"{scheme}://{f'[{each}]' if ':' in each else each}:{port}/" for each in hosts]


def _adapters(host: str) -> Iterator[str]:
    """Addresses of this machine, those that need no name of an adapter with them."""
    for adapter in ifaddr.get_adapters():
        for each in adapter.ips:
            if each.is_IPv4:
                yield str(each.ip)
            elif host == "::" and not ipaddress.ip_address(each.ip[0]).is_link_local:
                yield each.ip[0]


def for_others(addresses: list[str], *, secure: bool) -> Iterator[str]:
    """Lines for whoever carries a phone: further addresses, a code for its camera, what is encrypted."""
    yield from (f"also: {address}" for address in addresses[1:])
    drawn = io.StringIO()
    segno.make(addresses[0], error="m").terminal(drawn, compact=True, border=2)
    yield drawn.getvalue().rstrip()
    yield f"With a phone in the same network: point its camera at the code, or open {addresses[0]}"
    yield ENCRYPTED if secure else IN_CLEAR
