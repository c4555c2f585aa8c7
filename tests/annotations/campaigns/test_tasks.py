from __future__ import annotations

from collections import Counter
from datetime import timedelta
from decimal import Decimal
from functools import partial
from random import Random

import pytest
from django.utils import timezone

from annotations.campaigns.answering import finish, save_answer, warnings_for
from annotations.campaigns.closing import close, reopen
from annotations.campaigns.limits import TooOften
from annotations.campaigns.progress import progress_at, progress_of
from annotations.campaigns.pseudonyms import market_id_in, pseudonym_of
from annotations.campaigns.tasks import CampaignOver, begin, choose_prompts
from annotations.language.corpus import RewriteFault
from annotations.language.texts.errors import Refusal
from annotations.models import Campaign, Contributor, Submission
from annotations.models.campaigns import GRACE, ContributorKind
from tests.at_once import at_once
from tests.launched_campaigns import small_campaign


def codes(submission: Submission) -> list[str]:
    return [flag["code"] for flag in submission.flags]


def test_a_task_has_its_prompts_checks_and_free_commands(launched):
    contributor = begin(launched(task_size=6, check_every=3, free_commands=2), "somebody")
    kinds = list(contributor.submissions.order_by("position").values_list("kind", flat=True))
    assert kinds == [*["rewrite"] * 3, "check", *["rewrite"] * 3, "check", "free", "free"]
    prompts = contributor.submissions.filter(kind="rewrite").values_list("prompt", flat=True)
    assert len(set(prompts)) == 6


