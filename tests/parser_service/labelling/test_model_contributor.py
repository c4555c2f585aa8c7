"""A language model as a contributor, asked over a server that does all that such servers do."""

from __future__ import annotations

import json
import re
import time
from dataclasses import replace
from typing import Any

import pytest

from annotations.background.progress import UNWATCHED, Unwatched
from annotations.campaigns.answering import named_in
from annotations.campaigns.model_rewrites import ModelSettings
from annotations.language.corpus import INSTRUCTIONS, lost_entities
from annotations.language.texts.errors import Refusal
from annotations.models import Campaign, CampaignPrompt, Contributor, Submission
from parser_service.labelling.model_contributor import paraphrase, request_paraphrases
from parser_service.parsers.interface import Cancelled
from parser_service.parsers.server_address import ModelServer
from tests.parser_service.llm_server import KEY, MODEL, QUICK, fails, installed, says, tiny_server

SETTINGS = ModelSettings(MODEL, INSTRUCTIONS, wordings=2, budget=10_000)
THINGS = ["tea", "milk", "sponge", "apple", "rice", "soap"]
PLACES = ["sink", "sofa", "desk", "shelf", "stove", "bath"]


@pytest.fixture
def tiny(tmp_path):
    with tiny_server() as server:
        # What takes longer is asked again.
        patience = replace(QUICK, answer=0.5, tries=4)
        with installed(ModelServer(server.url, KEY, patience=patience, answers=tmp_path / "llm")):
            yield server


@pytest.fixture
def campaign(world) -> Campaign:
    return Campaign.objects.create(world=world, name="spring", target_per_form=8)


