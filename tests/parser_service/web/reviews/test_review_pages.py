"""The review page: which example is shown, with which answers, and what a reviewer does there."""

from __future__ import annotations

import re

import pytest
from django.db.models import Value
from django.db.models.functions import Concat
from django.utils.html import escape

from annotations.background.progress import UNWATCHED
from parser_service.models import Prediction, Review
from parser_service.reviews.category_proposals import propose_for_run
from parser_service.reviews.world_categories import ensure_categories
from tests.conftest import client_of
from tests.parser_service.made_up import make_split
from tests.sample_world import answer, make_paraphrase, scored_run

GO = '( go " <room> " )'


@pytest.fixture
def run(sample):
    propose_for_run(sample.run, frozenset(), UNWATCHED)
    return sample.run


@pytest.fixture
def other(run):
    """A second run, of which five answers are right."""
    return scored_run(run.world, run.split, right=5, seed=1)


def examples_of(run, **chosen) -> list[int]:
    rows = run.predictions.filter(**chosen).order_by("example_id")
    return list(rows.values_list("example_id", flat=True))


def wrong_of(run) -> list[int]:
    return examples_of(run, is_exact_match=False)


def look(client, *runs, **chosen):
    return client.get("/w/home/review/", {"run": [run.pk for run in runs], **chosen})


def shown(page) -> int | None:
    case = page.context["case"]
    return case and case.example.pk


def act(client, verb, example, run, query="", **values):
    """Post what the page's forms post, as htmx does."""
    address = f"/w/home/review/{example}/{verb}/?run={run.pk}{query}"
    return client.post(address, {"run": run.pk, **values}, headers={"HX-Request": "true"})


def test_without_a_run_the_newest_one_with_answers_is_shown(other, anna):
    page = anna.get("/w/home/review/", {"outcome": "wrong"})
    assert [run.pk for run in page.context["runs"]] == [other.pk]


def test_an_address_that_asks_for_nothing_leads_to_the_first_wrong_answer(other, anna):
    page = anna.get("/w/home/review/", follow=True)
    address, status = page.redirect_chain[-1]
    assert status == 302
    assert address == f"/w/home/review/?run={other.pk}&outcome=wrong&part=validation"
    assert shown(page) == wrong_of(other)[0]
    assert page.context["listing"].total == len(wrong_of(other))


def test_the_test_part_is_not_opened_by_itself(run, anna):
    run.split.examples.update(part="test")
    page = anna.get("/w/home/review/", follow=True)
    assert page.redirect_chain[-1][0] == f"/w/home/review/?run={run.pk}"
    assert page.context["listing"].total == 12


def test_a_world_without_answers_says_so(world, anna):
    page = anna.get("/w/home/review/")
    assert page.status_code == 200 and page.context["runs"] == []
    assert '<div class="empty">' in page.content.decode()


def test_the_first_wrong_answer_comes_first(run, anna):
    page = look(anna, run, outcome="wrong")
    assert shown(page) == wrong_of(run)[0]
    assert page.context["place"].summary == "1 of 9"
    assert page.context["place"].before is None
    assert page.context["place"].after == wrong_of(run)[1]


def test_an_example_has_its_address(run, anna):
    last = wrong_of(run)[-1]
    page = look(anna, run, outcome="wrong", example=last)
    assert shown(page) == last
    assert (page.context["place"].before, page.context["place"].after) == (wrong_of(run)[-2], None)


def test_an_example_outside_the_filters_is_shown_all_the_same(run, anna):
    right = examples_of(run, is_exact_match=True)[0]
    page = look(anna, run, outcome="wrong", example=right)
    assert shown(page) == right and not page.context["place"].is_inside
    assert page.context["place"].total == 9


def test_an_example_of_another_split_is_not_found(run, anna):
    foreign = make_split(run.world, "foreign").examples.first()
    assert look(anna, run, example=foreign.pk).status_code == 404


def test_a_run_of_another_world_is_not_found(run, other_sample, anna):
    assert look(anna, other_sample.run).status_code == 404


def test_runs_of_one_split_stand_beside_each_other_in_the_order_of_the_address(run, other, anna):
    foreign = scored_run(run.world, make_split(run.world, "foreign"), seed=2)
    page = look(anna, other, run, foreign)
    assert [each.run.pk for each in page.context["case"].answers] == [other.pk, run.pk]


