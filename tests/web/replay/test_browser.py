"""The replay in a browser that draws in software: seen, moving, by keyboard, on a phone, and alone on its machine."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skisnow.replay import Replay, ReplayTrack, replay_of_run, write_replay

from ...replay.held import ski_edges, snow_heights
from ...replay.test_terrain_and_boots import X, Y, hills, over, run_with_boots
from ...report.runs import circle_run
from .browsers import HEIGHT, WIDTH, Watched, slowly

TRACK = ReplayTrack(name="GNSS", place=np.array([[0.0, 0.0, 0.0], [10.0, 3.0, 0.0]]), time=np.array([0.0, 2.0]))
GATES = np.array([[4.0, 3.0], [9.0, -2.0]])
VIEWS = ("chase", "boot", "above", "edge", "free")


@pytest.fixture(scope="module")
def replay() -> Replay:
    return replay_of_run(circle_run(), title="A turn", track=TRACK, gates=GATES)


@pytest.fixture(scope="module")
def address(replay: Replay, tmp_path_factory: pytest.TempPathFactory) -> str:
    ghost = replay_of_run(circle_run(radius=13.0), title="wider")
    return write_replay(replay, tmp_path_factory.mktemp("page") / "replay.html", ghost=ghost).as_uri()


@pytest.fixture
def fresh(drawing_chromium: Any, address: str) -> Iterator[Watched]:
    """A page that was just opened."""
    watched = Watched(drawing_chromium, address)
    watched.draw()
    yield watched
    watched.close()


@pytest.fixture(scope="module")
def shared(drawing_chromium: Any, address: str) -> Iterator[Watched]:
    watched = Watched(drawing_chromium, address)
    yield watched
    watched.close()


@pytest.fixture
def seen(shared: Watched) -> Watched:
    """A page as it was opened, but for how near the cameras are: opening one takes longer than most tests."""
    shared.page.get_by_label("Speed of play").select_option("1")
    shared.does(
        """replay.draw = () => {};  // once, at the end
           window.draws = false;
           replay.pause(); replay.exaggerate(1); replay.look("boot");
           replay.deepen(8); replay.drawAs("auto");
           for (const name in replay.shown) replay.show(name, name !== "forces");
           delete replay.draw;
           replay.seek(0); document.activeElement.blur();"""
    )
    return shared


def coloured(picture: Any) -> int:
    """Pixels with the warm colours of force, which nothing else has."""
    red, green, blue = picture[..., 0], picture[..., 1], picture[..., 2]
    return int(((red > 150) & (red - blue > 70) & (green < 240)).sum())


def pictures_later(seen: Watched) -> None:
    """Some pictures of the browser later, in which a page that plays would have moved on."""
    seen.page.evaluate(
        "async () => { for (let i = 0; i < 5; i++) await new Promise(done => requestAnimationFrame(done)); }"
    )


@pytest.mark.slow
def test_every_view_shows_snow_and_loaded_skis(seen: Watched) -> None:
    seen.does("replay.seek(2.0)")
    pictures = []
    for view in VIEWS:
        seen.does(f"replay.look('{view}')")
        pictures.append(seen.picture())
        assert coloured(pictures[-1]) > 200, view
        assert (pictures[-1].min(axis=2) > 205).mean() > 0.2, view  # snow, in its light
    for one, other in pairwise(pictures):
        assert (one != other).mean() > 0.1


def test_the_picture_changes_while_it_plays(seen: Watched) -> None:
    first = seen.picture()
    slowly(seen.page)
    seen.does("replay.drawAs('low')")
    seen.page.get_by_role("button", name="Play").click()
    seen.page.wait_for_function("window.skisnowReplay.time > 0.1")
    seen.page.get_by_role("button", name="Pause").click()
    stopped = seen.value("time")
    assert (np.abs(seen.picture() - first).max(axis=2) > 30).mean() > 0.01
    pictures_later(seen)
    assert seen.value("time") == stopped


def played(apart_ms: float) -> str:
    """A script that plays from the run's first second on for two pictures, the browser's clock in its hand."""
    return f"""
        const real = window.requestAnimationFrame, waiting = [];
        window.requestAnimationFrame = (deed) => waiting.push(deed);
        replay.stage.drawn = () => ({{ then: (deed) => deed() }}); // at once
        replay.seek(1.0); replay.play();
        delete replay.stage.drawn;
        waiting.shift()(5000); waiting.shift()({5000 + apart_ms});
        replay.pause(); window.requestAnimationFrame = real;
        return replay.time;"""


def test_a_second_of_play_is_a_second_of_the_run_or_the_chosen_part_of_it(seen: Watched) -> None:
    assert seen.does(played(300.0)) == pytest.approx(1.3, abs=1e-9)
    slowly(seen.page)
    assert seen.does(played(300.0)) == pytest.approx(1.03, abs=1e-9)


def test_a_page_that_was_hidden_continues_from_where_it_was(seen: Watched) -> None:
    """A hidden page is given no pictures: after a minute the run has not ended unseen."""
    assert seen.does(played(60_000.0)) == pytest.approx(2.0, abs=1e-9)


@pytest.mark.slow
def test_the_replay_stops_at_its_end_and_restarts(seen: Watched) -> None:
    seen.does("replay.seek(3.9); replay.play()")
    seen.page.wait_for_function("!window.skisnowReplay.playing")
    assert seen.value("time") == pytest.approx(4.0)
    assert seen.does("replay.play(); return replay.time") < 1.0


def test_the_replay_requests_nothing_and_logs_no_error(seen: Watched, address: str) -> None:
    seen.draw()
    for view in VIEWS:
        seen.does(f"replay.look('{view}'); replay.exaggerate(7); replay.show('forces', true); replay.seek(1.0)")
    pictures_later(seen)
    assert [each for each in seen.requests if not each.startswith(("blob:", "data:"))] == [address]
    assert seen.complaints == []


def test_edges_in_the_browser_are_those_of_the_library(seen: Watched, replay: Replay) -> None:
    for time, frame, factor in ((2.0, 100, 1.0), (3.0, 150, 4.0)):
        expected = ski_edges(replay, frame, exaggeration=factor)
        for ski in (0, 1):
            found = np.array(seen.does(f"return replay.edgesAt({time}, {ski}, {factor})"))
            # float32 over 30 m, and half a step of the bending four times
            assert found.transpose(1, 0, 2) == pytest.approx(expected[ski], abs=5e-6)


def test_readings_are_the_runs_numbers_with_units(seen: Watched) -> None:
    seen.does("replay.seek(2.0)")
    text = seen.page.locator(".replay-readings").inner_text()
    for words in ("2.00 s", "8.00 m/s", "12.0 m left", "mm"):
        assert words in text
    legend = seen.page.locator(".replay-legend").inner_text()
    assert "(N/mm)" in legend
    assert "(mm)" in legend


def test_the_replay_opens_playing_with_the_camera_behind(drawing_chromium: Any, address: str) -> None:
    """Both skis and the groove behind them are on the picture, and gravity points down in it."""
    seen = Watched(drawing_chromium, address, plays=True)
    try:
        seen.page.wait_for_function("window.skisnowReplay.time > 0.1")
        assert seen.value("stage.follower.view") == "chase"
        on_picture = seen.does(
            """replay.pause(); replay.seek(2.0);
               const { camera } = replay.stage.follower, world = replay.stage.space;
               const at = (place) =>
                   world.localToWorld(camera.position.clone().set(...place)).project(camera).toArray();
               const edges = [0, 1].flatMap((ski) => replay.edgesAt(2.0, ski).flat()).map(at);
               const groove = replay.run.arrays.groove_middle.values, times = replay.run.arrays.groove_time.values;
               const last = times.findLastIndex((time) => time < 1.9);
               return { edges, groove: at(groove.subarray(3 * last, 3 * last + 3)), up: camera.up.toArray() };"""
        )
        inside = np.abs(np.array([*on_picture["edges"], on_picture["groove"]])[:, :2])
        assert inside.max() < 1.0
        assert on_picture["up"] == [0, 0, 1]
        boot = np.array(on_picture["edges"])[:, 1].mean()
        assert on_picture["groove"][1] < boot  # the earlier cut is nearer to the eye
    finally:
        seen.close()


def test_the_fall_line_points_down_the_slope_and_poles_stand_against_gravity(seen: Watched) -> None:
    """On a plane of 10°: the arrow falls by sin 10° a metre; a pole's top stands over its foot."""
    arrow, pole = seen.does(
        """const { fallLine, space } = replay.stage, at = (mesh, x, y, z) => {
               const place = space.position.clone().set(x, y, z);
               return mesh.localToWorld(place).toArray();
           };
           space.updateMatrixWorld(true);
           const shaft = fallLine.group.children[0], poles = space.children.find((each) => each.name === "poles");
           const box = poles.children[0].geometry; box.computeBoundingBox();
           const { min, max } = box.boundingBox;
           return [[at(shaft, 0, 0, 0), at(shaft, 1, 0, 0)], [[min.x, max.x], [min.z, max.z]]];"""
    )
    way = np.array(arrow[1]) - np.array(arrow[0])
    assert way == pytest.approx([np.cos(np.radians(10)), 0.0, -np.sin(np.radians(10))], abs=1e-6)
    (low_x, high_x), (low_z, high_z) = pole
    # the top leans up the slope by the slope's angle in the run's own axes: 1.5 m against x
    assert low_x == pytest.approx(-1.5 * np.sin(np.radians(10)), abs=0.03)
    assert high_x < 0.03
    assert high_z - low_z == pytest.approx(1.5 * np.cos(np.radians(10)), abs=0.03)


