"""Reports of identifications, and tables of seating."""

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.messages import Message
from skisnow.identification.parameter import Parameter
from skisnow.identification.problem import Fit
from skisnow.identification.result import Effort, Identification, Identified, Profile, identification_dict
from skisnow.report.campaign.series_tables import count_resolved_offsets
from skisnow.report.figures.drawing import FORMS
from skisnow.report.figures.style import journal_style
from skisnow.report.identification import draw_profiles, draw_residuals, draw_tracks, write_identify_report
from skisnow.report.summaries import identify_summary

MU = Parameter(key="friction.mu_0", name="mu_0", start=0.04, lower=0.0, upper=0.5, size=0.05)
AREA = Parameter(
    key="drag.drag_area_m2", name="drag_area", start=0.4, lower=0.0, upper=2.0, size=0.1, unit="m²",
    prior_mean=0.45, prior_sd=0.1,
)  # fmt: skip


def cells(name: str, *, late: float = 0.0) -> Fit:
    """Three cells, the second without a time; the last is `late` seconds later than the parameters give."""
    station = np.array([20.0, 40.0, 60.0])
    fitted = np.array([[3.0], [5.0], [6.5]])
    measured = fitted + np.array([[0.01], [np.nan], [late]])
    return Fit(
        name=name, kind="photo_cells", along=station, labels=("time (s)",), measured=measured, fitted=fitted,
        sd=np.full((3, 1), 0.004),
    )  # fmt: skip


def along_a_track(name: str) -> Fit:
    """Ten metres down and 4 m to the left; the speed is not measured."""
    fitted = np.stack([np.linspace(0.0, 10.0, 11), np.linspace(0.0, 4.0, 11), np.full(11, 5.0)], axis=1)
    measured = fitted + np.array([0.1, -0.2, np.nan])
    labels = ("x (m)", "y (m)", "speed (m/s)")
    return Fit(
        name=name, kind="track", along=np.linspace(0.0, 2.0, 11), labels=labels, measured=measured, fitted=fitted,
        sd=np.full((11, 3), 0.05),
    )  # fmt: skip


@pytest.fixture
def found() -> Identification:
    mu = Identified(
        parameter=MU, value=0.0423456, standard_error=0.0012, interval=(0.0399, 0.0447),
        profile_interval=(0.0398, None), bootstrap_interval=(0.04, 0.045), at_bound=True,
    )  # fmt: skip
    area = Identified(parameter=AREA, value=0.41, standard_error=0.02, interval=(0.37, 0.45))
    value = np.linspace(0.035, 0.05, 7)
    profile = Profile("friction.mu_0", value, ((value - 0.0423456) / 0.0012) ** 2, 4.0)
    return Identification(
        outcome="converged", reason=Message("The search ended."), scenario="carved-46m", parameters=(mu, area),
        correlation=np.array([[1.0, -0.93], [-0.93, 1.0]]), covariance=np.diag([0.0012**2, 0.02**2]),
        points=6, degrees_of_freedom=4, warnings=(Message("Two are hardly told apart"),),
        methods=(Message("By Gauss and Newton"),),
        fits=(cells("a"), cells("b", late=0.02)), profiles=(profile,),
        effort=Effort(simulations=12, kept_simulations=5, rounds=3, wall_s=1.25),
        data=(("cells.csv", Message("photo cells")),),
    )  # fmt: skip


def test_the_terminal_has_every_number_and_what_is_not_known_is_reported(found: Identification) -> None:
    text = identify_summary(found)
    rows = {line.split()[0]: line for line in text.splitlines()}
    for number in ("0.04235", "(0.0399 to 0.0447)", "profile 0.0398 to open", "bootstrap 0.04 to 0.045"):
        assert number in rows["friction.mu_0"]
    assert rows["drag.drag_area_m2"].split(maxsplit=1)[1] == "0.41 m² (0.37 to 0.45)"
    for part in ("6 points", "freedom 4", "12 ", "5 kept", "1.25 s"):
        assert part in text
    nothing = replace(
        found, parameters=(Identified(parameter=MU), Identified(parameter=AREA, value=0.41)), data=(),
        correlation=np.full((2, 2), np.nan), effort=Effort(simulations=12, wall_s=1.25),
    )  # fmt: skip
    lines = identify_summary(nothing).splitlines()
    assert lines[1].split() == ["friction.mu_0", "unknown"]
    assert lines[2].split() == ["drag.drag_area_m2", "0.41", "m²"]
    assert lines[-1] == "12 simulated runs, 1.25 s"