@pytest.mark.parametrize(
    ("chosen", "count"),
    [
        ({}, 12),
        ({"outcome": "wrong"}, 9),
        ({"outcome": "wrong", "source": "paraphrased"}, 6),
        ({"differ": "1"}, 2),
        ({"category": "wrong_predicate"}, 9),
        ({"category": "ill_formed"}, 0),
        ({"tagged": "nobody"}, 12),
        ({"tagged": "somebody"}, 0),
        ({"form": GO}, 9),
    ],
)
def test_the_address_filters(chosen, count, run, other, anna):
    assert look(anna, run, other, **chosen).context["listing"].total == count


def test_one_asks_where_one_run_is_right_and_the_other_wrong(run, other, anna):
    chosen = {"outcome": "wrong", "versus": other.pk, "versus_outcome": "correct"}
    assert look(anna, run, other, **chosen).context["listing"].total == 2


def test_tags_filter(run, rene, anna, reviewer):
    example = wrong_of(run)[3]
    category = ensure_categories(run.world)["ill_formed"]
    act(rene, "tag", example, run, category=category.pk)
    assert shown(look(rene, run, tagged="me")) == example
    assert look(anna, run, tagged="me").context["listing"].total == 0
    assert look(anna, run, tagged="nobody").context["listing"].total == 11
    assert shown(look(anna, run, category="ill_formed")) == example
    assert look(anna, run, category="wrong_predicate").context["listing"].total == 8


def test_only_where_the_runs_differ_begins_at_the_example_or_behind_it(run, other, rene):
    differing = [key for key in wrong_of(run) if key not in wrong_of(other)]
    page = rene.get(f"/w/home/review/?run={run.pk}&run={other.pk}&differ=1&from={differing[0] + 1}")
    assert page.url.endswith(f"differ=1&example={differing[1]}")
    assert f"run={run.pk}&run={other.pk}" in page.url
    beyond = rene.get(f"/w/home/review/?run={run.pk}&run={other.pk}&differ=1&from={10**9}")
    assert beyond.url.endswith(f"example={differing[0]}")


def test_the_diff_does_not_mind_the_order_of_conjuncts(run, anna):
    example = run.predictions.first().example
    label = '( find ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <room> " ) ) )'
    turned = '( find ( lambda $1 e ( at $1 " <room> " ) ( is_a $1 " <category> " ) ) )'
    run.split.examples.filter(pk=example.pk).update(logical_form=label)
    run.predictions.filter(example=example).update(logical_form=turned, is_exact_match=False)
    page = look(anna, run, example=example.pk).content.decode()
    changed = re.findall(r"<(?:mark|ins|del)>(.*?)</", page)
    assert set(changed) == {"⟨object⟩", "⟨category⟩"}  # in the annotated form, and in the answer


def test_what_an_answer_lacks_is_marked_in_the_annotated_form_beside_one_run_alone(
    run, other, anna
):
    example = run.split.examples.get(pk=wrong_of(run)[0])
    label = '( find ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <room> " ) ) )'
    run.split.examples.filter(pk=example.pk).update(logical_form=label)
    lacking = '( find ( lambda $1 e ( is_a $1 " <object> " ) ) )'
    Prediction.objects.filter(example=example).update(logical_form=lacking, is_exact_match=False)
    page = look(anna, run, example=example.pk).content.decode()
    assert "at(x, ⟨room⟩)" in "".join(re.findall(r"<del>(.*?)</del>", page))
    assert "<del>" not in look(anna, run, other, example=example.pk).content.decode()


def test_a_run_is_put_away_and_another_one_shown_beside(run, other, anna):
    third = scored_run(run.world, run.split, seed=2)
    page = look(anna, run, other, outcome="wrong")
    here = f"outcome=wrong&example={shown(page)}"
    assert [url for _, url in page.context["answers"]] == [
        f"?run={other.pk}&{here}",
        f"?run={run.pk}&{here}",
    ]
    assert [key for key, _ in page.context["addable"]] == [third.pk]
    alone = look(anna, run)
    assert "review-remove" not in alone.content.decode()


