"""The model that moves in a real browser, played by three.js's own GLTFLoader, which NiceGUI brings along."""

import importlib.util
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skisnow._support.units import DEGREE
from skisnow.replay import Replay, moving_replay_model, replay_of_run
from tests.present import present

from ...replay.test_moving_model import SKIS, by_hand, to_run
from ...report.runs import circle_run

SITE = "http://model.test/"  # answered by the test itself: nothing leaves the machine
SIZE = {"width": 240, "height": 135}

PAGE = """<!doctype html><style>body { margin: 0 }</style><canvas width="240" height="135"></canvas>
<script type="module">
import { GLTFLoader, THREE } from "./three.js";
const model = await new GLTFLoader().loadAsync("./model.glb");
const canvas = document.querySelector("canvas");
const renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
const scene = new THREE.Scene();
scene.background = new THREE.Color(0x5f87aa);
const sun = new THREE.DirectionalLight(0xffffff, 1.5);
sun.position.set(-3, 10, 4);
scene.add(model.scene, sun, new THREE.HemisphereLight(0xffffff, 0x99aabb, 1.2));
const mixer = new THREE.AnimationMixer(model.scene);
const action = mixer.clipAction(model.animations[0]);
action.setLoop(THREE.LoopOnce);
action.clampWhenFinished = true;
action.play();
const camera = model.cameras[0];
camera.aspect = 960 / 540;
camera.updateProjectionMatrix();
window.lab = {
  revision: THREE.REVISION,
  clips: model.animations.map((clip) => [clip.name, clip.duration]),
  at(time) {
    action.reset().play();
    mixer.setTime(time);
    scene.updateMatrixWorld(true);
    renderer.render(scene, camera);
  },
  vertices(name) {
    const mesh = model.scene.getObjectByName(THREE.PropertyBinding.sanitizeNodeName(name));
    const place = new THREE.Vector3();
    return Array.from({ length: mesh.geometry.attributes.position.count }, (_, i) =>
      mesh.getVertexPosition(i, place).applyMatrix4(mesh.matrixWorld).toArray());
  },
  drawn: (name) => {
    const mesh = model.scene.getObjectByName(THREE.PropertyBinding.sanitizeNodeName(name));
    const seen = new THREE.Frustum().setFromProjectionMatrix(
      new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse));
    return seen.intersectsObject(mesh);
  },
};
</script>"""


@pytest.fixture(scope="module")
def replay() -> Replay:
    return replay_of_run(circle_run(count=401), title="A turn")


@pytest.fixture(scope="module")
def page(drawing_chromium: Any, replay: Replay) -> Iterator[Any]:
    bundle = three()
    answers = {
        SITE: (PAGE.encode(), "text/html"),
        f"{SITE}three.js": (bundle, "text/javascript"),
        f"{SITE}model.glb": (moving_replay_model(replay), "model/gltf-binary"),
    }
    shown = drawing_chromium.new_page(viewport=SIZE)
    said: list[str] = []
    shown.on("pageerror", lambda error: said.append(str(error)))
    shown.on("console", lambda word: said.append(word.text) if word.type in {"error", "warning"} else None)
    shown.route(f"{SITE}**", lambda route: _answer(route, answers))
    shown.goto(SITE)
    shown.wait_for_function("window.lab")
    yield shown
    shown.close()
    assert [word for word in said if "favicon" not in word and "GPU stall" not in word] == []


def three() -> bytes:
    """A module with three.js and its GLTFLoader, of the NiceGUI that is installed."""
    found = present(importlib.util.find_spec("nicegui"))
    module = Path(present(found.origin)).parent / "elements" / "scene" / "dist" / "index.js"
    if not module.is_file() or b"GLTFLoader" not in module.read_bytes():
        pytest.skip("this NiceGUI brings no GLTFLoader along")
    return module.read_bytes()


def _answer(route: Any, answers: dict[str, tuple[bytes, str]]) -> None:
    if route.request.url not in answers:
        route.fulfill(status=204)
        return
    body, kind = answers[route.request.url]
    route.fulfill(body=body, content_type=kind)


def test_the_model_has_one_clip_of_the_run_s_duration(page: Any) -> None:
    ((name, duration),) = page.evaluate("lab.clips")
    assert name == "run"
    assert duration == pytest.approx(4.0, abs=1e-6)


@pytest.mark.parametrize("time", [0.0, 0.777, 2.0, 3.4449, 4.0])
def test_three_js_has_the_skis_where_the_circle_has_them(page: Any, time: float) -> None:
    page.evaluate("(time) => lab.at(time)", time)
    corners = np.array([page.evaluate("(name) => lab.vertices(name)", name) for name in SKIS]).reshape(2, -1, 8, 3)
    # as in the reader by hand: 0.067 mm by straight ways between keys, and float32 in the browser's sums
    assert to_run(corners[:, :, [3, 2]], 10.0 * DEGREE) == pytest.approx(by_hand(time), abs=1.2e-4)
    assert [page.evaluate("(name) => lab.drawn(name)", name) for name in SKIS] == [True, True]


def test_groove_appears_in_three_js(page: Any, replay: Replay) -> None:
    def grown(time: float) -> bool:
        page.evaluate("(time) => lab.at(time)", time)
        place = np.array(page.evaluate("lab.vertices('groove to 2.00 s')"))
        return bool(np.ptp(place, axis=0).max() > 0.0)

    assert (replay.groove.time == 2.0).any()
    assert [grown(time) for time in (0.0, 1.99, 2.001, 3.9)] == [False, False, True, True]
