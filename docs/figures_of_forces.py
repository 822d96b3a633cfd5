"""Draw the figures of the pages on force laws: `python docs/figures_of_forces.py [FOLDER]`.

Every curve is computed by the law that its page describes. The same picture comes out on every run.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from skisnow._support.units import DEGREE, MM, N_PER_MM2, N_PER_MM3
from skisnow.forces.drag import AirDrag
from skisnow.forces.friction import (
    ConstantFriction,
    FrictionLaw,
    LinearFriction,
    QuadraticFriction,
    WaterFilmFriction,
)
from skisnow.forces.measured_ranges import GLIDE_FRICTION, GROOMED_SNOW_DENSITY
from skisnow.forces.penetration import (
    AreaLaw,
    BilinearLaw,
    DepthLaw,
    ElasticPoint,
    ElementCountLaw,
    HypoplasticPoint,
    MeanPressureLaw,
    PenetrationLaw,
    VolumeLaw,
    VolumeWithAngleLaw,
)
from skisnow.forces.shear import AngleShear, ConstantShear, IceCuttingShear, MachiningShear
from skisnow.geometry import SkiPiece
from skisnow.report.figures.style import BLACK, BLUE, GREEN, GREY, ORANGE, PALE, VERMILLION, journal_style, new_figure
from skisnow.snow import published_snow
from skisnow.snow.published import domine_2011, federolf_2006, moessner_2013

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


def volume_with_angle(axes: Axes) -> None:
    """Force over that of the volume law, over the edge angle."""
    angle = np.linspace(0.0, 60.0, 121) * DEGREE
    ratio = VolumeWithAngleLaw(HARDNESS).reaction_force(TOOL, 5 * MM, angle) / VolumeLaw(HARDNESS).reaction_force(
        TOOL, 5 * MM, angle
    )
    axes.plot(angle / DEGREE, ratio, color=BLUE, label="Eqn 11")
    axes.axhline(1.0, color=BLACK, linestyle="--", label="Eqn 12")
    axes.set(xlabel="edge angle ϑ (°)", ylabel="F / (H$_V$ V)", xlim=(0, 60), ylim=(0.9, 1.2))
    axes.legend()


def bilinear(axes: Axes) -> None:
    """The two terms of the general law and their sum."""
    a, b = 3.0 * MM, 0.9
    _force_over_depth(axes, BilinearLaw(HARDNESS, a, 0.0, b, 0.0), "H (a A + b V)", BLACK)
    _force_over_depth(axes, BilinearLaw(HARDNESS, 0.0, 0.0, b, 0.0), "H b V", BLUE)
    _force_over_depth(axes, BilinearLaw(HARDNESS, a, 0.0, 0.0, 0.0), "H a A", VERMILLION)
    _force_axes(axes)


_LAST_DEPTH, _LAST_FORCE = 10.0 * MM, 490.0
"""Largest load of a test at 45°, from which Eqn 1 takes every hardness."""


def depth(axes: Axes) -> None:
    """The law by depth and the volume law through the largest load."""
    H_V = _LAST_FORCE / float(TOOL.displaced_volume(_LAST_DEPTH, EDGED))
    _force_over_depth(axes, DepthLaw(_LAST_FORCE / _LAST_DEPTH), "F = H$_e$ e", VERMILLION)
    _force_over_depth(axes, VolumeLaw(H_V), "F = H$_V$ V", BLUE)
    axes.plot(_LAST_DEPTH / MM, _LAST_FORCE, "o", color=BLACK, label="largest load")
    _force_axes(axes)
    axes.set(xlim=(0, 12), ylim=(0, 700))


def area(axes: Axes) -> None:
    """The law by area flat, at 10° where it stops growing, and at 45°."""
    law = AreaLaw(_LAST_FORCE / float(TOOL.contact_area(_LAST_DEPTH, EDGED)))
    for angle_deg, colour in ((0.0, BLACK), (10.0, VERMILLION), (45.0, BLUE)):
        _force_over_depth(axes, law, f"ϑ = {angle_deg:g}°", colour, angle=angle_deg * DEGREE)
    axes.plot(0.0, float(law.reaction_force(TOOL, 0.0, 0.0)), "o", color=BLACK, clip_on=False)
    _force_axes(axes)
    axes.set_ylim(0, 4000)


def mean_pressure(axes: Axes) -> None:
    """Federolf's three snows at the angle of the conversion, and the volume law of each."""
    angle = federolf_2006.CONVERSION_ANGLE
    colours = (BLUE, VERMILLION, GREEN)
    for (name, words), colour in zip(federolf_2006.NAMES.items(), colours, strict=True):
        A, B = federolf_2006.PRESSURE_LAWS[words]
        law = MeanPressureLaw(A * N_PER_MM3, B * N_PER_MM2)
        _force_over_depth(axes, law, name, colour, angle=angle)
        volume_law = VolumeLaw(published_snow(name).snow_hardness).reaction_force(TOOL, DEPTH_MM * MM, angle)
        axes.plot(DEPTH_MM, volume_law, color=colour, linestyle="--")
    axes.plot([], [], color=GREY, linestyle="--", label="H$_V$ V of the same snow")
    _force_axes(axes)
    axes.set_xlim(0, 15)
    axes.set_ylim(0, 2500)