def add_prompts(campaign: Campaign, number: int, of_form: int = 2) -> None:
    prompts = []
    for place in range(number):
        thing = THINGS[place % len(THINGS)]
        spot = PLACES[place // len(THINGS) % len(PLACES)]
        text = f"bring me the {thing} number {place} from the {spot}"
        prompts.append(
            CampaignPrompt(
                campaign=campaign,
                logical_form=f"form {place // of_form}",
                prompt=text,
                shown=text,
                grounded_form="go",
                entities=[
                    {"text": name, "aliases": [], "is_described": False} for name in (thing, spot)
                ],
                position=place + 1,
            )
        )
    CampaignPrompt.objects.bulk_create(prompts)


def command_in(body: dict[str, Any]) -> tuple[str, str, str]:
    """Return the thing, the number and the place that a request asks for."""
    found = re.search(r"bring me the (\w+) number (\d+) from the (\w+)", str(body["messages"]))
    assert found
    return found[1], found[2], found[3]


def good(body: dict[str, Any]) -> list[str]:
    thing, number, spot = command_in(body)
    return [
        f"there is {thing} at the {spot}, I would like {number} of it over here",
        f"fetch {number} of the {thing}, look by the {spot}",
    ]


def numbered(texts: list[str]) -> str:
    return "\n".join(f"{place}. {text}" for place, text in enumerate(texts, start=1))


class TenFaults:
    """Answers the first question about each prompt with one of ten faults, and later ones well."""

    def __init__(self) -> None:
        self.seen: set[str] = set()

    def __call__(self, handler: Any) -> None:
        body = handler.body
        thing, number, spot = command_in(body)
        texts = good(body)
        is_new, fault = number not in self.seen, int(number) % 11
        self.seen.add(number)
        match fault:
            case 1:
                answer = f"Sure, here you are:\n\n{numbered(texts)}\n\nIs there anything else?"
            case 2:
                answer = f"<think>1. a trap\n2. another one</think>\n{numbered(texts)}"
            case 3:
                answer = numbered(texts[:1])
            case 4:
                answer = numbered([texts[0].replace(thing, "lamp"), texts[1]])
            case 5:
                answer = numbered(
                    [f"Bring me the {thing} number {number} from the {spot}.", texts[1]]
                )
            case 6:
                answer = numbered(
                    [f"hol mir bitte {thing} Nummer {number} vom {spot} herüber", texts[1]]
                )
            case 7:
                answer = ""
            case 8 if is_new:
                return fails(500, "CUDA error")(handler)
            case 9 if is_new and int(number) % 9 == 0:  # each takes half a second
                time.sleep(0.7)
                answer = numbered(texts)
            case 10 if is_new:
                return handler.send_bytes(b"x" * 10 * 1024 * 1024)
            case _:
                answer = json.dumps({"paraphrases": texts})
        says(answer)(handler)


def no_answer_is_lost(campaign: Campaign) -> None:
    for submission in Submission.objects.select_related("prompt").exclude(text=""):
        if submission.status != "rejected":
            assert not lost_entities(submission.text, named_in(submission.prompt))


def test_a_thousand_prompts_with_ten_faults(campaign, tiny):
    add_prompts(campaign, 1_000)
    tiny.always = TenFaults()
    report = paraphrase(campaign, SETTINGS, UNWATCHED)
    # A reply of 10 MB is not asked for again at once.
    assert report["asked"] + report["unanswered"] == 1_000
    assert report["unanswered"] == len([n for n in range(1_000) if n % 11 == 10])
    again = paraphrase(campaign, SETTINGS, UNWATCHED)
    assert (again["asked"], again["unanswered"]) == (report["unanswered"], 0)
    asked = Submission.objects.values_list("prompt", flat=True)
    assert len(set(asked)) == 1_000
    assert set(report["dropped"]) == {"lost_entity", "copy", "gibberish", "no_rewrite"}
    assert report["dropped"]["no_rewrite"] == len([n for n in range(1_000) if n % 11 == 7])
    no_answer_is_lost(campaign)
    kept = Submission.objects.filter(status="pending")
    lost = [{3: 1, 4: 1, 5: 1, 6: 1, 7: 2}.get(number % 11, 0) for number in range(1_000)]
    assert kept.count() == report["rewrites"] + again["rewrites"] == 2_000 - sum(lost)
    assert all(kept.exclude(raw="").values_list("raw", flat=True))


class Stopping(Unwatched):
    """Is stopped after so many looks."""

    def __init__(self, looks: int) -> None:
        self.looks = looks

    def check(self) -> None:
        self.looks -= 1
        if self.looks < 0:
            raise Cancelled


def test_after_a_stop_nothing_is_asked_twice(campaign, tiny):
    add_prompts(campaign, 60)
    tiny.think = lambda body: numbered(good(body))
    tiny.seconds = 0.05
    with pytest.raises(Cancelled):
        paraphrase(campaign, SETTINGS, Stopping(9))
    begun = len(tiny.asked)
    assert 0 < begun < 60
    paraphrase(campaign, SETTINGS, UNWATCHED)
    prompts = [command_in(body)[1] for body in tiny.asked]
    # What was on its way at the stop is asked again; what had come is not.
    assert len(prompts) - len(set(prompts)) <= 4
    assert Contributor.objects.count() == 1
    assert Submission.objects.values("prompt").distinct().count() == 60


def test_a_stop_takes_moments(campaign, tiny):
    add_prompts(campaign, 20)
    tiny.think = lambda body: numbered(good(body))
    tiny.seconds = 0.4
    began = time.monotonic()
    with pytest.raises(Cancelled):
        paraphrase(campaign, SETTINGS, Stopping(5))
    assert time.monotonic() - began < 5


def test_models_give_at_most_half_of_a_form(campaign, tiny):
    add_prompts(campaign, 40, of_form=20)
    tiny.think = lambda body: numbered(good(body))
    paraphrase(campaign, SETTINGS, UNWATCHED)
    for form in ("form 0", "form 1"):
        kept = Submission.objects.filter(prompt__logical_form=form, status="pending").count()
        assert kept == campaign.target_per_form // 2
    assert paraphrase(campaign, SETTINGS, UNWATCHED)["asked"] == 0


def test_the_budget_bounds_the_requests(campaign, tiny):
    add_prompts(campaign, 30)
    tiny.think = lambda body: numbered(good(body))
    report = paraphrase(campaign, replace(SETTINGS, budget=5), UNWATCHED)
    assert (report["asked"], report["budget_spent"], len(tiny.asked)) == (5, True, 5)


def test_the_settings_are_those_of_the_contributor_and_of_the_question(campaign, tiny):
    add_prompts(campaign, 2)
    tiny.think = lambda body: numbered(good(body))
    paraphrase(campaign, replace(SETTINGS, temperature=0.3, seed=7), UNWATCHED)
    contributor = Contributor.objects.get()
    assert contributor.kind == "model"
    assert {"model": MODEL, "temperature": 0.3, "seed": 7}.items() <= contributor.settings.items()
    assert (tiny.asked[0]["temperature"], tiny.asked[0]["seed"]) == (0.3, 7)
    paraphrase(campaign, replace(SETTINGS, seed=8), UNWATCHED)
    assert Contributor.objects.count() == 2


def test_a_server_that_is_away_ends_the_job_and_keeps_what_came(campaign, tiny):
    add_prompts(campaign, 100)

    def some(handler):
        if int(command_in(handler.body)[1]) < 8:
            return says(numbered(good(handler.body)))(handler)
        return fails(500)(handler)

    tiny.always = some
    with pytest.raises(Refusal) as refused:
        paraphrase(campaign, SETTINGS, UNWATCHED)
    assert refused.value.code == "language_model_refused"
    assert Submission.objects.values("prompt").distinct().count() == 8
    tiny.always = None
    tiny.think = lambda body: numbered(good(body))
    assert paraphrase(campaign, SETTINGS, UNWATCHED)["asked"] == 92


@pytest.mark.parametrize(
    ("changes", "code"),
    [({"model": ""}, "no_model"), ({"instructions": "say it"}, "no_command_place")],
)
def test_settings_that_are_none_are_refused(campaign, admin, tiny, changes, code):
    with pytest.raises(Refusal) as refused:
        request_paraphrases(campaign, replace(SETTINGS, **changes), admin)
    assert refused.value.code == code


def test_a_job_is_asked_for_once(campaign, admin, tiny):
    add_prompts(campaign, 2)
    first, is_new = request_paraphrases(campaign, SETTINGS, admin)
    again, is_new_again = request_paraphrases(campaign, SETTINGS, admin)
    assert (first.pk, is_new, is_new_again) == (again.pk, True, False)


def test_without_a_server_nothing_is_asked_for(campaign, admin):
    with pytest.raises(Refusal) as refused:
        request_paraphrases(campaign, SETTINGS, admin)
    assert refused.value.code == "no_language_model_server"
