from __future__ import annotations

import pytest

from annotations.campaigns.answering import save_answer
from annotations.campaigns.tasks import begin
from annotations.models.campaigns import ContributorKind
from tests.launched_campaigns import small_campaign
from tests.sample_world import make_paraphrase

FIGURES = "/w/home/paraphrases/figures/"
API = "/api/v1/worlds/home/paraphrase-figures/"


@pytest.fixture
def campaign(world):
    return small_campaign(world)


@pytest.fixture
def paraphrases(world, campaign):
    """Two paraphrases of people and one of a model, which came by the campaign."""
    model = campaign.contributors.create(kind=ContributorKind.MODEL, pseudonym="m")
    return [
        make_paraphrase(world, utterance="fetch it", logical_form="( go 1 )"),
        make_paraphrase(world, utterance="get it", logical_form="( go 1 )", edit_distance=3),
        make_paraphrase(world, utterance="obtain it", logical_form="( go 2 )", contributor=model),
    ]


def test_an_empty_world_says_what_to_do(world, rene, client, admin):
    assert "campaigns/new/" not in rene.get(FIGURES).content.decode()
    client.force_login(admin)
    assert "/w/home/campaigns/new/" in client.get(FIGURES).content.decode()
    for page in ("forms/", "contributors/"):
        answer = client.get(f"{FIGURES}{page}")
        assert (answer.status_code, answer.context["listing"].total) == (200, 0)


def test_the_page_has_charts_of_people_and_of_models(paraphrases, rene):
    context = rene.get(FIGURES).context
    for name in ("edit_chart", "jaccard_chart"):
        chart = context[name]
        assert [each["name"] for each in chart["series"]] == ["people", "models"]
        for each in chart["series"]:
            assert len(each["values"]) == len(chart["x"]["values"])
            assert sum(each["values"]) == pytest.approx(100)
    growth = context["growth_chart"]
    assert growth["x"]["values"] == [1, 2]
    assert [each["values"] for each in growth["series"]] == [[2, 3], [2, None]]


def test_a_campaign_is_chosen_and_an_unknown_one_is_ignored(paraphrases, campaign, rene):
    assert rene.get(FIGURES, {"campaign": campaign.pk}).context["figures"].count == 1
    for sent in ("0", "x", "99999999999999999999", "\0"):
        assert rene.get(FIGURES, {"campaign": sent}).context["figures"].count == 3


def test_forms_are_filtered_and_lead_to_a_campaign(paraphrases, campaign, rene, client, admin):
    def forms(**asked) -> list[str]:
        return [row.form for row, _ in rene.get(f"{FIGURES}forms/", asked).context["rows"]]

    assert forms() == ["( go 2 )", "( go 1 )"]
    assert forms(target=2, short="short") == ["( go 2 )"]
    assert forms(target=2, short="reached") == ["( go 1 )"]
    assert forms(sort="-people") == ["( go 2 )", "( go 1 )"]
    assert forms(sort="people") == ["( go 1 )", "( go 2 )"]
    assert forms(target="many") == forms()
    assert forms(task_category="none such") == forms()
    client.force_login(admin)
    form = client.get("/w/home/campaigns/new/?target_per_form=7&task_categories=1").context["form"]
    assert form["target_per_form"].value() == 7
    assert form["task_categories"].value() == ["1"]


def test_contributors_are_sorted_and_link_to_their_submissions(campaign, rene, anna):
    for name, seconds in (("f00d", 5), ("beef", 3)):
        for place in begin(campaign, name).submissions.filter(kind="rewrite"):
            save_answer(place, f"{name} would do it", seconds)

    def names(**asked) -> list[str]:
        rows = rene.get(f"{FIGURES}contributors/", asked).context["listing"].rows
        return [row.contributor.pseudonym for row in rows]

    assert names(sort="pace") == ["beef", "f00d"]
    assert names(sort="-pace") == ["f00d", "beef"]
    assert names(campaign=campaign.pk, sort="acceptance") == names()
    assert "submissions/?contributor=" in rene.get(f"{FIGURES}contributors/").content.decode()
    assert "submissions/?contributor=" not in anna.get(f"{FIGURES}contributors/").content.decode()


def test_rest_gives_the_same_figures(paraphrases, campaign, rene):
    answer = rene.get(API).json()
    assert (answer["people"]["count"], answer["models"]["count"]) == (2, 1)
    assert answer["people"]["edits"] == 2
    assert answer["people"]["growth"] == [
        {"paraphrases": 1, "words": 2},
        {"paraphrases": 2, "words": 3},
    ]
    assert (answer["published"]["edits"], answer["published"]["jaccard"]) == (28.02, 0.59)
    assert len(answer["edit_bins"]) == len(answer["people"]["edit_counts"])
    assert rene.get(API, {"campaign": campaign.pk}).json()["people"]["count"] == 0
    assert rene.get(API, {"campaign": 0}).status_code == 400
    assert rene.get(API, {"campaign": campaign.pk + 1}).status_code == 400
    forms = rene.get(f"{API}forms/", {"target": 2}).json()
    assert (forms["count"], forms["target"]) == (2, 2)
    assert [row["lacks"] for row in forms["results"]] == [1, 0]


def test_rest_lists_contributors_by_pseudonyms(campaign, rene):
    (place, *_) = begin(campaign, "f00d").submissions.filter(kind="rewrite")
    save_answer(place, "would do it", 4)
    (row,) = rene.get(f"{API}contributors/").json()["results"]
    assert (row["pseudonym"], row["answers"], row["acceptance"]) == ("f00d", 1, None)
    assert row["pace"] == {"lower": 4, "median": 4, "upper": 4}