def test_gates_stand_where_they_are_red_and_blue_by_turns(seen: Watched) -> None:
    found = seen.does(
        """const gates = replay.stage.space.children.find((each) => each.name === "gates");
           const colour = (each) => each.material.color.getHex();
           return gates.children.map((each) => [[...each.instanceMatrix.array.slice(12, 14)], colour(each)]);"""
    )
    assert found == [[[4, 3], 0xD0342C], [[9, -2], 0x1F5FBF]]


@pytest.mark.slow
def test_the_groove_is_as_deep_as_the_slider_says(seen: Watched) -> None:
    """Where one looks down into it; at its true depth of 20 mm it is hardly seen."""
    seen.does("replay.look('edge'); replay.show('ghost', false); replay.seek(2.0)")
    pictures = []
    for times in ("1", "16"):
        seen.page.get_by_label("Exaggeration of the groove").fill(times)
        assert seen.value("stage.groove.mesh.material.uniforms.times.value") == int(times)
        pictures.append(seen.picture())
    assert (np.abs(pictures[1] - pictures[0]).max(axis=2) > 30).mean() > 0.005


def test_the_groove_is_deepest_where_the_edge_is(seen: Watched) -> None:
    """An edge angle of 30° to the left: base and wall share the width as cos² and sin², the wall left of the base."""
    assert seen.does("return [...new Set(replay.stage.groove.mesh.geometry.attributes.lowest.array)]") == [0.5]


