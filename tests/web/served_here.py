"""The program of a process that has loaded the lab already; given are a store, a port and where to tell the address."""

from __future__ import annotations

from skisnow.field.store import Store
from skisnow.web.server import serve
from skisnow.web.settings import Lab

if __name__ == "__main__":
    place, port, tells = globals()["given"]
    with Store.open(place) as store:
        serve(Lab(store, place.parent / "lab"), host="127.0.0.1", port=port, token=None, tell=tells.send)