def element_count(axes: Axes) -> None:
    """Elements in the displaced volume."""
    for per_mm3, colour in ((0.5, GREEN), (1.0, BLUE), (2.0, VERMILLION)):
        law = ElementCountLaw(per_mm3 / MM**3, HARDNESS / (per_mm3 / MM**3))
        count = law.element_count(TOOL, DEPTH_MM * MM, EDGED)
        axes.plot(
            DEPTH_MM, count / 1e3, color=colour, label=f"n = {per_mm3:g} per mm³, f = {law.force_per_element:g} N"
        )
    axes.set(xlabel="penetration depth e (mm)", ylabel="elements N (thousands)", xlim=(0, 20), ylim=(0, None))
    axes.legend()


_PATH_MM: Final = np.concatenate([np.linspace(0, 6, 61), np.linspace(6, 0, 241), np.linspace(0, 8, 321)])


def _stress_over_path(law: ElasticPoint | HypoplasticPoint) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    deepest = np.maximum.accumulate(_PATH_MM) * MM
    before = np.concatenate([[0.0], deepest[:-1]])
    return law.stress(_PATH_MM * MM, before) / N_PER_MM2


def _stress_axes(axes: Axes) -> None:
    axes.set(xlabel="depth ε (mm)", ylabel="stress p (N/mm²)", xlim=(0, 8), ylim=(0, 1.7))
    axes.legend(loc="upper left")


def elastic_point(axes: Axes) -> None:
    """Loading and unloading on one line."""
    law = ElasticPoint(HARDNESS)
    axes.fill([0, 6, 6], [0, float(law.stress(6 * MM, 0.0)) / N_PER_MM2, 0], color=PALE, alpha=0.5, linewidth=0)
    axes.annotate("stored at 6 mm, all given back", (2.0, 0.07), fontsize=7)
    axes.plot(_PATH_MM, _stress_over_path(law), color=BLUE, label="loading and unloading")
    _stress_axes(axes)


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


def shear_constant(axes: Axes) -> None:
    """Force per metre of edge on published snows."""
    for name, colour in (("race-piste", BLUE), ("glacier", VERMILLION), ("fresh-snow", GREEN)):
        stress = published_snow(name).failure_shear_stress or 0.0
        force = ConstantShear(stress).failure_force(DEPTH_MM * MM, 1.0, EDGED)
        axes.plot(DEPTH_MM, force / 1e3, color=colour, label=f"{name}, {stress / N_PER_MM2:.2g} N/mm²")
    axes.set(xlabel="edge depth e (mm)", ylabel="F$_t$ / L (kN/m)", xlim=(0, 20), ylim=(0, None))
    axes.legend()


def shear_by_angle(axes: Axes) -> None:
    """Eqn 13."""
    angle = np.linspace(0.0, 90.0, 91)
    law = AngleShear.soft_snow()
    axes.plot(angle, law.failure_stress(5 * MM, angle * DEGREE) / N_PER_MM2, color=BLUE, label="Eqn 13, soft snow")
    axes.set(
        xlabel="edge angle ϑ (°)", ylabel="F$_t$ / (L e) (N/mm²)", xlim=(0, 90), ylim=(0, 0.07), xticks=range(0, 91, 30)
    )
    axes.legend()


def shear_by_density(axes: Axes) -> None:
    """Eqn 14, measured and beyond."""
    density = np.linspace(100.0, 917.0, 400)
    stress = moessner_2013.failure_shear_stress_from_density(density) / N_PER_MM2
    axes.axvspan(GROOMED_SNOW_DENSITY.lowest, GROOMED_SNOW_DENSITY.highest, color=PALE, alpha=0.4, linewidth=0)
    axes.plot(density, np.where(stress > 0, stress, np.nan), color=BLUE, label="Eqn 14")
    axes.plot(density, np.where(stress <= 0, stress, np.nan), color=VERMILLION, linestyle=":", label="refused")
    axes.annotate("measured", (580, 0.02), ha="center", fontsize=7, color=GREY)
    axes.set(xlabel="snow density ρ (kg/m³)", ylabel="S$_f$ (N/mm²)", xlim=(100, 917))
    axes.axhline(0.0, color=BLACK, linewidth=0.6)
    axes.legend(loc="upper left")


def shear_by_density_natural(axes: Axes) -> None:
    """The square, and its branch that is refused."""
    density = np.linspace(0.0, 500.0, 501)
    stress = domine_2011.failure_shear_stress_from_density(density)
    least = domine_2011.LEAST_DENSITY
    axes.plot(density, np.where(density > least, stress, np.nan), color=BLUE, label="Domine and others 2011")
    axes.plot(density, np.where(density <= least, stress, np.nan), color=VERMILLION, linestyle=":", label="refused")
    axes.set(xlabel="snow density ρ (kg/m³)", ylabel="S$_f$ (N/m²)", xlim=(0, 500), ylim=(0, None))
    axes.legend(loc="upper left")


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