def test_forms_are_given_evenly(launched):
    campaign = launched(task_size=5)
    forms = len(set(campaign.prompts.values_list("logical_form", flat=True)))
    for number in range(2 * forms // 5):
        contributor = begin(campaign, f"contributor {number}")
        own = contributor.submissions.filter(kind="rewrite")
        assert len(set(own.values_list("prompt__logical_form", flat=True))) == 5
    given = Counter(
        Submission.objects.filter(kind="rewrite").values_list("prompt__logical_form", flat=True)
    )
    assert max(given.values()) - min(given.values()) <= 1
    assert len(given) == forms


def test_a_prompt_that_was_given_an_hour_ago_is_free_again(launched):
    campaign = launched(task_size=3)
    begin(campaign, "one")
    taken = set(
        Submission.objects.filter(kind="rewrite").values_list("prompt__logical_form", flat=True)
    )
    size = len(set(campaign.prompts.values_list("logical_form", flat=True)))
    others = choose_prompts(campaign, size - len(taken))
    assert not taken & {prompt.logical_form for prompt in others}
    Submission.objects.update(given_at=timezone.now() - timedelta(hours=2))
    first = [choose_prompts(campaign, size - len(taken)) for _ in range(5)]
    assert any(taken & {prompt.logical_form for prompt in prompts} for prompts in first)


def test_a_task_that_is_larger_than_the_campaign_gives_each_prompt_once(launched):
    campaign = launched()
    everything = campaign.prompts.count()
    chosen = choose_prompts(campaign, everything + 5)
    assert len({prompt.pk for prompt in chosen}) == len(chosen) == everything


def test_who_comes_back_goes_on_and_who_has_finished_does_not_begin_again(launched):
    campaign = launched(task_size=1, free_commands=0)
    contributor = begin(campaign, "one")
    assert begin(campaign, "one") == contributor
    save_answer(contributor.submissions.get(), "do it for me please")
    finish(contributor, had_model_help=False)
    assert begin(campaign, "one") == contributor
    campaign.allows_retake = True
    again = begin(campaign, "one")
    assert (again.attempt, again.pseudonym) == (2, "one")
    assert again.submissions.get().prompt != contributor.submissions.get().prompt


@pytest.mark.django_db(transaction=True)
def test_who_begins_twice_at_once_has_one_task(launched):
    campaign = launched()
    first, second = at_once(*[lambda: begin(campaign, "one")] * 2)
    assert first == second
    assert Contributor.objects.count() == 1


@pytest.mark.parametrize("column", ["closed_at", "ends_at"])
def test_who_has_begun_finishes_within_a_day_of_the_end(launched, column):
    campaign = launched()
    place = begin(campaign, "one").submissions.first()
    for ago in (timedelta(seconds=1), GRACE - timedelta(minutes=1)):
        setattr(campaign, column, timezone.now() - ago)
        campaign.save()
        with pytest.raises(CampaignOver):
            begin(campaign, "two")
        assert save_answer(place, f"do it {ago}").text
    setattr(campaign, column, timezone.now() - GRACE)
    campaign.save()
    with pytest.raises(CampaignOver):
        save_answer(place, "do it now")
    assert begin(campaign, "one") == place.contributor


def test_the_first_of_two_ends_counts(launched):
    campaign = launched()
    assert campaign.ended_at is campaign.grace_ends_at is None
    now = timezone.now()
    campaign.closed_at, campaign.ends_at = now - timedelta(hours=1), now - timedelta(hours=2)
    assert campaign.ended_at == campaign.ends_at
    campaign.ends_at = now + timedelta(hours=1)
    assert campaign.ended_at == campaign.closed_at and not campaign.is_locked


def test_a_campaign_ends_with_its_number_or_its_time(launched):
    campaign = launched(most_submissions=1)
    save_answer(begin(campaign, "one").submissions.first(), "do it")
    with pytest.raises(CampaignOver):
        begin(campaign, "two")
    with pytest.raises(CampaignOver):
        begin(launched(name="late", ends_at=timezone.now()), "one")


def test_an_answer_is_saved_with_its_flags_and_can_be_changed(launched):
    contributor = begin(launched(), "one")
    place = contributor.submissions.order_by("position").first()
    saved = save_answer(place, f"  {place.prompt.shown}\u200b  please ", seconds=0.5)
    assert saved.text == f"{place.prompt.shown} please"
    assert codes(saved) == ["copy", "too_fast"]
    changed = save_answer(place, "xyzzy plugh asdf", seconds=1.0, was_pasted=True)
    assert {"too_fast", "gibberish", "pasted"} <= set(codes(changed))
    mended = save_answer(place, "xyzzy plugh asdfg", seconds=30)
    assert {"gibberish", "pasted"} <= set(codes(mended))
    assert "too_fast" not in codes(mended)
    assert save_answer(place, "").answered_at is None


def test_the_same_answer_twice_is_stored_once(launched):
    place = begin(launched(), "one").submissions.first()
    first = save_answer(place, "do what I said", seconds=9)
    assert save_answer(place, "do what I said", seconds=1).answered_at == first.answered_at


def test_too_long_an_answer_is_refused(launched):
    place = begin(launched(), "one").submissions.first()
    with pytest.raises(Refusal) as refused:
        save_answer(place, "word " * 200)
    assert refused.value.code == "too_long"
    with pytest.raises(Refusal):
        save_answer(place, "a\0b")


def test_repeats_of_ones_own_and_of_others_are_flagged(launched):
    campaign = launched(task_size=2, free_commands=0, choice={"prompts_per_form": 1})
    contributor = begin(campaign, "one")
    first, second = contributor.submissions.order_by("position")
    save_answer(first, "please do whatever you like", 30)
    assert "repeat" in codes(save_answer(second, "do whatever you like", 30))
    other = begin(campaign, "two").submissions.first()
    other.prompt = first.prompt
    other.save()
    assert "repeat" in codes(save_answer(other, "Do whatever you like!", 30))


def test_a_planted_check_flags_other_words(launched):
    contributor = begin(launched(task_size=1, check_every=1, free_commands=0), "one")
    check = contributor.submissions.get(kind="check")
    assert codes(save_answer(check, "something", 9)) == ["check_failed"]
    assert codes(save_answer(check, check.prompt.check_words.upper(), 9)) == []


def test_a_free_command_that_copies_a_prompt_is_spam(launched):
    contributor = begin(launched(task_size=1, free_commands=1), "one")
    rewrite, free = contributor.submissions.order_by("position")
    assert codes(save_answer(free, rewrite.prompt.shown, 9)) == ["spam"]
    assert codes(save_answer(free, "water the flowers in the garden", 9)) == []


def test_warnings_are_those_of_the_prompt(launched):
    contributor = begin(launched(), "one")
    place = contributor.submissions.exclude(prompt__entities=[]).exclude(prompt=None).first()
    said = {each.code for each in warnings_for(place, "what I said a while ago")}
    assert RewriteFault.LOST_ENTITY in said
    assert RewriteFault.TOO_CLOSE in {each.code for each in warnings_for(place, place.prompt.shown)}
    free = contributor.submissions.get(kind="free")
    assert warnings_for(free, "anything") == ()


def test_a_task_with_an_empty_place_is_not_finished(launched):
    contributor = begin(launched(task_size=2, free_commands=0), "one")
    save_answer(contributor.submissions.order_by("position").first(), "do it", 9)
    with pytest.raises(Refusal) as refused:
        finish(contributor, had_model_help=False)
    assert refused.value.code == "place_empty"
    assert refused.value.problems[0]["value"] == 2


def test_what_is_finished_does_not_change(launched):
    contributor = begin(launched(task_size=1, free_commands=0), "one")
    place = contributor.submissions.get()
    save_answer(place, "do it", 9)
    finish(contributor, had_model_help=True)
    finished = finish(contributor, had_model_help=False)
    assert finished.had_model_help is True
    with pytest.raises(Refusal) as refused:
        save_answer(place, "do that", 9)
    assert refused.value.code == "task_finished"


def test_progress_counts_forms_pace_and_cost(launched):
    campaign = launched(
        task_size=2, free_commands=0, price=Decimal("1.50"), choice={"target_per_form": 1}
    )
    before = progress_of(campaign)
    assert (before.reached, before.rewrites, before.left, before.cost) == (0, 0, None, 0)
    contributor = begin(campaign, "one")
    for place in contributor.submissions.all():
        save_answer(place, f"do number {place.position}", 9)
    finish(contributor, had_model_help=False)
    campaign.refresh_from_db()
    after = progress_of(campaign)
    assert (after.reached, after.rewrites, after.people, after.finished) == (2, 2, 1, 1)
    assert after.missing == before.missing - 2 == after.forms - 2
    assert after.per_hour > 0
    assert after.left
    assert str(after.cost) == "1.50"
    later = progress_at(campaign, timezone.now() + timedelta(hours=3))
    assert (later.per_hour, later.left) == (0, None)


def test_a_pseudonym_tells_nothing_and_is_of_one_campaign(launched):
    one, two = launched(name="one"), launched(name="two")
    known = pseudonym_of(one, "workerId", "A1B2")
    assert known == pseudonym_of(one, "workerId", "A1B2")
    others = {
        pseudonym_of(two, "workerId", "A1B2"),
        pseudonym_of(one, "PROLIFIC_PID", "A1B2"),
        pseudonym_of(one, "workerId", "A1B3"),
    }
    assert known not in others
    assert len(others) == 3
    assert "A1B2" not in known


@pytest.mark.parametrize(
    ("query", "found"),
    [
        ({"PROLIFIC_PID": "5f"}, ("PROLIFIC_PID", "5f")),
        ({"workerId": "A1"}, ("workerId", "A1")),
        ({"workerId": " "}, None),
        ({"workerId": "x" * 101}, ("workerId", "x" * 101)),
        ({"workerId": "a\x00"}, None),
        ({"other": "A1"}, None),
    ],
)
def test_the_market_says_who_somebody_is(query, found):
    assert market_id_in(Campaign(), query) == found


@pytest.mark.parametrize("seed", range(12))
def test_whatever_the_sizes_forms_are_given_evenly_and_no_prompt_twice(world, seed):
    random = Random(seed)
    campaign = Campaign.objects.create(
        world=world, name="any", task_size=random.randint(1, 9), free_commands=0, allows_retake=True
    )
    sizes = [random.randint(1, 4) for _ in range(random.randint(1, 8))]
    for form, size in enumerate(sizes):
        for number in range(size):
            text = f"{form} {number}"
            position = campaign.prompts.count() + 1
            values = {"logical_form": str(form), "prompt": text, "shown": text}
            campaign.prompts.create(position=position, **values)
    for number in range(random.randint(1, 12)):
        before = Counter(Submission.objects.values_list("prompt__logical_form", flat=True))
        task = begin(campaign, f"contributor {number}").submissions.select_related("prompt")
        prompts = [place.prompt for place in task]
        assert len({prompt.pk for prompt in prompts}) == len(prompts)
        assert len(prompts) == min(campaign.task_size, sum(sizes))
        forms = Counter(prompt.logical_form for prompt in prompts)
        # A form comes again only where every other one has come as often as it can.
        most = max(forms.values())
        assert all(forms[str(form)] >= min(size, most - 1) for form, size in enumerate(sizes))
        # Forms that are left out had at least as many as any that came once and is not left out.
        left = [before[str(form)] for form in range(len(sizes)) if not forms[str(form)]]
        assert not left or min(left) >= max(before[form] for form in forms)


def test_who_does_several_tasks_gets_other_prompts_while_there_are_some(world):
    campaign = small_campaign(world, task_size=1, free_commands=0, allows_retake=True)
    given = []
    for _ in range(2):
        contributor = begin(campaign, "one")
        place = contributor.submissions.get()
        given.append(place.prompt_id)
        save_answer(place, "do it", 9)
        finish(contributor, had_model_help=False)
    assert len(set(given)) == 2


@pytest.mark.django_db(transaction=True)
def test_of_two_who_save_one_place_at_once_one_is_stored_whole(launched):
    place = begin(launched(), "one").submissions.order_by("position").first()
    texts = {"xyzzy plugh asdf": ["gibberish"], place.prompt.shown: ["copy"]}
    at_once(*(partial(save_answer, place, text) for text in texts))
    place.refresh_from_db()
    assert set(texts[place.text]) <= set(codes(place))
    assert {"gibberish", "copy"} - set(codes(place))


def test_a_file_with_the_same_person_leaves_their_task_alone(launched):
    campaign = launched(task_size=2, free_commands=0)
    mine = begin(campaign, "somebody")
    imported = {"kind": ContributorKind.FILE, "pseudonym": "somebody", "attempt": 2}
    campaign.contributors.create(finished_at=timezone.now(), **imported)
    assert begin(campaign, "somebody") == mine
    campaign.contributors.create(pseudonym="other", kind=ContributorKind.FILE)
    began = begin(campaign, "other")
    assert (began.kind, began.attempt) == (ContributorKind.PERSON, 2)


def test_nobody_gets_a_prompt_twice_while_there_are_others(launched):
    campaign = launched({"prompts_per_form": 1}, task_size=3, free_commands=0, allows_retake=True)
    rewrites = campaign.prompts.filter(check_words="")
    kept = rewrites.values_list("pk", flat=True)[:20]
    rewrites.exclude(pk__in=list(kept)).delete()
    for name in ("a", "b", "c"):
        begin(campaign, name)
    had = []
    for _ in range(6):
        mine = begin(campaign, "somebody")
        had += mine.submissions.values_list("prompt_id", flat=True)
        mine.finished_at = timezone.now()
        mine.save()
    assert len(had) == len(set(had)) == 18
    last = begin(campaign, "somebody").submissions.values_list("prompt_id", flat=True)
    assert set(kept) - set(had) <= set(last)


def test_a_campaign_closes_itself_with_the_last_submission(launched):
    campaign = launched(task_size=2, free_commands=0, most_submissions=2)
    one, two = begin(campaign, "one"), begin(campaign, "two")
    first, second = one.submissions.all()
    save_answer(first, "something", 9)
    assert not Campaign.objects.get(pk=campaign.pk).is_over
    save_answer(second, "something else", 9)
    stored = Campaign.objects.get(pk=campaign.pk)
    assert stored.is_over and not stored.is_locked
    save_answer(two.submissions.first(), "and who has begun goes on", 9)
    with pytest.raises(Refusal) as refused:
        reopen(stored)
    assert refused.value.code == "campaign_full"


def test_a_campaign_whose_day_is_over_is_not_opened_again(launched):
    campaign = launched(ends_at=timezone.now() - timedelta(days=1))
    close(campaign)
    with pytest.raises(Refusal) as refused:
        reopen(campaign)
    assert refused.value.code == "time_is_up"


def test_of_many_who_begin_at_once_no_more_do_than_the_link_allows(transactional_db, launched):
    campaign = launched(task_size=1, free_commands=0, most_per_hour=2)

    def try_to_begin(name: str) -> bool:
        try:
            begin(campaign, name)
        except TooOften:
            return False
        return True

    begun = at_once(*(partial(try_to_begin, f"person {number}") for number in range(8)))
    assert sum(begun) == campaign.contributors.count() == 2


def test_nobody_finishes_after_the_day_of_grace(launched):
    contributor = begin(launched(task_size=1, free_commands=0), "somebody")
    save_answer(contributor.submissions.get(), "something", 9)
    Campaign.objects.update(closed_at=timezone.now() - timedelta(days=3))
    with pytest.raises(CampaignOver):
        finish(Contributor.objects.get(), had_model_help=False)
