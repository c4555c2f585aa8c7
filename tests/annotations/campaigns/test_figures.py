from __future__ import annotations

import os
from collections import OrderedDict
from pathlib import Path
from statistics import fmean, median

import pytest

from annotations.campaigns.answering import save_answer
from annotations.campaigns.contributor_figures import contributors_of
from annotations.campaigns.moderation import accept, reject
from annotations.campaigns.paraphrase_figures import figures_of, form_counts
from annotations.campaigns.tasks import begin
from annotations.exchange.pair_import import import_pairs
from annotations.language.corpus import distance
from annotations.language.corpus.proportions import wilson_interval
from annotations.models import LogicalForm, Paraphrase
from annotations.models.campaigns import Contributor, ContributorKind
from annotations.rows import kept
from tests.launched_campaigns import small_campaign
from tests.sample_world import make_paraphrase

PUBLISHED = Path(os.environ.get("GPSR_SHARED_DATA", "")) / "walker2019"


@pytest.fixture
def campaign(world):
    return small_campaign(world)


@pytest.fixture
def model(campaign) -> Contributor:
    return campaign.contributors.create(kind=ContributorKind.MODEL, pseudonym="m")


@pytest.mark.skipif(
    not PUBLISHED.is_dir(), reason="GPSR_SHARED_DATA names no folder with the corpus"
)
def test_the_published_records_have_their_means(tiny_world, tmp_path):
    text = (PUBLISHED / "paraphrasings.txt").read_text(encoding="utf-8")
    (tmp_path / "para").mkdir()
    (tmp_path / "para" / "train.txt").write_text('go to the bath\n( go " <room> " )\n')
    (tmp_path / "paraphrasings.txt").write_text(text, encoding="utf-8")
    import_pairs(tiny_world.name, "walker", tmp_path)
    figures = figures_of(tiny_world)
    lines = [line for line in text.splitlines() if line.strip()]
    said, prompts = lines[::3], lines[1::3]
    assert figures.people.count == len(said) == 1_300
    assert figures.models.count == 0
    distances = [distance(*each) for each in zip(said, prompts, strict=True)]
    assert figures.people.edits == pytest.approx(fmean(each.edit for each in distances))
    assert figures.people.jaccard == pytest.approx(fmean(each.jaccard for each in distances))
    # The published means are of all 1,923 records.
    assert figures.people.edits == pytest.approx(figures.published.edits, abs=1)
    assert figures.people.jaccard == pytest.approx(figures.published.jaccard, abs=0.05)
    assert sum(figures.people.edit_counts) == sum(figures.people.jaccard_counts) == 1_300


def test_figures_of_few_paraphrases_are_counted_each_time(world):
    make_paraphrase(world, "go now")
    assert figures_of(world).count == 1
    make_paraphrase(world, "go there")
    assert figures_of(world).count == 2


def test_figures_of_many_paraphrases_are_kept_for_a_while(world, monkeypatch):
    monkeypatch.setattr(kept, "MOST_READ", 0)
    monkeypatch.setattr(kept, "_kept", OrderedDict())
    monkeypatch.setattr(kept, "SHARE", 1_000_000)
    make_paraphrase(world, "go now")
    before = figures_of(world)
    make_paraphrase(world, "go there")
    assert figures_of(world).count == before.count == 1
    assert figures_of(world).age > before.age
    monkeypatch.setattr(kept, "MOST_SECONDS", 0)
    assert figures_of(world).count == 2


def test_a_world_without_paraphrases_has_empty_figures(world):
    figures = figures_of(world)
    assert (figures.count, figures.sample, figures.growth_at) == (0, 0, [])
    assert (figures.people.edits, figures.people.sample_words) == (None, None)
    assert figures.categories == ()