def test_forces_are_arrows_and_numbers_on_demand(seen: Watched, replay: Replay) -> None:
    seen.does("replay.seek(2.0)")
    assert "on left ski" not in seen.page.locator(".replay-readings").inner_text()
    before = seen.picture()
    seen.page.get_by_label("Forces", exact=True).check()
    assert (np.abs(seen.picture() - before).max(axis=2) > 30).mean() > 0.001
    text = seen.page.locator(".replay-readings").inner_text()
    frame = int(np.argmin(np.abs(replay.time - 2.0)))
    for ski, side in enumerate(("left", "right")):
        total, normal = np.linalg.norm(replay.skis.force[frame, ski]), replay.skis.normal_force[frame, ski]
        for name, force in (("Total", total), ("Normal", normal)):
            told = float(text.split(f"{name} force on {side} ski")[1].split("N")[0])
            assert told == pytest.approx(force, abs=0.6)


def test_effects_step_down_where_the_machine_is_slow_and_stay_where_it_was_chosen(seen: Watched) -> None:
    slow = "for (let i = 0; i < 200; i++) replay.sharpness.took(90);"
    read = "return [replay.sharpness.ratio, replay.sharpness.effects];"
    seen.does("replay.drawAs('auto')")
    assert seen.does(read) == [1, 2]
    assert seen.does(slow + read) == [0.5, 0]
    seen.does("replay.drawAs('full')")
    assert seen.does(slow + read) == [1, 2]
    seen.does("replay.drawAs('low')")
    quick = "for (let i = 0; i < 200; i++) replay.sharpness.took(5);"
    assert seen.does(quick + read) == [0.5, 0]


