"""The law of shear that a scenario's words name."""

import pytest

from skisnow._support.errors import ParameterError
from skisnow.forces.shear import AngleShear, DensityShear, MachiningShear
from skisnow.scenario.run_settings import Start
from skisnow.scenario.shear import Shear
from tests.coded import raises

S_F = 0.4e6


@pytest.mark.filterwarnings("ignore::skisnow._support.errors.RangeWarning")
def test_each_word_is_its_law_with_the_numbers_given() -> None:
    assert Shear().of(S_F) is None
    assert Shear(law="by-angle", relative_decrease=0.3).of(S_F) == AngleShear(
        flat_shear_stress=S_F, relative_decrease=0.3
    )
    assert Shear(law="by-density", snow_density=400.0).of(S_F) == DensityShear(snow_density=400.0)
    with raises(ParameterError, "missing"):
        Shear(law="by-density")


def test_machining_takes_half_of_the_snows_stress_or_its_own() -> None:
    given = Shear(law="machining", transverse_friction=0.1, least_shear_plane=0.2)
    assert given.of(S_F) == MachiningShear(0.5 * S_F, 0.1, least_shear_plane=0.2)
    own = Shear(law="machining", dynamic_shear_strength=0.1e6, transverse_friction=0.1, least_shear_plane=0.2)
    assert own.of(S_F) == MachiningShear(0.1e6, 0.1, least_shear_plane=0.2)


def test_a_run_starts_where_x_and_y_begin() -> None:
    assert (Start(speed=5.0).x, Start(speed=5.0).y) == (0.0, 0.0)
