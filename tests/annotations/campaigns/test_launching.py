from __future__ import annotations

from collections import Counter

import pytest

from annotations.campaigns.answering import named_in
from annotations.campaigns.launching import PromptChoice, draw_prompts
from annotations.campaigns.tasks import begin
from annotations.language.corpus import lost_entities
from annotations.language.texts.errors import Refusal
from annotations.models import Paraphrase


def test_each_form_has_its_prompts_with_different_texts(launched, household):
    campaign = launched()
    forms = set(household.logical_forms.values_list("text", flat=True))
    by_form = Counter(campaign.prompts.values_list("logical_form", flat=True))
    assert set(by_form) == forms
    assert set(by_form.values()) <= {1, 2}
    assert sum(count == 2 for count in by_form.values()) > len(forms) / 2
    texts = list(campaign.prompts.values_list("logical_form", "prompt"))
    assert len(set(texts)) == len(texts)


def test_prompts_name_entities_that_they_keep_themselves(launched):
    prompts = list(launched().prompts.all())
    assert all(lost_entities(prompt.prompt, named_in(prompt)) == () for prompt in prompts)
    assert sum(bool(prompt.entities) for prompt in prompts) > len(prompts) / 2
    assert not any("<" in prompt.prompt for prompt in prompts)
    assert all(prompt.command for prompt in prompts)


def test_english_wording_shows_the_form_and_keeps_the_command(launched):
    campaign = launched({"wording": "english"})
    prompts = list(campaign.prompts.all())
    assert any(prompt.shown != prompt.prompt for prompt in prompts)
    kept = [lost_entities(prompt.shown, named_in(prompt)) == () for prompt in prompts]
    assert sum(kept) > 0.9 * len(kept)


def test_a_seed_decides(household):
    def texts(seed: int) -> list[str]:
        return [each.grounded.text for each in draw_prompts(household, PromptChoice(seed=seed))]

    assert texts(1) == texts(1) != texts(2)


def test_task_categories_are_chosen(launched, household):
    category = household.commands.first().task_category
    assert household.commands.exclude(task_category=category).exists()
    campaign = launched({"task_categories": (category,)})
    categories = set(campaign.prompts.values_list("task_category", flat=True))
    assert categories == {category}


def test_a_form_with_enough_paraphrases_is_left_out(household, launched):
    form = household.logical_forms.first().text
    Paraphrase.objects.bulk_create(
        Paraphrase(
            world=household,
            prompt="x",
            utterance=f"y {number}",
            grounded_form=form,
            logical_form=form,
            edit_distance=1,
            jaccard_distance=1,
            position=number,
        )
        for number in range(3)
    )
    assert (
        launched(name="few", choice={"target_per_form": 3})
        .prompts.filter(logical_form=form)
        .count()
        == 0
    )
    assert (
        launched(name="more", choice={"target_per_form": 4})
        .prompts.filter(logical_form=form)
        .count()
        > 0
    )


def test_nothing_to_ask_for_is_refused(household):
    with pytest.raises(Refusal) as refused:
        draw_prompts(household, PromptChoice(target_per_form=0))
    assert refused.value.code == "nothing_to_paraphrase"


def test_a_name_is_taken_once(launched):
    launched()
    with pytest.raises(Refusal) as refused:
        launched()
    assert refused.value.code == "name_taken"


def test_checks_are_planted_where_they_are_asked_for(launched):
    assert not launched(name="without").prompts.exclude(check_words="").exists()
    assert launched(name="with", check_every=2).prompts.exclude(check_words="").count() > 1


def test_lines_are_balanced_where_they_are_chosen(launched, household):
    campaign = launched({"balance": "lines"}, task_size=30, free_commands=0)
    by_line = Counter(campaign.prompts.values_list("line", flat=True))
    patterns = set(household.grammar.templates.values_list("pattern", flat=True))
    assert set(by_line) <= patterns
    assert len(by_line) > campaign.prompts.values("logical_form").distinct().count()
    assert set(by_line.values()) <= {1, 2}
    for number in range(len(by_line) // 10):
        begin(campaign, f"contributor {number}")
    given = Counter(
        campaign.prompts.filter(submissions__isnull=False).values_list("line", flat=True)
    )
    assert max(given.values()) - min(given[line] for line in by_line) <= 1
