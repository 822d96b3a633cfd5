"""Two tracks held against each other, as a few lines for a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from .number_formatting import significant

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

TITLES: Final = {"nearest": "nearest place", "arc_length": "equal arc length", "time": "equal time"}
_WORDS: Final = {"max": "largest", "mean": "mean", "rms": "rms"}


def compare_summary(found: Mapping[str, Any]) -> str:
    """The numbers with their definitions.

    Parameters
    ----------
    found
        What `skisnow.track.comparison_dict.comparison_dict` gives.
    """
    simulated, measured = found["simulated"], found["measured"]
    lines = [
        f"{simulated['name']} ({_plain(simulated['length_m'], 4)} m) compared with {measured['name']} "
        f"({_plain(measured['length_m'], 4)} m), {found['seen']}",
        "",
    ]
    for kind, title in TITLES.items():
        lines += [*_distances(title, found[kind]), ""]
    back = found["largest_from_simulated_m"]
    if back is not None:
        lines.append(
            f"The other way round, from the simulated track to the nearest place of the measured one: "
            f"maximum {_plain(back)} m."
        )
    lines.append(f"{found['means']}.")
    lines += _fitted(found)
    return "\n".join(lines)


def _plain(value: float | None, digits: int = 3) -> str:
    return significant(value, digits, style="plain")


def _distances(title: str, found: Mapping[str, Any]) -> Iterator[str]:
    yield f"{title}: {found['definition']}"
    if found["max_m"] is None:
        yield f"  none: {found['reason']}"
        return
    for key, word in _WORDS.items():
        share = f"{_plain(100.0 * found[f'{key}_share'], 2)} % of the measured track's length"
        where = f", {_plain(found['max_at_m'])} m along it" if key == "max" else ""
        yield f"  {word:8}{_plain(found[f'{key}_m'])} m, {share}{where}"
    yield (
        f"  over    {_plain(found['compared_m'], 4)} m, {_plain(100.0 * found['compared_share'], 4)} % of the measured "
        "track"
    )


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
        yield f"  {title}: largest and mean {_pair(fitted['before'][kind])} before, {_pair(found[kind])} after"


def fitted_words(fitted: Mapping[str, Any]) -> str:
    """By how much the simulated track was moved."""
    height = "" if fitted["moved_z_m"] is None else f", z {_plain(fitted['moved_z_m'])} m"
    return (
        f"start by x {_plain(fitted['moved_x_m'])} m, y {_plain(fitted['moved_y_m'])} m{height}; turned by "
        f"{_plain(fitted['turned_deg'])} degrees to the left; looked up {_plain(fitted['later_s'])} s later"
    )


def _pair(found: Mapping[str, Any]) -> str:
    return f"{_plain(found['max_m'])} m and {_plain(found['mean_m'])} m"
