"""Packages of extras: what is missing is named with the extra that brings it."""

import math

import pytest

from skisnow._support.errors import ParameterError
from skisnow._support.optional_packages import needed


def test_a_package_that_is_there_is_given() -> None:
    assert needed("math", extra="none", what="nothing") is math


def test_a_missing_one_is_named_with_its_extra_and_what_else_can_be_done() -> None:
    with pytest.raises(ParameterError) as refused:
        needed("skisnow_nowhere", extra="far", what="a far thing", instead="; or stay here")
    assert str(refused.value) == (
        "a far thing needs skisnow_nowhere, which cannot be loaded (No module named 'skisnow_nowhere'): "
        "pip install 'skisnow[far]'; or stay here"
    )
