"""What a band over a turn counts beside H_V and S_f: what else the campaign measured, and priors of all it did not."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from .._support.errors import ParameterError
from ..scenario.prior import Measured, Prior, measured_of
from ..snow import SnowProperties

PRIORS: Final = (
    Prior(
        key="snow.unloading_ratio",
        low=2.0,
        high=50.0,
        origin="not measured here, not published; from 2 on the snow keeps half of a groove, at 50 all but all of it",
    ),
    Prior(
        key="snow.shear_displacement_mm",
        low=0.02,
        high=0.5,
        origin="not measured here; from the default, near the limit 0 of the paper's law, to half a millimetre",
    ),
    Prior(
        key="friction.mu_0",
        low=0.4,
        high=2.5,
        about=True,
        origin="as far about the scenario's own as 0.023 and 0.139, the ends of over 200 runs (Wolfsperger and others "
        "2021), are about their geometric middle",
    ),
    Prior(
        key="ski.stiffness_factor",
        low=0.77,
        high=1.3,
        origin="EI and GJ of the catalogue are inferred from an index: natural frequencies to 15 %, stiffness to 30 %",
    ),
)
"""By default."""
MEASURED: Final = ("snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2")
"""Keys whose uncertainty the campaign tells in any case."""


def inputs_with(given: Iterable[Prior], snow: SnowProperties) -> tuple[Measured | Prior, ...]:
    """What the band is drawn from beside H_V and S_f, in the order of its columns.

    A prior that is given comes first, then what the snow has measured with an interval, then the usual prior.

    Raises
    ------
    ParameterError
        One is of what the campaign measures.
    """
    measured = {each.key: each for each in measured_of(snow)}
    found = {each.key: measured.get(each.key, each) for each in PRIORS}
    for each in given:
        if each.key in MEASURED:
            raise ParameterError(f"{each.key} has no prior here: its interval comes from the campaign")
        found[each.key] = each
    return tuple(found.values())
