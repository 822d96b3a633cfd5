"""Two tracks held against each other, as a few lines for a terminal."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

from .number_formatting import significant

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

TITLES: Final = {"nearest": "nearest place", "arc_length": "equal arc length", "time": "equal time"}
_NO_FRAME: Final = (
    "No distance is printed: the tracks are not in one frame, so that it would say nothing. For a track in latitude",
    "and longitude give --fall-line-azimuth-deg, the direction in which the slope falls, and --slope-angle-deg,",
    "or let --fit-offset start,heading find where the simulated track lies.",
)
_WORDS: Final = {"max": "largest", "mean": "mean", "rms": "rms"}


def compare_summary(found: Mapping[str, Any]) -> str:
    """The numbers with their definitions.

    Parameters
    ----------
    found
        What `skisnow.track.comparison_dict.comparison_dict` gives.
    """
    simulated, measured, exact = found["simulated"], found["measured"], found["known_to_m"]
    lines = [
        f"{simulated['name']} ({metres(simulated['length_m'], exact, 4)}) compared with {measured['name']} "
        f"({metres(measured['length_m'], exact, 4)}), {found['seen']}",
        "",
    ]
    if not found["in_one_frame"]:
        return "\n".join([*lines, *_NO_FRAME])
    for kind, title in TITLES.items():
        lines += [*_distances(title, found[kind], measured["length_m"], exact), ""]
    back = found["largest_from_simulated_m"]
    if back is not None:
        lines.append(
            f"The other way round, from the simulated track to the nearest place of the measured one: "
            f"maximum {metres(back, exact)}."
        )
    lines.append(f"{found['means']}.")
    if exact:
        lines.append(f"A place is known to {significant(exact, 1, style='plain')} m: no further digits are printed.")
    lines += _fitted(found)
    return "\n".join(lines)


def metres(value: float | None, exact: float, digits: int = 3) -> str:
    """A distance with the digits that places known to ``exact`` (m) have.

    >>> metres(2.345, 0.0), metres(2.345, 3.0), metres(0.4, 3.0), metres(41.987, 0.02, 4), metres(41.987, 0.3, 4)
    ('2.35 m', '2 m', 'below 1 m', '41.99 m', '42.0 m')
    """
    return f"{rounded(value, exact, digits)} m"


def rounded(value: float | None, exact: float, digits: int = 3) -> str:
    """A number with no digit below that of ``exact``, in its own unit; 0: with ``digits`` significant ones."""
    if value is None or exact <= 0.0 or not math.isfinite(value):
        return _plain(value, digits)
    decimals = -math.floor(math.log10(exact))
    if 0.0 < abs(value) < 0.5 * 10.0**-decimals:
        return f"below {10.0**-decimals:.{max(decimals, 0)}f}"
    fewest = digits - 1 - math.floor(math.log10(abs(value))) if value else 0
    return f"{round(value, min(decimals, max(fewest, 0))):.{max(min(decimals, max(fewest, 0)), 0)}f}"


def _plain(value: float | None, digits: int = 3) -> str:
    return significant(value, digits, style="plain")


def _distances(title: str, found: Mapping[str, Any], length: float, exact: float) -> Iterator[str]:
    yield f"{title}: {found['definition']}"
    if found["max_m"] is None:
        yield f"  none: {found['reason']}"
        return
    for key, word in _WORDS.items():
        share = f"{rounded(100.0 * found[f'{key}_share'], 100.0 * exact / length, 2)} % of the measured track's length"
        where = f", {metres(found['max_at_m'], exact)} along it" if key == "max" else ""
        yield f"  {word:8}{metres(found[f'{key}_m'], exact)}, {share}{where}"
    share = _plain(100.0 * found["compared_share"], 4)
    yield f"  over    {metres(found['compared_m'], exact, 4)}, {share} % of the measured track"


def _fitted(found: Mapping[str, Any]) -> Iterator[str]:
    fitted = found["fitted"]
    if fitted is None:
        return
    yield ""
    yield f"Fitted: {', '.join(fitted['what'])}. The simulated track was moved as a whole before it was compared:"
    yield f"  {fitted_words(fitted)}"
    if fitted["undetermined"]:
        yield f"  {fitted['undetermined']} direction(s) these tracks do not tell; nothing was moved along them"
    for kind, title in TITLES.items():
        before, after = (_pair(each[kind], found["known_to_m"]) for each in (fitted["before"], found))
        yield f"  {title}: largest and mean {before} before, {after} after"


def fitted_words(fitted: Mapping[str, Any]) -> str:
    """By how much the simulated track was moved."""
    height = "" if fitted["moved_z_m"] is None else f", z {_plain(fitted['moved_z_m'])} m"
    return (
        f"start by x {_plain(fitted['moved_x_m'])} m, y {_plain(fitted['moved_y_m'])} m{height}; turned by "
        f"{_plain(fitted['turned_deg'])} degrees to the left; looked up {_plain(fitted['later_s'])} s later"
    )


def _pair(found: Mapping[str, Any], exact: float) -> str:
    largest, mean = (metres(found[key], exact) for key in ("max_m", "mean_m"))
    return f"both {mean}" if largest == mean else f"{largest} and {mean}"