def test_all_candidates_are_shown_in_order(run, anna):
    best = run.predictions.first()
    Prediction.objects.create(
        run=run,
        example=best.example,
        rank=2,
        logical_form="( follow UNKNOWN )",
        score=0.25,
        is_exact_match=False,
        is_equivalent=False,
        is_well_formed=True,
    )
    page = look(anna, run, example=best.example_id)
    assert [each.rank for each in page.context["case"].answers[0].candidates] == [1, 2]
    assert "0.250" in page.content.decode()


@pytest.mark.parametrize(
    ("met", "verdict"),
    [
        ((True, True, True), "exact"),
        ((False, True, True), "equivalent"),
        ((False, False, True), "same plan"),
        ((False, False, False), "wrong"),
        ((False, False, None), "wrong"),
    ],
)
def test_the_page_says_which_measure_an_answer_meets(run, anna, met, verdict):
    answer = run.predictions.first()
    names = ("is_exact_match", "is_equivalent", "is_same_plan")
    Prediction.objects.filter(pk=answer.pk).update(**dict(zip(names, met, strict=True)))
    page = look(anna, run, example=answer.example_id).content.decode()
    assert verdict in re.findall(r'<span class="verdict[^"]*">\S\s+([^<]+)</span>', page)


def test_an_example_that_one_run_was_not_asked_about_says_so(run, other, anna):
    other.predictions.filter(example=wrong_of(run)[0]).delete()
    page = look(anna, run, other, example=wrong_of(run)[0])
    asked, not_asked = page.context["case"].answers
    assert (asked.first is not None, not_asked.first) == (True, None)
    assert f'id="answer-{other.pk}"' in page.content.decode()


def test_a_paraphrase_leads_to_the_command_that_it_rewrites(run, anna):
    command = run.world.commands.first()
    run.split.examples.update(source_command=command.anonymized_text)
    assert f'href="/w/home/commands/{command.pk}/"' in look(anna, run).content.decode()


def test_the_reader_tags_accepts_and_takes_back(run, rene):
    example = wrong_of(run)[0]
    category = ensure_categories(run.world)["wrong_structure"]
    take_back = 'value="take_back"'
    page = act(rene, "tag", example, run, category=category.pk).content.decode()
    assert take_back in page and "<html" not in page
    assert run.reviews.by_people().get().category == category
    act(rene, "tag", example, run, step="accept")
    assert run.reviews.by_people().get().category.code == "wrong_predicate"
    page = act(rene, "tag", example, run, step="take_back").content.decode()
    assert take_back not in page
    assert not run.reviews.by_people().exists()


def test_what_cannot_be_done_is_said(run, rene):
    for sent in ({"step": "take_back"}, {"category": 10**6}):
        page = act(rene, "tag", wrong_of(run)[0], run, **sent)
        problem = re.search(
            r'id="review-problem" role="alert"([^>]*)>(.*?)<', page.content.decode()
        )
        assert "hidden" not in problem[1] and problem[2] == page.context["problem"] != ""
    assert not run.reviews.by_people().exists()


def test_without_a_script_one_comes_back_to_the_example(run, other, rene):
    example = wrong_of(run)[1]
    address = f"/w/home/review/{example}/note/?run={run.pk}&run={other.pk}&outcome=wrong"
    page = rene.post(address, {"run": other.pk, "note": "Odd."})
    assert page.url == (
        f"/w/home/review/?run={run.pk}&run={other.pk}&outcome=wrong"
        f"&example={example}&focus={other.pk}"
    )
    assert rene.get(page.url).context["focus"] == other.pk


def test_what_users_write_is_escaped(run, rene, reviewer):
    text = "<script>alert(1)</script>"
    example = wrong_of(run)[0]
    run.split.examples.filter(pk=example).update(utterance=text)
    run.predictions.filter(example=example).update(logical_form=text)
    ensure_categories(run.world)
    run.world.error_categories.update(name=Concat(Value(text), "code"), description=text)
    type(reviewer).objects.filter(pk=reviewer.pk).update(username=text)
    act(rene, "note", example, run, note=text)
    page = look(rene, run, example=example).content.decode()
    assert text not in page and page.count(escape(text)) > 5