def shear_ice_cutting(axes: Axes) -> None:
    """Invented coefficients, scaled by 0.02."""
    law = IceCuttingShear(((6e6, -8e6), (1e9, 0.0)))
    depth = np.linspace(0.0, 1.0, 101)
    for angle_deg, colour in ((30.0, BLUE), (45.0, GREEN), (60.0, ORANGE), (75.0, VERMILLION)):
        force = law.failure_force(depth * MM, 1.0, angle_deg * DEGREE)
        axes.plot(depth, force, color=colour, label=f"ϑ = {angle_deg:g}°, rake {angle_deg - 90:g}°".replace("-", "−"))
    axes.set(xlabel="edge depth e (mm)", ylabel="F$_t$ / L (N/m)", xlim=(0, 1), ylim=(0, None))
    axes.legend()


def _friction_over_speed(axes: Axes, *laws: tuple[FrictionLaw, str, str]) -> None:
    speed = np.linspace(0.0, 30.0, 301)
    axes.axhspan(GLIDE_FRICTION.lowest, GLIDE_FRICTION.highest, color=PALE, alpha=0.4, linewidth=0)
    axes.annotate("measured on skis", (29.5, 0.128), ha="right", fontsize=7, color=GREY)
    for law, label, colour in laws:
        axes.plot(speed, law.coefficient(speed), color=colour, label=label)
    axes.set(xlabel="speed v (m/s)", ylabel="coefficient of friction μ", xlim=(0, 30), ylim=(0, 0.18))
    axes.legend(loc="upper left")


def friction_constant(axes: Axes) -> None:
    """Two constant coefficients."""
    _friction_over_speed(
        axes, (ConstantFriction(0.04), "μ$_0$ = 0.04", BLUE), (ConstantFriction(0.08), "μ$_0$ = 0.08", VERMILLION)
    )


def friction_linear(axes: Axes) -> None:
    """Growing and falling."""
    _friction_over_speed(
        axes,
        (LinearFriction(0.03, 0.0015), "μ$_1$ = 0.0015 s/m", BLUE),
        (LinearFriction(0.06, -0.001), "μ$_1$ = −0.001 s/m", VERMILLION),
    )


def friction_quadratic(axes: Axes) -> None:
    """Two signs of the linear term."""
    _friction_over_speed(
        axes,
        (QuadraticFriction(0.03, 0.0, 6e-5), "μ$_1$ = 0", BLUE),
        (QuadraticFriction(0.06, -0.003, 1e-4), "μ$_1$ = −0.003 s/m", VERMILLION),
    )


def friction_water_film(axes: Axes) -> None:
    """The minimum, and the two parts of one curve."""
    law = WaterFilmFriction(0.03, 0.06, 1.0, 6e-4)
    _friction_over_speed(
        axes, (law, "v$_0$ = 1 m/s", BLUE), (WaterFilmFriction(0.03, 0.06, 4.0, 6e-4), "v$_0$ = 4 m/s", VERMILLION)
    )
    best = law.speed_of_least_friction
    axes.plot(best, float(law.coefficient(best)), "o", color=BLUE, label=f"least at {best:.1f} m/s")
    axes.legend(loc="upper left")


def drag(axes: Axes) -> None:
    """Tuck and upright, with and without wind against."""
    speed = np.linspace(0.0, 30.0, 301)
    velocity = np.stack([speed, np.zeros_like(speed)], axis=-1)
    for area_m2, word, colour in ((0.23, "tuck", BLUE), (0.66, "upright", VERMILLION)):
        law = AirDrag(area_m2, 1.2)
        for wind, style in ((0.0, "-"), (-5.0, "--")):
            force = np.linalg.norm(law.force(velocity, wind=[wind, 0.0]), axis=-1)
            label = f"{word}, {area_m2:g} m²" + (", 5 m/s against" if wind else "")
            axes.plot(speed, force, style, color=colour, label=label)
    axes.set(xlabel="speed v (m/s)", ylabel="drag (N)", xlim=(0, 30), ylim=(0, None))
    axes.legend()


FIGURES: Final[dict[str, Callable[[Axes], None]]] = {
    "penetration-volume": volume,
    "penetration-volume-with-angle": volume_with_angle,
    "penetration-bilinear": bilinear,
    "penetration-depth": depth,
    "penetration-area": area,
    "penetration-mean-pressure": mean_pressure,
    "penetration-element-count": element_count,
    "penetration-elastic-point": elastic_point,
    "penetration-hypoplastic-point": hypoplastic_point,
    "shear-constant": shear_constant,
    "shear-by-angle": shear_by_angle,
    "shear-by-density": shear_by_density,
    "shear-by-density-natural": shear_by_density_natural,
    "shear-machining": shear_machining,
    "shear-ice-cutting": shear_ice_cutting,
    "friction-constant": friction_constant,
    "friction-linear": friction_linear,
    "friction-quadratic": friction_quadratic,
    "friction-water-film": friction_water_film,
    "drag": drag,
}
"""Drawing by page."""


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