def test_the_time_runs_from_the_first_picture_on(seen: Watched) -> None:
    """However long the browser takes to draw it."""
    found = seen.does("""return (async () => {
        const { stage } = replay;
        let drawn;
        stage.drawn = () => new Promise((done) => { drawn = done; });
        replay.pause(); replay.seek(0); replay.play();
        delete stage.drawn;
        const picture = () => new Promise(requestAnimationFrame);
        for (let i = 0; i < 5; i++) await picture();
        const before = replay.time;
        drawn();
        while (replay.time === 0) await picture();
        replay.pause();
        return [before, replay.time > 0];
    })()""")
    assert found == [0, True]


@pytest.mark.slow
def test_ghost_and_measured_track_are_switches(seen: Watched) -> None:
    seen.does("replay.seek(1.0); replay.look('above')")
    everything = seen.picture()
    for name in ("Other run: wider", "Measured: GNSS"):
        seen.page.get_by_label(name).uncheck()
        fewer = seen.picture()
        assert (np.abs(fewer - everything).max(axis=2) > 25).sum() > 100, name
        everything = fewer


def test_everything_by_keyboard(seen: Watched) -> None:
    slowly(seen.page)
    keyboard = seen.page.keyboard
    seen.page.locator("canvas.replay-canvas").focus()
    keyboard.press("ArrowRight")
    keyboard.press("Shift+ArrowRight")
    assert seen.value("time") == pytest.approx(0.55)
    keyboard.press("End")
    assert seen.value("time") == pytest.approx(4.0)
    keyboard.press("Home")
    for key, view in (("3", "above"), ("4", "edge"), ("5", "free"), ("2", "boot"), ("1", "chase")):
        keyboard.press(key)
        assert seen.value("stage.follower.view") == view
        assert seen.page.locator(f'[data-view="{view}"]').get_attribute("aria-pressed") == "true"
    keyboard.press("d")
    assert seen.value("stage.follower.view") == "free"
    keyboard.press("c")
    assert seen.value("exaggeration") == 2
    keyboard.press("b")
    assert seen.value("relief") == 9
    keyboard.press("f")
    assert seen.page.get_by_label("Forces", exact=True).is_checked()
    keyboard.press("g")
    assert not seen.page.get_by_label("Groove", exact=True).is_checked()
    keyboard.press(" ")
    assert seen.value("playing")
    keyboard.press(" ")
    assert not seen.value("playing")


def test_every_control_has_a_name(seen: Watched) -> None:
    unnamed = seen.does(
        """return [...document.querySelectorAll("button, input, select, canvas, a")].filter((each) =>
            !(each.getAttribute("aria-label") || each.textContent.trim() || each.closest("label")?.textContent.trim())
        ).map((each) => each.outerHTML)"""
    )
    assert unnamed == []


@pytest.mark.slow
def test_dragging_turns_and_the_wheel_comes_nearer(fresh: Watched) -> None:
    box = fresh.page.locator("canvas.replay-canvas").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    fresh.page.mouse.move(x, y)
    before = fresh.value("stage.follower.camera.position.length()")
    fresh.page.mouse.down()
    fresh.page.mouse.move(x + 80, y - 40)
    fresh.page.mouse.up()
    assert fresh.value("stage.follower.view") == "free"
    zoom = fresh.value("stage.follower.zoom.free")
    fresh.page.mouse.wheel(0, -300)
    fresh.page.wait_for_function(f"window.skisnowReplay.stage.follower.zoom.free < {zoom}")
    assert before > 0.0


