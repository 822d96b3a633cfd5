"""The paper's first finding on the synthetic campaign with its design: volume beats area, area beats depth."""

import pytest

from skisnow.campaign import reference_campaign
from skisnow.estimation.hardness import DEFINITIONS, hardness_at_largest_load
from skisnow.estimation.models import fit_models, select_model
from skisnow.estimation.readings import readings_of
from skisnow.estimation.screening import screened_penetration
from skisnow.snow.published.moessner_2013 import PRINTED_RMSE_N


@pytest.mark.parametrize("seed", range(10))
def test_depth_is_worst_and_volume_best(seed: int) -> None:
    campaign = reference_campaign(seed).campaign()
    assert campaign.penetration is not None
    used = screened_penetration(campaign, geometry="extended").used
    readings = readings_of(campaign.penetration, campaign.tools, geometry="extended").of(used)
    fits = fit_models(readings, {symbol: hardness_at_largest_load(readings, d) for symbol, d in DEFINITIONS.items()})
    rmse = {fit.model.id: fit.rmse for fit in fits}
    for found in (rmse, PRINTED_RMSE_N):
        for terms in ("linear", "constant"):
            H_e, H_A, H_V = (found[f"{symbol}:a={terms},b={terms}"] for symbol in DEFINITIONS)
            assert H_e > H_A > H_V
        last = [value for name, value in found.items() if name.startswith("H_V")]
        assert max(last) < 1.05 * min(last)
    assert select_model(fits).model.id == "H_V:a=none,b=one"
