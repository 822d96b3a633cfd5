"""A page of a replay with its requests and messages."""

from typing import Any

from ..conftest import DRAWS_IF_ASKED, PATIENCE_MS


def slowly(page: Any) -> None:
    """Play at a tenth of the true speed: a run of seconds is not over before a busy machine has looked."""
    page.get_by_label("Speed of play").select_option("0.1")


WIDTH, HEIGHT = 960, 600


class Watched:
    """A page with all that it asked for and said."""

    def __init__(
        self, browser: Any, address: str, *, width: int = WIDTH, height: int = HEIGHT, plays: bool = False
    ) -> None:
        """Open it; but for `plays` it is stopped and at its start."""
        self.page = browser.new_page(viewport={"width": width, "height": height})
        self.page.set_default_timeout(PATIENCE_MS)
        self.requests: list[str] = []
        self.complaints: list[str] = []
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.on("console", self._heard)
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.add_init_script(DRAWS_IF_ASKED)
        self.page.goto(address)
        self.page.wait_for_function("window.skisnowReplay")
        if not plays:
            self.does("replay.pause(); replay.seek(0)")

    def _heard(self, said: Any) -> None:
        if said.type in {"error", "warning"}:
            self.complaints.append(said.text)

    def does(self, script: str) -> Any:
        """The value of a script in which `replay` is the player."""
        return self.page.evaluate(f"() => {{ const replay = window.skisnowReplay; {script} }}")

    def value(self, of_player: str) -> Any:
        """A property of the player."""
        return self.does(f"return replay.{of_player}")

    def draw(self, on: bool = True) -> None:
        """Start drawing with the present moment, or stop drawing."""
        self.does(f"window.draws = {str(on).lower()}; if (window.draws) replay.draw()")

    def picture(self) -> Any:
        """The canvas alone as an array (height, width, 3)."""
        self.draw()
        import io

        import numpy as np
        from PIL import Image

        others = ":not(.replay-canvas, :has(.replay-canvas)) { visibility: hidden !important }"
        png = self.page.locator("canvas.replay-canvas").screenshot(style=others)
        with Image.open(io.BytesIO(png)) as image:
            return np.asarray(image.convert("RGB")).astype(int)

    def close(self) -> None:
        """Close the page."""
        self.page.close()
