"""Packages of extras: what is missing is named with the extra that brings it."""

import math

from skisnow._support.environment import needed
from skisnow._support.errors import ParameterError
from skisnow._support.messages import Message
from tests.coded import raises


def test_a_package_that_is_there_is_given() -> None:
    assert needed("math", extra="none", what=Message("nothing")) is math


def test_a_missing_one_is_named_with_its_extra_and_what_else_can_be_done() -> None:
    with raises(ParameterError, "package_missing", module="skisnow_nowhere", extra="far") as caught:
        needed("skisnow_nowhere", extra="far", what=Message("A far thing"), instead=Message("Or stay here."))
    assert str(caught.value) == (
        "A far thing needs skisnow_nowhere, which cannot be loaded (No module named 'skisnow_nowhere'). "
        "Install it: pip install 'skisnow[far]'. Or stay here."
    )