@pytest.mark.slow
def test_picture_and_film_are_files(fresh: Watched, tmp_path: Path) -> None:
    from PIL import Image

    fresh.does("replay.seek(3.4)")
    with fresh.page.expect_download() as download:
        fresh.page.get_by_role("button", name="Picture (PNG)").click()
    download.value.save_as(tmp_path / "turn.png")
    with Image.open(tmp_path / "turn.png") as image:
        assert image.width >= 1280
        assert coloured(np.asarray(image.convert("RGB")).astype(int)) > 300
    film = fresh.page.get_by_role("button", name="Film (WebM)")
    if film.is_disabled():
        pytest.skip("this Chromium records no WebM film")
    with fresh.page.expect_download() as download:
        film.click()
    download.value.save_as(tmp_path / "turn.webm")
    content = (tmp_path / "turn.webm").read_bytes()
    assert content[:4] == b"\x1a\x45\xdf\xa3"  # EBML, which WebM is
    assert len(content) > 5000


@pytest.mark.slow
def test_moving_boots_over_measured_heights(drawing_chromium: Any, tmp_path: Path) -> None:
    """Skis stand where the boots have them, on a mesh of the heights; brackets and shadows go with them."""
    run = run_with_boots()
    replay = replay_of_run(replace(run, scenario=over(hills(X[:, None], Y)).scenario), gates=GATES)
    assert replay.terrain is not None
    seen = Watched(drawing_chromium, write_replay(replay, tmp_path / "terrain.html").as_uri())
    try:
        for ski in (0, 1):
            found = np.array(seen.does(f"return replay.edgesAt({replay.time[3]}, {ski}, 1)"))
            assert found.transpose(1, 0, 2) == pytest.approx(ski_edges(replay, 3)[ski], abs=2e-5)
        mesh = np.array(seen.does("return [...replay.stage.surface.geometry.attributes.position.array]")).reshape(-1, 3)
        assert len(mesh) == (len(replay.terrain.x) + 2) * (len(replay.terrain.y) + 2)
        assert mesh[:, 2] == pytest.approx(snow_heights(replay.terrain, *mesh[:, :2].T), abs=1e-4)
        bracket, boot = seen.does(
            """replay.seek(replay.end);
               const { place } = replay.run.arrays, sledge = replay.stage.skis.group.children[4];
               sledge.updateMatrixWorld(true);
               const at = replay.stage.space.worldToLocal(sledge.children[0].getWorldPosition(sledge.position.clone()));
               return [at.toArray(), [...replay.run.arrays.boot_place.values.slice(-6, -3)]];"""
        )
        assert bracket == pytest.approx(boot, abs=1e-4)
        for view in VIEWS:
            seen.does(f"replay.seek(2.0); replay.look('{view}')")
            assert coloured(seen.picture()) > 100, view
        assert seen.complaints == []
    finally:
        seen.close()


@pytest.mark.parametrize(("width", "height"), [(390, 844), (844, 390)])
def test_a_phone_shows_it_all_without_scrolling_sideways(seen: Watched, width: int, height: int) -> None:
    phone = seen
    phone.page.set_viewport_size({"width": width, "height": height})
    try:
        phone.does("replay.seek(2.0)")
        assert phone.page.locator("html").evaluate("each => each.scrollWidth") <= width
        assert coloured(phone.picture()) > 100
        cut = phone.does(
            f"""return [...document.querySelectorAll("button, select, input, label")].filter((each) => {{
                const box = each.getBoundingClientRect();
                return box.width && (box.left < -1 || box.right > {width} + 1);
            }}).map((each) => each.outerHTML)"""
        )
        assert cut == []
        small = phone.does(
            """return [...document.querySelectorAll("button, select")].filter((each) => {
                const box = each.getBoundingClientRect();
                return box.height < 44 || box.width < 44;
            }).map((each) => each.outerHTML)"""
        )
        assert small == []  # a finger in a glove
    finally:
        phone.page.set_viewport_size({"width": WIDTH, "height": HEIGHT})