@pytest.mark.usefixtures("undrawn")
def test_the_page_has_its_sections_and_the_table_every_measured_number(found: Identification, tmp_path: Path) -> None:
    said: list[str] = []
    page = write_identify_report(found, identification_dict(found), tmp_path, progress=said.append)
    assert page == tmp_path / "report.html"
    text = page.read_text(encoding="utf-8")
    assert "<strong>0.0423</strong>, 95 % interval [0.0399, 0.0447].</p>" in text
    for heading in (
        "Outcome",
        "Warnings",
        "Measured and identified",
        "Correlations",
        "Profiles",
        "How it was computed",
    ):
        assert f" {heading}</h2>" in text, heading
    assert text.count("<figure") == 2
    for sentence in (
        "mu_0, drag_area: converged", "Outcome: converged. The search ended.", "Two are hardly told apart.",
        "cells.csv was taken for photo cells.", "By Gauss and Newton.", "12 simulated runs, 3 Jacobians, 1.2 s.",
    ):  # fmt: skip
        assert sentence in text, sentence
    assert said[-1] == "report.html"
    with (tmp_path / "fits.csv").open(newline="", encoding="utf-8") as stream:
        rows = list(csv.reader(stream))
    assert rows[0] == ["run", "kind", "along", "quantity", "measured", "identified", "sd"]
    assert rows[1:] == [
        ["a", "photo_cells", "20.0", "time (s)", "3.01", "3.0", "0.004"],
        ["a", "photo_cells", "60.0", "time (s)", "6.5", "6.5", "0.004"],
        ["b", "photo_cells", "20.0", "time (s)", "3.01", "3.0", "0.004"],
        ["b", "photo_cells", "60.0", "time (s)", "6.52", "6.5", "0.004"],
    ]
    assert json.loads((tmp_path / "identification.json").read_text(encoding="utf-8"))["points"] == 6
    names = {path.name for path in (tmp_path / "figures").iterdir()}
    assert names == {f"{name}.{kind}" for name in ("residuals_photo_cells", "profiles") for kind in FORMS}


def test_profiles_are_drawn_with_what_the_curvature_foretells(found: Identification) -> None:
    """Here the profile is the parabola itself: both curves are the same, over the whole width."""
    with journal_style():
        figure = draw_profiles(found)
    (axes,) = figure.axes
    profile, curve, limit = (np.asarray(line.get_xydata(), dtype=float) for line in axes.lines)
    assert profile == pytest.approx(np.stack([found.profiles[0].value, found.profiles[0].rise], axis=1))
    assert curve[[0, -1], 0] == pytest.approx([0.035, 0.05])
    assert np.interp(profile[:, 0], curve[:, 0], curve[:, 1]) == pytest.approx(profile[:, 1], abs=0.01)
    assert limit[:, 1] == pytest.approx([4.0, 4.0])
    assert axes.get_ylim() == pytest.approx((-0.5, 12.0))
    assert axes.get_xlabel() == "mu 0"
    one, four = found.profiles[0], [found.profiles[0]] * 4
    with journal_style():
        panels = draw_profiles(replace(found, profiles=tuple(four))).axes
    assert [axes.get_visible() for axes in panels] == [True] * 4 + [False] * 2  # two rows of three
    area = replace(one, key="drag.drag_area_m2")
    with journal_style():
        assert draw_profiles(replace(found, profiles=(area,))).axes[0].get_xlabel() == "drag area (m²)"


def test_residuals_are_measured_minus_identified_in_a_band_of_two_deviations(found: Identification) -> None:
    with journal_style():
        figure = draw_residuals(found.fits)
    (axes,) = figure.axes
    first, second, zero = (np.asarray(line.get_xydata(), dtype=float) for line in axes.lines)
    assert first == pytest.approx(np.array([[20.0, 0.01], [60.0, 0.0]]))
    assert second == pytest.approx(np.array([[20.0, 0.01], [60.0, 0.02]]))
    assert zero[:, 1].tolist() == [0.0, 0.0]
    band = axes.collections[0].get_paths()[0].get_extents()
    assert (band.x0, band.x1, band.y0, band.y1) == pytest.approx((20.0, 60.0, -0.008, 0.008))
    assert axes.get_xlabel().endswith("(m)") and axes.get_ylabel().endswith("(s)")
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["a", "b"]


def test_tracks_are_seen_from_above_with_the_measured_points() -> None:
    with journal_style():
        figure = draw_tracks([along_a_track("first"), along_a_track("second")])
    (axes,) = figure.axes
    line, points = (np.asarray(drawn.get_xydata(), dtype=float) for drawn in axes.lines[:2])
    assert line[-1] == pytest.approx([10.0, 4.0])
    assert points[-1] == pytest.approx([10.1, 3.8])
    assert axes.get_aspect() == 1.0
    texts = [text.get_text() for text in figure.legends[0].get_texts()]
    assert sorted(texts) == ["first, identified", "first, measured", "second, identified", "second, measured"]
    # 180 mm wide less 25 mm for the axis, and 2 m around: 155 mm for 12.1 m, so 6 m have 78 mm and 25 mm below
    assert figure.get_size_inches()[1] * 25.4 == pytest.approx(155.0 * 6.0 / 12.0 + 25.0, rel=0.02)


ENDS = [[0.1, 0.9], [-1.5, -0.5], [-0.5, 4.5], None, [0.0, 0.2]]


def test_an_offset_shows_where_its_interval_leaves_zero_out() -> None:
    assert count_resolved_offsets([{"interval_mm": ends} for ends in ENDS]) == 2
