"""Cause of a skier's fall or of a missed gate: the first limit that was crossed in the seconds before."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from .._support.arrays import FloatArray
from .._support.messages import Message, template
from ..scenario.skier import Skier
from .balance import BalanceRecord

LOOKS_BACK: Final = 1.5
"""Time (s) before a fall or a missed gate in which its cause is looked for (modelling assumption)."""
LEAST_LOAD = 0.2
"""Body weights on both legs below which a load throws the skier off balance (modelling assumption)."""
GRIPS, EDGED = math.radians(1.0), math.radians(1.0)
"""Slip below which a ski that is to skid follows its edge, and edge from which it does (rad)."""
HELD: Final = 0.6
"""Share of the force that the plan asks for below which the snow does not hold (modelling assumption)."""
LASTS: Final = 0.05
"""Time (s) for which a limit is to be crossed."""

CAUSES: Final[dict[str, str]] = {
    "speed": template(
        "First cause, at {time:.2f} s and {way:.1f} m: speed. At {speed:.1f} m/s the turn asked for a lean beyond "
        "skier.greatest_lean_deg. Start more slowly, or set skier.brakes_to_m_per_s: the skier then skids to brake."
    ),
    "hips": template(
        "First cause, at {time:.2f} s and {way:.1f} m: hips. The skis resisted the pivot, and the body was turned "
        "against them beyond skier.greatest_hip_deg."
    ),
    "edge_lost": template(
        "First cause, at {time:.2f} s and {way:.1f} m: edge lost. The skis should have skidded, but followed their "
        "edges."
    ),
    "grip": template(
        "First cause, at {time:.2f} s and {way:.1f} m: grip. The snow held less than {share:.0%} of the force that "
        "balance asked for."
    ),
    "leg_force": template(
        "First cause, at {time:.2f} s and {way:.1f} m: leg force. The legs carried {weights:.1f} body weights."
    ),
}


@dataclass(frozen=True, slots=True)
class Cause:
    """First limit that was crossed before a fall or a missed gate.

    Attributes
    ----------
    code
        "speed", "hips", "edge_lost", "grip" or "leg_force".
    time, place
        When (s), and where the centre of mass was then: x, y (m).
    message
        In words.
    """

    code: str
    time: float
    place: tuple[float, float]
    message: Message


def cause_of(records: Sequence[BalanceRecord], skier: Skier, weight: float) -> Cause | None:
    """The earliest of the causes of `CAUSES` in the last seconds before a fall or a missed gate; None without one.

    Parameters
    ----------
    records
        The run until the fall or the gate.
    skier
        Its limits.
    weight
        Of the skier (N).
    """
    since = records[-1].seen.time - LOOKS_BACK if records else 0.0
    last = [each for each in records if each.balance is not None and each.seen.time >= since]
    if not last:
        return None
    time = np.array([each.seen.time for each in last])
    first: tuple[float, str, int] | None = None
    for code, crossed in _crossed(last, skier, weight).items():
        at = _first_lasting_crossing(time, crossed)
        if at is not None and (first is None or time[at] < first[0]):
            first = (float(time[at]), code, at)
    if first is None:
        return None
    seen = last[first[2]].seen
    message = Message(
        CAUSES[first[1]],
        time=seen.time,
        way=math.dist(seen.place, records[0].seen.place),
        speed=seen.speed,
        share=HELD,
        weights=seen.load / weight,
    )
    return Cause(first[1], seen.time, seen.place, message)


def _crossed(records: Sequence[BalanceRecord], skier: Skier, weight: float) -> dict[str, NDArray[np.bool_]]:
    """Masks over the moments, by limit: True while it is crossed."""
    seen = [each.seen for each in records]
    load = np.array([each.load for each in seen]) / weight
    across = np.array([each.across for each in seen])
    hips = np.array([math.remainder(each.body_heading - each.heading, 2.0 * math.pi) for each in seen])
    slip, edge = np.abs([each.slip for each in seen]), np.abs([each.edge[0] for each in seen])
    wanted = np.array([0.0 if each.balance is None else each.balance.wanted for each in records])
    height = np.array([each.height for each in seen])
    steepest = math.tan(skier.greatest_lean)
    asked = wanted / height * weight
    turning = np.abs(wanted) > 0.3 * height
    return {
        "speed": np.abs(wanted) > 0.97 * height * steepest,
        "hips": np.abs(hips) > skier.greatest_hip,
        "edge_lost": (slip < GRIPS) & (edge > EDGED) & (skier.brakes_to > 0.0) & turning,
        "grip": turning & (across * asked < HELD * asked**2) & (load > 0.5),
        "leg_force": (load > skier.leg_load) | (load < LEAST_LOAD),
    }


def _first_lasting_crossing(time: FloatArray, crossed: NDArray[np.bool_]) -> int | None:
    """First index from which a limit stays crossed for 0.05 s; None if there is none."""
    since: int | None = None
    for i, here in enumerate(crossed):
        if not here:
            since = None
        elif since is None:
            since = i
        if since is not None and time[i] - time[since] >= LASTS - 1e-9:
            return since
    return None