def test_people_and_models_are_apart(world, model):
    make_paraphrase(world, utterance="one two", edit_distance=4, jaccard_distance=0.3)
    make_paraphrase(world, utterance="Two three.", edit_distance=400, jaccard_distance=1.0)
    make_paraphrase(world, utterance="one four", edit_distance=7, contributor=model)
    make_paraphrase(world, utterance="not counted", status="rejected")
    figures = figures_of(world)
    assert (figures.people.count, figures.models.count) == (2, 1)
    assert (figures.people.edits, figures.models.edits) == (202, 7)
    assert figures.people.growth == (2, 3)
    assert (figures.people.words, figures.models.words) == (3, 2)
    assert figures.sample == 1
    assert figures.people.sample_words == pytest.approx(2)
    assert figures.models.sample_words == pytest.approx(2)
    # A value on the border of two bins belongs to the upper one; the last one is open.
    assert figures.people.edit_counts == (1, *[0] * 15, 1)
    assert figures.people.jaccard_counts == (0, 0, 0, 1, *[0] * 5, 1)
    assert figures.growth_at == [1, 2]


def test_a_campaign_has_its_own_figures_and_target(world, campaign, model):
    campaign.target_per_form = 3
    campaign.save()
    make_paraphrase(world, logical_form="( go 1 )")
    make_paraphrase(world, logical_form="( go 2 )", contributor=model)
    make_paraphrase(world, logical_form="( go 3 )")
    figures = figures_of(world, campaign)
    assert (figures.people.count, figures.models.count, figures.target) == (0, 1, 3)
    rows = form_counts(world, campaign)
    assert [(row.form, row.people, row.models, row.lacks) for row in rows] == [
        ("( go 1 )", 1, 0, 2),
        ("( go 2 )", 0, 1, 2),
    ]
    assert (figures.forms, figures.short) == (2, 2)


def test_forms_that_lack_most_come_first(world, model):
    for number, category in enumerate(("1", "2"), start=1):
        LogicalForm.objects.create(
            world=world,
            text=f"( go {number} )",
            head_predicate="go",
            depth=1,
            length=1,
            task_category=category,
        )
    make_paraphrase(world, logical_form="( go 2 )", contributor=model)
    make_paraphrase(world, logical_form="( go 2 )")
    make_paraphrase(world, logical_form="( said )")
    rows = form_counts(world, target=2)
    assert [(row.form, row.lacks) for row in rows] == [
        ("( go 1 )", 2),
        ("( said )", 1),
        ("( go 2 )", 0),
    ]
    categories = {row.name: row for row in figures_of(world).categories}
    assert (categories["2"].people, categories["2"].models, categories["2"].short) == (1, 1, 1)
    assert (categories["1"].forms, categories["1"].people) == (1, 0)
    assert categories[""].people == 1


def test_contributors_have_pace_acceptance_and_flags(world, campaign, admin):
    for name, seconds in (("quick", (1, 2)), ("slow", (30, 50))):
        contributor = begin(campaign, name)
        for place in contributor.submissions.filter(kind="rewrite"):
            lasted = seconds[place.position - 1]
            text = f"would you do {place.prompt.entities[0]['text']} number {place.position}"
            save_answer(place, text if name == "slow" else place.prompt.prompt, lasted)
    of_slow = list(contributor.submissions.answered())
    accept(of_slow[:1], admin)
    reject(of_slow[1:], admin)
    quick, slow = contributors_of(world)
    assert (quick.contributor.pseudonym, slow.contributor.pseudonym) == ("quick", "slow")
    assert quick.flagged == 2
    assert (quick.acceptance, quick.interval) == (None, None)
    assert (slow.accepted, slow.decided, slow.acceptance) == (1, 2, 0.5)
    assert slow.interval == wilson_interval(1, 2)
    assert slow.pace.median == median((30, 50))
    assert (slow.pace.lower, slow.pace.upper) == (35, 45)
    assert contributors_of(world, small_campaign(world, name="second")) == []
    assert Paraphrase.objects.count() == 1


def test_figures_of_many_paraphrases_cost_few_queries(world, model, django_assert_max_num_queries):
    for number in range(60):
        make_paraphrase(world, utterance=f"word{number} and", contributor=model)
    with django_assert_max_num_queries(4):
        figures = figures_of(world)
    assert len(figures.growth_at) <= 41
    assert figures.growth_at[-1] == 60
