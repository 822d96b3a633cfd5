"""Take the picture of the model that moves for the docs, in three.js: python docs/figures_of_moving_model.py.

Playwright, Chromium and NiceGUI, which brings three.js with its GLTFLoader, must be there (another place of Chromium:
SKISNOW_CHROMIUM).
"""

from __future__ import annotations

import importlib.util
import io
import os
import shutil
from pathlib import Path
from typing import Any

from PIL import Image

from skisnow import load_scenario, simulate
from skisnow.replay import moving_replay_model, replay_of_run

PLACE = Path(__file__).resolve().parent / "_static" / "replay" / "moving-model.webp"
MOMENTS = (0.5, 2.0, 3.5, 5.0)
QUALITY = 88
SOFTWARE = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
SITE = "http://model.test/"  # answered by this program
PAGE = """<!doctype html><style>body { margin: 0 }</style><canvas width="1120" height="700"></canvas>
<script type="module">
import { GLTFLoader, THREE } from "./three.js";
const model = await new GLTFLoader().loadAsync("./model.glb");
const renderer = new THREE.WebGLRenderer({ canvas: document.querySelector("canvas"), antialias: true });
const scene = new THREE.Scene();
scene.background = new THREE.Color(0xa9c6de);
const sun = new THREE.DirectionalLight(0xffffff, 1.6);
sun.position.set(-3, 10, 4);
scene.add(model.scene, sun, new THREE.HemisphereLight(0xffffff, 0xaabbcc, 1.6));
const mixer = new THREE.AnimationMixer(model.scene);
const action = mixer.clipAction(model.animations[0]);
action.setLoop(THREE.LoopOnce);
action.clampWhenFinished = true;
const camera = model.cameras[0];
camera.aspect = 1.6;
camera.updateProjectionMatrix();
window.show = (time) => {
  action.reset().play();
  mixer.setTime(time);
  renderer.render(scene, camera);
};
</script>"""


def answers(model: bytes) -> dict[str, tuple[bytes, str]]:
    """What the page asks for."""
    found = importlib.util.find_spec("nicegui")
    if found is None or found.origin is None:
        raise SystemExit("NiceGUI is not installed: pip install 'skisnow[web]'")
    three = Path(found.origin).parent / "elements" / "scene" / "dist" / "index.js"
    return {
        SITE: (PAGE.encode(), "text/html"),
        f"{SITE}three.js": (three.read_bytes(), "text/javascript"),
        f"{SITE}model.glb": (model, "model/gltf-binary"),
    }


def pictures(model: bytes) -> list[Image.Image]:
    """Of each moment, from the model's own camera."""
    from playwright.sync_api import sync_playwright

    known = answers(model)

    def answer(route: Any) -> None:
        body, kind = known.get(route.request.url, (b"", "text/plain"))
        route.fulfill(body=body, content_type=kind)

    taken = []
    with sync_playwright() as playwright:
        place = (
            os.environ.get("SKISNOW_CHROMIUM") or shutil.which("chromium-headless-shell") or shutil.which("chromium")
        )
        browser = playwright.chromium.launch(executable_path=place, args=SOFTWARE)
        page = browser.new_page(viewport={"width": 1120, "height": 700})
        page.route(f"{SITE}**", answer)
        page.goto(SITE)
        page.wait_for_function("'show' in window")
        for moment in MOMENTS:
            page.evaluate("(time) => show(time)", moment)
            with Image.open(io.BytesIO(page.screenshot())) as image:
                taken.append(image.convert("RGB").resize((560, 350), Image.Resampling.LANCZOS))
        browser.close()
    return taken


def main() -> None:
    """Simulate, make the model, look at it, four moments in one picture."""
    run = simulate(load_scenario("carved-46m"))
    taken = pictures(moving_replay_model(replay_of_run(run, title="carved-46m"), exaggeration=5.0))
    whole = Image.new("RGB", (2 * 560 + 8, 2 * 350 + 8), "white")
    for number, each in enumerate(taken):
        whole.paste(each, ((number % 2) * 568, (number // 2) * 358))
    whole.save(PLACE, quality=QUALITY, method=6)


if __name__ == "__main__":
    main()
