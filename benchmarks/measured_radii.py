"""Measured radii beside ours: python -m benchmarks.measured_radii writes the tables of docs/validation/measured.md."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from tests.carving.synthetic import circular_sidecut, plain_ski, snow
from tests.present import present

from skisnow import carve, read_ski
from skisnow.carving.result import Equilibrium
from skisnow.ski import Ski
from skisnow.snow import published_snow

from .page_tables import write_tables

PAGE: Final = "validation/measured"
RACE_PISTE: Final = published_snow("race-piste")


@dataclass(frozen=True, slots=True)
class Turn:
    """Greatest edge angle (degrees) and smallest radius (m) of slalom turns, ± one standard deviation; not of one
    instant (Reid and others 2020)."""

    name: str
    angle: float
    angle_sd: float
    radius: float
    radius_sd: float


TURNS: Final = (Turn("gates every 10 m", 65.7, 1.7, 3.96, 0.23), Turn("gates every 13 m", 71.0, 1.9, 4.94, 0.59))


@dataclass(frozen=True, slots=True)
class FloorSki:
    """A ski edged on a rigid floor: R_sc of a fit to its widths, length of the contact (m), (degrees, R, sd of R)."""

    name: str
    sidecut: float
    sidecut_sd: float
    length: float
    measured: tuple[tuple[float, float, float], ...]


FLOOR: Final = (
    FloorSki("slalom, 165 cm", 12.26, 0.09, 1.4057, ((29.8, 10.11, 0.69), (44.0, 9.00, 0.18), (57.9, 6.48, 0.10))),
    FloorSki(
        "giant slalom, 188 cm", 28.99, 0.39, 1.6787, ((29.4, 25.20, 0.91), (45.0, 21.25, 0.65), (59.1, 14.41, 0.31))
    ),
)
"""A home experiment, read-me of the repository vladz8/ski-carving."""

Radius = Callable[[Equilibrium], float]
CENTRAL: Final[Mapping[str, Any]] = {"load": 800.0, "clamp_length": 0.3, "unloading_ratio": 10.0, "snow": RACE_PISTE}


def chord(found: Equilibrium) -> float:
    return present(found.turn_radius_chord)


def boot(found: Equilibrium) -> float:
    return present(found.turn_radius_boot)


def carved(degrees: float, ski: Ski | None = None, **changes: Any) -> Equilibrium:
    """The slalom ski of the catalogue on the race piste, 800 N, unless said otherwise."""
    asked = {**CENTRAL, **changes}
    return carve(ski or read_ski("slalom"), asked.pop("snow"), edge_angle=math.radians(degrees), **asked)


def choices(turn: Turn) -> dict[str, Sequence[tuple[float, Mapping[str, Any], Radius]]]:
    """What is not known of a measured turn, one thing at a time."""
    two_sd = (turn.angle - 2.0 * turn.angle_sd, turn.angle + 2.0 * turn.angle_sd)
    snows = (RACE_PISTE, snow(0.04, 0.40), snow(1.0, 0.40), snow(5.0, 0.40))
    return {
        "edge angle ± 2 sd": [(angle, {}, chord) for angle in two_sd],
        "load 500 to 2500 N": [(turn.angle, {"load": load}, chord) for load in (500.0, 800.0, 1500.0, 2500.0)],
        "clamp 0 to 0.3 m": [(turn.angle, {"clamp_length": clamp}, chord) for clamp in (0.0, 0.15, 0.3)],
        "footprint rigid to 1 N/mm²": [(turn.angle, {"footprint_stiffness": each}, chord) for each in (None, 3e7, 1e6)],
        "k_u/H_V 1 to 50": [(turn.angle, {"unloading_ratio": ratio}, chord) for ratio in (1.0, 10.0, 50.0)],
        "H_V 0.04 to 5 N/mm³": [(turn.angle, {"snow": each}, chord) for each in snows],
        "radius at the boot, by the chord": [(turn.angle, {}, boot), (turn.angle, {}, chord)],
    }


def radii(cases: Iterable[tuple[float, Mapping[str, Any], Radius]]) -> list[float]:
    return [of(carved(angle, **changes)) for angle, changes, of in cases]


def turns_table() -> str:
    """Smallest measured radius, and ours at the greatest edge angle."""
    ours = [carved(turn.angle) for turn in TURNS]
    rows = [("measured", *(f"{turn.radius:.2f} ± {turn.radius_sd:.2f}" for turn in TURNS))]
    rows.append(("R_sc cos ϑ", *(f"{12.6 * math.cos(math.radians(turn.angle)):.2f}" for turn in TURNS)))
    rows.append(("ours, by the chord", *(f"{chord(found):.2f}" for found in ours)))
    for name in choices(TURNS[0]):
        found = [radii(choices(turn)[name]) for turn in TURNS]
        rows.append((name, *(f"{min(each):.2f} to {max(each):.2f}" for each in found)))
    return _table(("radius (m)", *(f"{turn.name}, {turn.angle} ± {turn.angle_sd}°" for turn in TURNS)), rows)


FOOTPRINTS: Final = (None, 1000.0, 100.0, 30.0, 10.0, 3.0, 1.0)
"""Stiffness of boot and binding under each metre of ski (N/mm²); None: rigid."""


def footprint_rows() -> list[tuple[str, tuple[Equilibrium, Equilibrium]]]:
    """Holds for 0.3 m of the ski, from rigid to the boot's middle alone: at 45° and at 65.7°."""
    held: list[tuple[str, Mapping[str, Any]]] = [
        ("rigid" if each is None else f"{each:g}", {"footprint_stiffness": None if each is None else each * 1e6})
        for each in FOOTPRINTS
    ]
    held.append(("the boot's middle alone", {"clamp_length": 0.0}))
    return [(name, (carved(45.0, **how), carved(65.7, **how))) for name, how in held]


