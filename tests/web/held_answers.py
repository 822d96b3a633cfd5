"""A connection between page and lab in which the lab's answers may be held back."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Page, WebSocketRoute


class HeldAnswers:
    """Answers of the lab to a page, which may be held back."""

    def __init__(self, page: Page) -> None:
        self._held: list[tuple[WebSocketRoute, str | bytes]] | None = None
        page.route_web_socket("**/*", self._pass_on)

    def _pass_on(self, socket: WebSocketRoute) -> None:
        def answer(message: str | bytes) -> None:
            if self._held is None:
                socket.send(message)
            else:
                self._held.append((socket, message))

        lab = socket.connect_to_server()
        socket.on_message(lab.send)
        lab.on_message(answer)

    def hold(self) -> None:
        self._held = []

    def let_go(self) -> None:
        held, self._held = self._held or [], None
        for socket, message in held:
            socket.send(message)
