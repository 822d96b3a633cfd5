"""What a careful colleague would ask."""

import skisnow
from skisnow.estimation import campaign_notes

from .conftest import MakeCampaign

DENSITY = "sample,site,snow_density_kg_per_m3\n1,oben,400\n2,untem,420\n"


def shear(name: str, site: str) -> tuple[object, ...]:
    return (name, site, "blade", 90, 6, 250, 30)


def test_sites_named_nearly_alike_and_densities_of_no_site(make_campaign: MakeCampaign) -> None:
    campaign = make_campaign(
        shear=[shear("s1", "oben"), shear("s2", "Oben"), shear("s3", "unten")],
        further={"density.csv": DENSITY, "Tests.ods": "not a table"},
    )
    alike, lost, unread = campaign_notes(campaign)
    assert alike.startswith("The sites 'Oben', 'oben' differ")
    assert "density.csv describes 'untem'" in lost
    assert unread.endswith("Tests.ods.")
    assert skisnow.results_dict(skisnow.analyse(campaign))["campaign"]["remarks"] == [alike, lost, unread]


def test_a_campaign_in_order_has_none(make_campaign: MakeCampaign) -> None:
    campaign = make_campaign(
        shear=[shear("s1", "oben"), shear("s2", "unten")], further={"density.csv": DENSITY.replace("untem", "unten")}
    )
    assert campaign_notes(campaign) == ()


def test_corrections_leave_their_trace_in_the_results(make_campaign: MakeCampaign) -> None:
    header = "file,experiment,row,column,old,new,who,when,why\n"
    rows = "shear.csv,s1,2,moment_Nm,30,33,AM,2024-03-14,misread\n"
    campaign = make_campaign(shear=[shear("s1", "oben")], further={"corrections.csv": header + rows})
    results = skisnow.results_dict(skisnow.analyse(campaign))
    assert results["shear"]["experiments"][0]["F_t_N"] == 33 / 0.25
    (told,) = results["campaign"]["corrections"]
    assert (told["file"], told["row"], told["column"], told["old"], told["new"]) == (
        "shear.csv",
        2,
        "moment_Nm",
        "30",
        "33",
    )
    assert (told["who"], told["when"], told["why"]) == ("AM", "2024-03-14", "misread")