def borne_by_boot(found: Equilibrium) -> float:
    """Share of the snow's force within 0.15 m of the boot."""
    station, force = found.station, present(found.force_per_length)
    length = -np.gradient(station)
    return float((length * force)[np.abs(station) < 0.15].sum() / (length * force).sum())


def footprint_table() -> str:
    """Radii and what is borne under the boot, over the footprint's stiffness."""
    rows = [
        (name, *(cell for each in found for cell in (f"{chord(each):.2f}", f"{boot(each):.2f}",
                                                     f"{100.0 * borne_by_boot(each):.0f}")))
        for name, found in footprint_rows()
    ]  # fmt: skip
    head = ("chord (m)", "boot (m)", "under the boot (%)")
    return _table(("N/mm²", *(f"{degrees}: {each}" for degrees in ("45°", "65.7°") for each in head)), rows)


GRIPS: Final = (
    ("race piste, 0.21 and 0.52", RACE_PISTE), ("0.21 and 0.40", snow(0.21, 0.40)), ("1 and 0.40", snow(1.0, 0.40)),
    ("recreational piste, 0.16 and 0.086", published_snow("recreational-piste")),
    ("glacier, 90 and 0.30", snow(90.0, 0.30)),
)  # fmt: skip
"""H_V and S_f (N/mm³, N/mm²); S_f up to 0.40 on World Cup slopes."""
LOADS: Final = (800.0, 1500.0)


def grip(found: Equilibrium) -> float:
    """S_f ∫ e ds over the side force of the balance."""
    return present(found.side_force_limit) / present(found.side_force)


def grip_table() -> str:
    """For five snows and angles, at two loads."""
    rows = []
    for name, of in GRIPS:
        shares = []
        for degrees in (30.0, 45.0, 60.0, 65.7, 71.0):
            found = [carved(degrees, snow=of, load=load) for load in LOADS]
            shares.append(", ".join(f"{grip(each):.2f}" for each in found))
        rows.append((name, *shares))
    return _table(("H_V (N/mm³) and S_f (N/mm²)", "30°", "45°", "60°", "65.7°", "71°"), rows)


def on_a_floor(of: FloorSki, degrees: float) -> float:
    """Chord radius (m) of a ski with that circular side on snow as hard as a floor, under a point load."""
    ski = plain_ski(length=of.length, width=circular_sidecut(of.sidecut), bending=300.0)
    found = carved(degrees, ski, snow=snow(1000.0, 1000.0), load=400.0, clamp_length=0.0, unloading_ratio=1.0)
    return chord(found)


def floor_rows() -> list[tuple[str, float, float, float, float, float]]:
    """Ski, angle (degrees), measured R and its sd, R_sc cos ϑ, ours (m)."""
    return [
        (of.name, degrees, radius, sd, of.sidecut * math.cos(math.radians(degrees)), on_a_floor(of, degrees))
        for of in FLOOR
        for degrees, radius, sd in of.measured
    ]


def floor_table() -> str:
    """Radii on a rigid floor."""
    rows = [
        (name, f"{degrees}", f"{radius:.2f} ± {sd:.2f}", f"{exact:.2f}", f"{ours:.2f}", f"{(ours - radius) / sd:+.1f}")
        for name, degrees, radius, sd, exact, ours in floor_rows()
    ]
    return _table(("ski", "edge angle (°)", "measured (m)", "R_sc cos ϑ (m)", "ours (m)", "off (sd)"), rows)


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = ["| " + " | ".join(head) + " |", "| --- |" + " ---: |" * (len(head) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def tables() -> dict[str, str]:
    """By their names."""
    return {"turns": turns_table(), "footprint": footprint_table(), "grip": grip_table(), "floor": floor_table()}


if __name__ == "__main__":
    write_tables(PAGE, tables())
    np.testing.assert_equal(len(floor_rows()), 6)
