"""A campaign whose files are at hand is read as one in a folder, and nothing is searched on the disk."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.errors import FieldDataError
from skisnow.campaign import Campaign, campaign_of_files, read_campaign
from skisnow.estimation import analyse, results_dict

WriteCampaign = Callable[[Mapping[str, str]], Path]


def at_hand(files: Mapping[str, str]) -> dict[str, bytes]:
    return {name: text.encode("utf-8") for name, text in files.items()}


def numbers_of(campaign: Campaign) -> dict[str, object]:
    results = results_dict(analyse(campaign, n_resamples=100))
    return {key: value for key, value in results.items() if key != "provenance"} | {
        "files": results["provenance"]["files"]
    }


def test_results_are_those_of_the_folder(write_campaign: WriteCampaign, small_campaign: dict[str, str]) -> None:
    small_campaign["notes.txt"] = "wind"
    folder = read_campaign(write_campaign(small_campaign))
    campaign = campaign_of_files(at_hand(small_campaign))
    assert numbers_of(campaign) == numbers_of(folder)
    assert campaign.unread_files == folder.unread_files == ("notes.txt",)
    assert campaign.penetration is not None
    assert folder.penetration is not None
    assert np.array_equal(campaign.penetration.load, folder.penetration.load)


def test_nothing_is_opened(small_campaign: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object, **__: object) -> None:
        raise AssertionError("the disk was asked")

    files = at_hand(small_campaign)
    for name in ("stat", "lstat", "scandir", "listdir"):
        monkeypatch.setattr(os, name, refused)
    monkeypatch.setattr(Path, "open", refused)
    assert campaign_of_files(files).name == "north slope"


def test_errors_are_those_of_the_folder(write_campaign: WriteCampaign, small_campaign: dict[str, str]) -> None:
    small_campaign["shear.csv"] = small_campaign["shear.csv"].replace("12.25", "twelve")
    small_campaign["Density.csv"] = small_campaign.pop("density.csv")
    with pytest.raises(FieldDataError) as told:
        read_campaign(write_campaign(small_campaign))
    with pytest.raises(FieldDataError) as found:
        campaign_of_files(at_hand(small_campaign))
    assert found.value.problems == told.value.problems
    assert len(found.value.problems) == 2


def test_files_that_are_named_alone_are_told(small_campaign: dict[str, str]) -> None:
    campaign = campaign_of_files(at_hand(small_campaign), others=("photo.jpg", ".hidden"))
    assert campaign.unread_files == ("photo.jpg",)
