"""Tables and figure of docs/validation/simulated-turn.md: python -m benchmarks.carved_turn_tables (needs Exudyn)."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path

import matplotlib
import numpy as np
from openbench.entries.numpy_reference import slow_carve as reference
from openbench.entries.numpy_reference.slow_carve import Case
from tests.carving.synthetic import boot_pose, circular_sidecut, plain_ski, race_profile, snow

from skisnow._support.arrays import FloatArray
from skisnow.carving.equilibrium import carve, rest
from skisnow.carving.result import Equilibrium
from skisnow.ski import read_ski

from .page_tables import write_tables

MESHES = (40, 80, 160, 320, 640)
SKIS = ("slalom", "giant-slalom", "carver")
FIGURES = Path(__file__).parents[1] / "docs" / "_static" / "validation"


def table(name: str, head: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    write_tables(
        "validation/simulated-turn",
        {name: ["| " + " | ".join(row) + " |" for row in (head, ["---"] * len(head), *rows)]},
    )


def turned(
    ski: str, hardness: float, ratio: float, *, elements: int = 160, angle_deg: float = 45.0, clamp: float = 0.3
) -> Equilibrium:
    return carve(
        read_ski(ski),
        snow(hardness),
        edge_angle=math.radians(angle_deg),
        load=800.0,
        unloading_ratio=ratio,
        clamp_length=clamp,
        elements=elements,
    )


def depth(found: Equilibrium) -> FloatArray:
    assert found.edge_depth is not None
    return found.edge_depth


def one_sided(hardness: float, elements: int) -> tuple[float, float, float]:
    """1/λ (m), and the relative deviations of depth and contact length."""
    ski = plain_ski(bending=300.0, width=0.065)
    found = rest(ski, snow(hardness), edge_angle=0.0, load=800.0, clamp_length=0.0, elements=elements)
    foundation = hardness * 1e9 * 0.065
    rate = (foundation / 1200.0) ** 0.25
    expected = 800.0 * rate / (2.0 * foundation) / math.tanh(math.pi / 2.0)
    assert found.contact_length is not None
    return 1.0 / rate, boot_pose(found, ski, 0.0)[0] / expected - 1.0, found.contact_length * rate / math.pi - 1.0


def beam_on_snow() -> None:
    rows = []
    for hardness in (0.02, 0.2, 1.0, 10.0, 90.0):
        wave, depth_off, length_off = one_sided(hardness, 160)
        deviations = [f"{100.0 * one_sided(hardness, n)[1]:+.4f}" for n in MESHES]
        rows.append([f"{hardness:g}", f"{100.0 * wave:.1f}", f"{100.0 * length_off:+.3f}", *deviations])
        assert abs(depth_off) < 0.01
    table("point-load", ["H_V (N/mm³)", "1/λ (cm)", "contact, 160 (%)", *(f"depth, {n} (%)" for n in MESHES)], rows)


def radii() -> None:
    sidecut = 13.0
    rows = []
    for label, bending in (("even", 300.0), ("race", race_profile(300.0))):
        for angle_deg in (30.0, 45.0, 60.0):
            row = [label, f"{angle_deg:.0f}"]
            for clamp in (0.0, 0.3):
                found = carve(
                    plain_ski(width=circular_sidecut(sidecut), bending=bending),
                    snow(90.0),
                    edge_angle=math.radians(angle_deg),
                    load=800.0,
                    unloading_ratio=1.0,
                    clamp_length=clamp,
                    twist=False,
                    elements=320,
                )
                limit = sidecut * math.cos(math.radians(angle_deg))
                assert found.turn_radius_boot is not None
                assert found.turn_radius_chord is not None
                row += [f"{100.0 * (r / limit - 1.0):+.1f}" for r in (found.turn_radius_chord, found.turn_radius_boot)]
            rows.append(row)
    table("radius", ["EI", "ϑ (°)", "chord, clamp 0", "boot, clamp 0", "chord, clamp 0.3", "boot, clamp 0.3"], rows)


def against_reference() -> None:
    rows = []
    for angle_deg, ratio, clamp in ((30, 1, 0.0), (30, 10, 0.3), (60, 1, 0.3), (60, 10, 0.3)):
        ski = read_ski("slalom")
        case = Case(ski, 0.2e9, math.radians(angle_deg), 800.0)
        theirs = reference.solved(replace(case, unloading_ratio=float(ratio), clamp_length=clamp))
        ours = turned("slalom", 0.2, float(ratio), angle_deg=float(angle_deg), clamp=clamp)
        front, rear = theirs.contact_ends()
        corner = float(ski.at(0.0).width) / 2.0 * math.sin(case.edge_angle)
        pairs = (
            (ours.turn_radius_boot, theirs.radius_at_boot()),
            (ours.turn_radius_chord, theirs.radius_through(front, rear)),
            (boot_pose(ours, ski, case.edge_angle)[0] + corner, theirs.boot_depth + corner),
            (ours.contact_length, front - rear),
        )
        off = [f"{100.0 * (float(mine or 0.0) / other - 1.0):+.3f}" for mine, other in pairs]
        rows.append([str(angle_deg), str(ratio), f"{clamp:g}", f"{theirs.radius_at_boot():.3f}", *off])
    table(
        "independent",
        [
            "ϑ (°)",
            "k_u/H_V",
            "clamp (m)",
            "R boot (m)",
            "R boot (%)",
            "R chord (%)",
            "depth at the boot (%)",
            "contact (%)",
        ],
        rows,
    )


def results(hardness: float, ratio: float, elements: int) -> FloatArray:
    found = turned("slalom", hardness, ratio, elements=elements)
    values = [found.turn_radius_boot, found.turn_radius_chord, float(depth(found).max()), found.contact_length]
    return np.array(values, dtype=float)


def mesh() -> dict[tuple[float, float], FloatArray]:
    """Write the deviations of 160 elements, and return the deviations of all meshes from the finest."""
    rows, all_off = [], {}
    for hardness in (0.04, 0.2, 1.0, 90.0):
        for ratio in (1.0, 10.0):
            values = np.array([results(hardness, ratio, n) for n in (*MESHES, 1280)])
            off = 100.0 * (values[:-1] / values[-1] - 1.0)
            all_off[hardness, ratio] = off
            rows.append([f"{hardness:g}", f"{ratio:g}", *(f"{value:+.3f}" for value in off[MESHES.index(160)])])
    table("mesh", ["H_V (N/mm³)", "k_u/H_V", "R boot (%)", "R chord (%)", "greatest depth (%)", "contact (%)"], rows)
    return all_off


def memory() -> None:
    rows = []
    for name in SKIS:
        for clamp in (0.0, 0.3):
            found = [turned(name, 0.2, ratio, clamp=clamp) for ratio in (1.0, 2.0, 5.0, 10.0, 50.0)]
            rows.append([name, f"{clamp:g}", *(f"{each.afterbody_depth_ratio or 0.0:.2f}" for each in found)])
    table("afterbody", ["ski", "clamp (m)", "elastic", "2", "5", "10", "50"], rows)
    rows = []
    for name in SKIS:
        for clamp in (0.0, 0.3):
            row = [name, f"{clamp:g}"]
            for ratio in (1.0, 50.0):
                found_one = turned(name, 0.2, ratio, clamp=clamp)
                shares = np.interp([-0.4, -0.6], found_one.station[::-1], depth(found_one)[::-1])
                row += [f"{100.0 * share / depth(found_one).max():.0f}" for share in shares]
            rows.append(row)
    head = ["ski", "clamp (m)", "elastic, −0.4 m", "elastic, −0.6 m", "k_u/H_V = 50, −0.4 m", "k_u/H_V = 50, −0.6 m"]
    table("remaining-depth", head, rows)


def against_exudyn() -> None:
    """Greatest deviations over the three skis, as shares of the greatest depth and of the greatest deflection."""
    from .exudyn_contact import on_snow

    rows = []
    for hardness in (0.02, 0.2, 2.0):
        row = [f"{hardness:g}"]
        for elements in (160, 320):
            worst = np.zeros(3)
            for name in SKIS:
                ski = read_ski(name)
                found = rest(ski, snow(hardness), edge_angle=0.0, load=800.0, clamp_length=0.0, elements=elements)
                model = on_snow(ski, hardness * 1e9, 800.0, elements=elements)
                theirs, _ = model.depth()
                place = model.beam.place
                assert found.bending is not None
                boot, slope = boot_pose(found, ski, 0.0)
                ours = boot + slope * place - model.base_height
                ours = ours - np.interp(place, found.station[::-1], found.bending[::-1])
                off = np.abs(ours - theirs)
                below = (theirs > 0.0) | (ours > 0.0)
                at_boot = abs(boot - float(np.interp(0.0, place, theirs)))
                shares = [at_boot / theirs.max(), off[below].max() / theirs.max(), off.max() / np.ptp(found.bending)]
                worst = np.maximum(worst, shares)
            row += [f"{100.0 * share:.2f}" for share in worst]
        rows.append(row)
    kinds = ("depth at the boot", "depth anywhere", "deflection")
    table("exudyn", ["H_V (N/mm³)", *(f"{kind}, {n} (%)" for n in (160, 320) for kind in kinds)], rows)


def draw(off: dict[tuple[float, float], FloatArray]) -> None:
    """Convergence, and the contrast of the depths along the ski."""
    matplotlib.use("Agg")
    from matplotlib import pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.6), layout="constrained")
    for (hardness, ratio), deviation in off.items():
        style = "-" if ratio == 1.0 else "--"
        colour = {0.04: "tab:blue", 0.2: "tab:green", 1.0: "tab:orange", 90.0: "tab:red"}[hardness]
        label = f"{hardness:g} N/mm³" if ratio == 1.0 else None
        left.loglog(MESHES, np.linalg.norm(deviation, axis=1), style, marker=".", color=colour, label=label)
    left.loglog(MESHES, 2e3 / np.array(MESHES) ** 2.0, ":", color="0.5", label="order 2")
    left.set_xticks(MESHES, [str(n) for n in MESHES], minor=False)
    left.minorticks_off()
    left.set_xlabel("elements over the ski")
    left.set_ylabel("distance from 1280 elements (%)")
    left.legend(fontsize=8, title="solid: elastic, dashed: k$_u$/H$_V$ = 10", title_fontsize=8)
    deepest = 0.0
    for ratio, colour in ((1.0, "tab:blue"), (2.0, "tab:green"), (10.0, "tab:orange"), (50.0, "tab:red")):
        found = turned("slalom", 0.2, ratio, clamp=0.0)
        label = "elastic" if ratio == 1.0 else f"k$_u$/H$_V$ = {ratio:g}"
        deepest = max(deepest, float(depth(found).max()))
        right.plot(found.station, 1e3 * np.maximum(depth(found), -0.5e-3), color=colour, label=label)
    right.set_xlim(0.85, -0.8)
    right.set_ylim(1.05e3 * deepest, -0.5)
    right.axhline(0.0, color="0.5", linewidth=0.8)
    right.set_xlabel("distance before the boot (m), tip on the left")
    right.set_ylabel("edge depth (mm)")
    right.legend(fontsize=8, loc="lower left")
    FIGURES.mkdir(parents=True, exist_ok=True)
    figure.savefig(FIGURES / "equilibrium.png", dpi=110)


def main() -> None:
    beam_on_snow()
    radii()
    against_reference()
    against_exudyn()
    off = mesh()
    memory()
    draw(off)


if __name__ == "__main__":
    main()