def test_a_label_in_doubt_goes_to_the_queue_with_the_reason(run, rene):
    example = run.split.examples.get(pk=wrong_of(run)[0])
    make_paraphrase(
        run.world, "go", example.utterance, logical_form=example.logical_form, grounded_form=GO
    )
    page = act(rene, "doubt", example.pk, run, reason="It says go.", right=GO)
    assert page.context["said"] in page.content.decode() and not page.context["problem"]
    item = run.world.work_items.get()
    assert item.kind == "audit" and item.reason.endswith("It says go.")
    assert item.reason.startswith("rene ")
    assert item.open_finding.suggested_form == GO
    assert act(rene, "doubt", example.pk, run).context["problem"]
    assert run.world.work_items.count() == 1


def test_the_utterance_is_edited_where_the_shown_runs_answer(run, other, rene):
    page = look(rene, run, other, example=run.predictions.first().example_id).content.decode()
    address = re.search(r'href="([^"]*/parse/[^"]*)"\s+data-action="edit"', page)[1].replace(
        "&amp;", "&"
    )
    tried = rene.get(address)
    assert tried.context["chosen_beside"] == [run, other]
    assert tried.context["text"] == run.predictions.first().example.utterance


def test_annotators_read_and_do_not_tag(run, anna):
    page = look(anna, run).content.decode()
    assert "data-review-palette" not in page and "data-review-doubt" not in page
    assert act(anna, "tag", wrong_of(run)[0], run, step="accept").status_code == 403


def test_an_error_that_was_tagged_in_an_earlier_run_says_so(run, rene, reviewer):
    act(rene, "tag", wrong_of(run)[0], run, step="accept")
    later = scored_run(run.world, make_split(run.world, "newer"), seed=1)
    propose_for_run(later, frozenset(), UNWATCHED)
    page = look(rene, later, earlier="tagged")
    assert page.context["listing"].total == 1
    (answered,) = page.context["case"].answers
    (before,) = answered.earlier
    assert (before.reviewer, before.run) == (reviewer, run)
    assert before.answer == answered.first.logical_form
    assert f'href="?run={run.pk}&amp;example={before.example_id}"' in page.content.decode()
    later.reviews.proposed().filter(example=shown(page)).update(is_new=True)
    assert look(rene, later, earlier="new").context["listing"].total == 1
    state = rene.get(f"/w/home/runs/{later.pk}/").content.decode()
    assert re.search(r'earlier=tagged"[^>]*>\s*1 ', state)


def test_the_tags_of_two_people_are_shown_and_counted(run, rene, adam):
    example = wrong_of(run)[0]
    act(rene, "tag", example, run, step="accept")
    act(adam, "tag", example, run, category=ensure_categories(run.world)["ill_formed"].pk)
    page = look(rene, run, example=example)
    (answered,) = page.context["case"].answers
    assert {str(each.reviewer) for each in answered.tags} == {"rene", "adam"}
    assert str(answered.own.reviewer) == "rene"
    assert page.content.decode().count("tag--given") == 2


def test_a_page_costs_few_queries(run, other, rene, django_assert_max_num_queries):
    rene.get("/w/home/review/")
    with django_assert_max_num_queries(31):  # the rail counts in two
        look(rene, run, other, outcome="wrong")


def test_reviews_of_a_deleted_account_are_shown(run, rene, reviewer, admin):
    act(rene, "tag", wrong_of(run)[0], run, step="accept")
    reviewer.delete()
    assert Review.objects.by_people().count() == 1
    page = look(client_of(admin), run, example=wrong_of(run)[0])
    ((tagged,),) = (each.tags for each in page.context["case"].answers)
    assert tagged.reviewer is None and "tag--given" in page.content.decode()


def test_a_new_answer_is_not_taken_for_the_one_that_was_tagged(run, rene):
    example = run.split.examples.get(pk=wrong_of(run)[0])
    act(rene, "tag", example.pk, run, step="accept")
    run.predictions.filter(example=example).delete()
    answer(run, example, "( follow UNKNOWN )")
    (answered,) = look(rene, run, example=example.pk).context["case"].answers
    assert answered.tags[0].answer != answered.first.logical_form == "( follow UNKNOWN )"
