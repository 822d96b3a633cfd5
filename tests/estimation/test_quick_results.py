"""What is shown while a campaign is entered are the numbers of its analysis."""

from pathlib import Path

from skisnow.campaign import read_campaign, write_reference
from skisnow.estimation import analyse, results_dict
from skisnow.estimation.result_rows import experiment_results


def test_the_numbers_are_those_of_the_analysis(tmp_path: Path) -> None:
    write_reference(tmp_path / "campaign", seed=2)
    campaign = read_campaign(tmp_path / "campaign")
    results = results_dict(analyse(campaign, n_resamples=100))
    found = experiment_results(campaign)
    assert found["penetration"]["experiments"] == results["penetration"]["experiments"]
    assert found["shear"]["experiments"] == results["shear"]["experiments"]
