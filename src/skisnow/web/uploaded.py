"""The work of the process that reads an uploaded campaign; it knows no page, so that it is there soon."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import ParameterError
from ..field.store import Store
from .unpacking import Unpacking, campaign_folder

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..field.store.address import StorePlace
    from .settings import Limits


def add_uploaded(store: StorePlace, place: str, names: Sequence[str], limits: Limits) -> str:
    """Keep a campaign of uploaded files, which lie in a folder under their numbers; gives its id.

    Raises
    ------
    ParameterError
        A file cannot be taken in, or there is no campaign in them.
    StoreError
        The store cannot be written.
    """
    unpacking = Unpacking(Path(place) / "campaign", limits)
    unpacking.folder.mkdir()
    for number, name in enumerate(names):
        with (Path(place) / str(number)).open("rb") as file:
            (unpacking.take_zip if name.lower().endswith(".zip") else partial(unpacking.take, name))(file)
    folder = campaign_folder(unpacking.folder)
    if not (folder / "campaign.toml").is_file():
        raise ParameterError("there is no campaign.toml in it; choose the folder of a campaign, or a zip of it")
    with Store.open(store) as opened:
        return opened.add(folder).id
