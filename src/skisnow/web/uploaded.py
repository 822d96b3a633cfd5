"""The work of the process that reads an uploaded campaign; it knows no page, so that it is there soon."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

from .._support.errors import ParameterError
from ..campaign.reading import unfolded
from ..campaign.reading.campaign_file import CAMPAIGN_FILE
from ..campaign.reading.campaign_files import FilesOfFolder
from ..campaign.store import Store
from .unpacking import Unpacking, campaign_folder

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..campaign.store.server import StorePlace
    from .settings import Limits

UNDESCRIBED: Final = (
    "there is no campaign.toml in it, nor a workbook (.xlsx) with the sheets campaign, tools and plates; choose the "
    "folder of a campaign, a zip of it, or such a workbook. Beside tables of your own, skisnow new campaign FOLDER "
    "writes a campaign.toml to be filled in"
)


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
    files = unfolded(FilesOfFolder(folder))
    if CAMPAIGN_FILE not in files.names():
        raise ParameterError(f"{files.found[0].value}. {files.found[0].action}" if files.found else UNDESCRIBED)
    with Store.open(store) as opened:
        return opened.add(folder).id
