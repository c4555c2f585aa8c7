"""From a wrong answer back to work: the queue, the label, a new split, a retrained run."""

from __future__ import annotations

import pytest

from annotations.models import Paraphrase, Split, WorkItem
from parser_service.models import TrainingRun
from tests.notices import levels
from tests.parser_service.made_up import make_split
from tests.sample_world import make_paraphrase

BASE = "/w/home"


@pytest.fixture
def example(sample):
    return sample.split.examples.filter(part="validation", source="paraphrased").first()


def prediction_url(sample, example) -> str:
    return f"{BASE}/review/?run={sample.run.pk}&example={example.pk}"


def example_url(example) -> str:
    return f"{BASE}/splits/{example.split_id}/examples/{example.pk}/"


def test_a_reviewer_sends_an_answer_and_comes_back(sample, example, rene):
    page = prediction_url(sample, example)
    assert f'action="{example_url(example)}send/"' in rene.get(page).content.decode()
    sent = {"reason": "The label is wrong.", "next": page}
    answer = rene.post(f"{example_url(example)}send/", sent, follow=True)
    assert answer.redirect_chain == [(page, 302)]
    assert levels(answer) == ["success"] and "1 " in str(*answer.context["messages"])
    assert WorkItem.objects.get().title == example.utterance


@pytest.mark.parametrize(
    "address", ["https://evil.example/", "//evil.example", "javascript:alert(1)"]
)
def test_one_does_not_go_on_to_another_site(sample, example, rene, address):
    sent = {"reason": "Look.", "next": address}
    answer = rene.post(f"{example_url(example)}send/", sent)
    assert answer.url == example_url(example)


def test_without_a_reason_nothing_is_sent(sample, example, rene):
    answer = rene.post(f"{example_url(example)}send/", {}, follow=True)
    assert levels(answer) == ["error"]
    assert not WorkItem.objects.exists()


def test_all_that_pass_the_filters_are_sent_once(sample, rene):
    page = f"{BASE}/runs/{sample.run.pk}/predictions/"
    listing = rene.get(page, {"outcome": "wrong"})
    query = f"{page}send/?outcome=wrong"
    assert f'action="{query}"' in listing.content.decode() and listing.context["listing"].total == 9
    answer = rene.post(query, {"reason": "Look."}, follow=True)
    wrong = sample.run.predictions.filter(is_exact_match=False)
    texts = set(wrong.values_list("example__utterance", flat=True))
    assert WorkItem.objects.count() == len(texts) == 9
    assert levels(answer) == ["success"] and "9 " in str(*answer.context["messages"])


def test_a_list_without_filters_is_not_offered_whole(sample, rene):
    page = rene.get(f"{BASE}/runs/{sample.run.pk}/predictions/").content.decode()
    assert "predictions/send/" not in page


def test_annotators_correct_and_do_not_send(sample, example, anna):
    page = anna.get(prediction_url(sample, example)).content.decode()
    assert f'action="{BASE}/label/send/"' in page
    assert f"{example_url(example)}send/" not in page


def test_the_paraphrase_behind_an_example_is_corrected_on_its_page(sample, example, world, anna):
    row = make_paraphrase(
        world,
        utterance=example.utterance,
        logical_form=example.logical_form,
        grounded_form=example.logical_form,
    )
    assert f"/paraphrases/{row.pk}/?correct=1" in anna.get(example_url(example)).content.decode()
    sent = {"form": '(find "<room>")', "version": row.version}
    answer = anna.post(f"{BASE}/paraphrases/{row.pk}/label/", sent, follow=True)
    assert levels(answer) == ["success"]
    assert Paraphrase.objects.get().logical_form == '( find " <room> " )'
    example.refresh_from_db()
    assert example.logical_form == row.logical_form
    late = anna.post(
        f"{BASE}/paraphrases/{row.pk}/label/", {**sent, "form": '(go "<room>")'}, follow=True
    )
    assert levels(late) == ["error"]
    assert Paraphrase.objects.get().logical_form == '( find " <room> " )'
    said = anna.post(f"{BASE}/paraphrases/{row.pk}/check/", {"form": "UNKNOWN"}).json()
    assert said["problems"] == [] and said["gloss"]


def test_the_template_behind_a_generated_example_is_opened(sample, world, anna):
    command = world.commands.first()
    example = sample.split.examples.filter(source="generated").first()
    type(example).objects.filter(pk=example.pk).update(utterance=command.anonymized_text)
    page = anna.get(example_url(example)).content.decode()
    assert f'href="{BASE}/templates/{command.template_id}/"' in page


@pytest.fixture
def newer(sample) -> Split:
    made = make_split(sample.world, "home-split-2")
    made.follows = sample.split
    made.save()
    return made


def test_the_page_of_a_split_says_what_a_new_one_would_change_and_makes_it(sample, anna):
    url = f"{BASE}/splits/{sample.split.pk}/"
    assert f'action="{url}renew/"' not in anna.get(url).content.decode()
    Split.objects.update(seed=0)  # frozen here, and no import
    page = anna.get(url)
    assert page.context["changes"].parts
    assert f'action="{url}renew/"' in page.content.decode()
    answer = anna.post(f"{url}renew/", follow=True)
    renewed = Split.objects.get(follows=sample.split)
    assert answer.redirect_chain == [(f"{BASE}/splits/{renewed.pk}/", 302)]
    assert levels(answer) == ["success"] and renewed.name in str(*answer.context["messages"])
    assert anna.get(url).context["newest"] == renewed
    again = anna.post(f"{url}renew/", follow=True)
    assert levels(again) == ["error"] and renewed.name in str(*again.context["messages"])
    assert Split.objects.count() == 2


def test_a_run_is_retrained_with_one_button(sample, newer, adam, no_messages):
    page = adam.get(f"{BASE}/runs/{sample.run.pk}/").content.decode()
    assert f"/runs/{sample.run.pk}/retrain/" in page and newer.name in page
    rows = adam.get(f"{BASE}/splits/{newer.pk}/runs/").content.decode()
    assert f"/runs/{sample.run.pk}/retrain/" in rows
    answer = adam.post(f"{BASE}/runs/{sample.run.pk}/retrain/")
    again = TrainingRun.objects.get(split=newer)
    assert answer.url == f"{BASE}/runs/{again.pk}/"
    before = adam.get(f"{BASE}/runs/{sample.run.pk}/").content.decode()
    assert answer.url in before and f"/runs/{sample.run.pk}/retrain/" not in before
    assert f"run {again.pk}" in adam.get(f"{BASE}/splits/{newer.pk}/runs/").content.decode()


def test_a_run_of_the_newest_split_has_nothing_to_retrain_on(sample, adam):
    answer = adam.post(f"{BASE}/runs/{sample.run.pk}/retrain/", follow=True)
    assert levels(answer) == ["warning"]
    assert TrainingRun.objects.count() == 1


def test_only_admins_retrain(sample, newer, anna):
    assert "/retrain/" not in anna.get(f"{BASE}/runs/{sample.run.pk}/").content.decode()
