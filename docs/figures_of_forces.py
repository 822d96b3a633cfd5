"""Draw the figures of the page on force laws: `python docs/figures_of_forces.py [FOLDER]`.

Every curve is computed by its law. The same picture comes out on every run.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from skisnow._support.units import DEGREE, MM, N_PER_MM2, N_PER_MM3
from skisnow.forces.friction import (
    FrictionLaw,
    WaterFilmFriction,
)
from skisnow.forces.parameter_checks import GLIDE_FRICTION
from skisnow.forces.penetration import (
    ElasticPoint,
    HypoplasticPoint,
    PenetrationLaw,
    VolumeLaw,
)
from skisnow.forces.shear import MachiningShear
from skisnow.geometry import SkiPiece
from skisnow.report.figures.style import BLACK, BLUE, GREEN, GREY, ORANGE, PALE, VERMILLION, journal_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FOLDER: Final = Path(__file__).parent / "_static" / "forces"
TOOL: Final = SkiPiece(length=0.2, width=0.062)
HARDNESS: Final = 0.2 * N_PER_MM3
EDGED: Final = 45.0 * DEGREE
DEPTH_MM: Final = np.linspace(0.0, 20.0, 401)


def _force_over_depth(axes: Axes, law: PenetrationLaw, label: str, colour: str, *, angle: float = EDGED) -> None:
    axes.plot(DEPTH_MM, law.reaction_force(TOOL, DEPTH_MM * MM, angle), color=colour, label=label)


def _force_axes(axes: Axes) -> None:
    axes.set(xlabel="penetration depth e (mm)", ylabel="force F (N)", xlim=(0, 20), ylim=(0, None))
    axes.legend()


def volume(axes: Axes) -> None:
    """The volume law flat, at 10° where the wedge becomes a trapezoid, and at 45°."""
    law = VolumeLaw(HARDNESS)
    for angle_deg, colour in ((0.0, BLACK), (10.0, VERMILLION), (45.0, BLUE)):
        _force_over_depth(axes, law, f"ϑ = {angle_deg:g}°", colour, angle=angle_deg * DEGREE)
    rim = TOOL.width * math.sin(10.0 * DEGREE)
    axes.plot(rim / MM, float(law.reaction_force(TOOL, rim, 10.0 * DEGREE)), "o", color=VERMILLION, label="e = W sin ϑ")
    _force_axes(axes)
    axes.set_ylim(0, 25_000)


_PATH_MM: Final = np.concatenate([np.linspace(0, 6, 61), np.linspace(6, 0, 241), np.linspace(0, 8, 321)])


def _stress_over_path(law: ElasticPoint | HypoplasticPoint) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    deepest = np.maximum.accumulate(_PATH_MM) * MM
    before = np.concatenate([[0.0], deepest[:-1]])
    return law.stress(_PATH_MM * MM, before) / N_PER_MM2


def _stress_axes(axes: Axes) -> None:
    axes.set(xlabel="depth ε (mm)", ylabel="stress p (N/mm²)", xlim=(0, 8), ylim=(0, 1.7))
    axes.legend(loc="upper left")


def hypoplastic_point(axes: Axes) -> None:
    """To 6 mm, back to 0, and on to 8 mm, for several k_u; the energy lost with k_u = 2 H_V."""
    two = HypoplasticPoint(HARDNESS, 2.0)
    left = float(two.residual_depth(6 * MM)) / MM
    axes.fill([0, 6, left], [0, float(two.stress(6 * MM, 0.0)) / N_PER_MM2, 0], color=PALE, alpha=0.5, linewidth=0)
    axes.annotate("lost with k$_u$ = 2 H$_V$", (1.0, 0.07), fontsize=7)
    for ratio, colour in ((1.0, BLACK), (2.0, VERMILLION), (5.0, BLUE), (10.0, GREEN), (math.inf, ORANGE)):
        label = f"k$_u$/H$_V$ = {ratio:g}".replace("inf", "∞")
        axes.plot(_PATH_MM, _stress_over_path(HypoplasticPoint(HARDNESS, ratio)), color=colour, label=label)
    _stress_axes(axes)


def shear_machining(axes: Axes) -> None:
    """Cut and thrust over the edge angle, with and without friction."""
    angle = np.linspace(1.0, 90.0, 400)
    S = 0.0172 * N_PER_MM2
    for friction, colour in ((0.0, BLUE), (0.2, VERMILLION)):
        # 2 S = 0.0344 N/mm², Eqn 13 upright; no range is left by it
        law = _quiet_machining(S, friction)
        for force, style, word in (
            (law.failure_force(1.0, 1.0, angle * DEGREE), "-", "F$_t$"),
            (law.thrust_force(1.0, 1.0, angle * DEGREE), "--", "thrust"),
        ):
            axes.plot(angle, force / N_PER_MM2, style, color=colour, label=f"{word}, μ$_t$ = {friction:g}")
    axes.set(
        xlabel="edge angle ϑ (°)", ylabel="force / (L e) (N/mm²)", xlim=(0, 90), ylim=(0, 0.3), xticks=range(0, 91, 30)
    )
    axes.legend()


def _quiet_machining(strength: float, friction: float) -> MachiningShear:
    """The law of Fig. 9, whose 2 S of 0.034 N/mm² lies below the range of S_f: the page says so."""
    import warnings

    from skisnow._support.errors import RangeWarning

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        return MachiningShear(strength, friction)


def _friction_over_speed(axes: Axes, *laws: tuple[FrictionLaw, str, str]) -> None:
    speed = np.linspace(0.0, 30.0, 301)
    axes.axhspan(GLIDE_FRICTION.lowest, GLIDE_FRICTION.highest, color=PALE, alpha=0.4, linewidth=0)
    axes.annotate("measured on skis", (29.5, 0.128), ha="right", fontsize=7, color=GREY)
    for law, label, colour in laws:
        axes.plot(speed, law.coefficient(speed), color=colour, label=label)
    axes.set(xlabel="speed v (m/s)", ylabel="coefficient of friction μ", xlim=(0, 30), ylim=(0, 0.18))
    axes.legend(loc="upper left")


def friction_water_film(axes: Axes) -> None:
    """The minimum, and the two parts of one curve."""
    law = WaterFilmFriction(0.03, 0.06, 1.0, 6e-4)
    _friction_over_speed(
        axes, (law, "v$_0$ = 1 m/s", BLUE), (WaterFilmFriction(0.03, 0.06, 4.0, 6e-4), "v$_0$ = 4 m/s", VERMILLION)
    )
    best = law.speed_of_least_friction
    axes.plot(best, float(law.coefficient(best)), "o", color=BLUE, label=f"least at {best:.1f} m/s")
    axes.legend(loc="upper left")


FIGURES: Final[dict[str, Callable[[Axes], None]]] = {
    "penetration-volume": volume,
    "penetration-hypoplastic-point": hypoplastic_point,
    "shear-machining": shear_machining,
    "friction-water-film": friction_water_film,
}
"""Drawing by name of the file."""


def draw(folder: Path, names: Iterable[str] = tuple(FIGURES)) -> None:
    """Write figures, all unless named, as PNG into the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in names:
        with journal_style():
            figure = new_figure(width_mm=105.0, height_mm=68.0)
            FIGURES[name](figure.add_subplot())
            figure.savefig(folder / f"{name}.png", dpi=150, metadata={"Software": None})


if __name__ == "__main__":
    draw(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
