"""Reading what a run says: filters, the difference of two forms, the way to the review page."""

from __future__ import annotations

import re

import pytest
from django.utils.html import escape

from parser_service.models import Prediction
from parser_service.templatetags.provenance import (
    cut_in_words,
    origin_in_words,
    score_kind_in_words,
    seen_in_training,
)

VERDICT = re.compile(r'<span class="verdict[^"]*">\S\s+([^<]+)</span>')


def predictions(client, sample, **chosen):
    return client.get(f"/w/home/runs/{sample.run.pk}/predictions/", chosen)


def totals(client, sample, **chosen):
    return predictions(client, sample, **chosen).context["listing"].total


def test_every_example_has_one_line(sample, anna):
    assert totals(anna, sample) == 12


@pytest.mark.parametrize(
    ("chosen", "count"),
    [
        ({"outcome": "correct"}, 3),
        ({"outcome": "wrong"}, 9),
        ({"outcome": "malformed"}, 0),
        ({"outcome": "none"}, 0),
        ({"part": "test"}, 0),
        ({"part": "validation", "source": "generated"}, 6),
        ({"q": "FETCH"}, 2),
    ],
)
def test_predictions_are_filtered_by_the_url(chosen, count, sample, anna):
    assert totals(anna, sample, **chosen) == count


def test_an_answer_that_is_right_but_for_the_order_is_found(sample, anna):
    wrong = Prediction.objects.filter(is_exact_match=False).first()
    Prediction.objects.filter(pk=wrong.pk).update(is_equivalent=True)
    assert totals(anna, sample, outcome="equivalent") == 1
    assert "equivalent" in predictions(anna, sample, outcome="equivalent").content.decode()


def test_an_answer_with_the_same_plan_says_so_and_one_without_a_comparison_does_not(sample, anna):
    wrong = Prediction.objects.filter(is_exact_match=False).first()
    Prediction.objects.filter(pk=wrong.pk).update(is_same_plan=True)
    assert totals(anna, sample, outcome="only_plan") == 1
    page = predictions(anna, sample, outcome="only_plan").content.decode()
    assert VERDICT.findall(page) == ["same plan"]
    Prediction.objects.filter(pk=wrong.pk).update(is_same_plan=None)
    assert totals(anna, sample, outcome="only_plan") == 0
    assert totals(anna, sample, outcome="other_plan") == 8


def test_the_head_predicate_of_the_annotated_form_filters(sample, anna):
    listing = predictions(anna, sample, head="find").context["listing"]
    assert listing.total == sum("( find " in row.example.logical_form for row in listing.rows)
    assert 0 < listing.total < 12


def test_a_wrong_answer_shows_the_difference(sample, anna):
    page = predictions(anna, sample, outcome="wrong").content.decode()
    assert "<mark" in page or "<del" in page
    assert "✗" in page


def test_no_answer_is_told_as_such(sample, anna):
    Prediction.objects.filter(is_exact_match=False).update(logical_form="", is_well_formed=False)
    assert "no answer" in predictions(anna, sample, outcome="none").content.decode()


def test_text_that_is_no_form_is_shown_as_it_is(sample, anna):
    Prediction.objects.filter(is_exact_match=False).update(
        logical_form="( bring <b> (", is_well_formed=False
    )
    page = predictions(anna, sample, outcome="malformed").content.decode()
    assert "( bring &lt;b&gt; (" in page
    assert "malformed" in page


def test_the_list_costs_no_query_a_row(sample, anna, django_assert_max_num_queries):
    with django_assert_max_num_queries(18):
        predictions(anna, sample)


def test_each_prediction_leads_to_the_review_page_with_the_same_filters(sample, anna):
    page = predictions(anna, sample, outcome="wrong", sort="score").content.decode()
    wrong = sample.run.predictions.filter(is_exact_match=False).first()
    address = (
        f"/w/home/review/?run={sample.run.pk}&amp;outcome=wrong&amp;example={wrong.example_id}"
    )
    assert f'href="{address}"' in page
    answer = anna.get(address.replace("&amp;", "&"))
    assert answer.context["case"].example == wrong.example


def seen(sample, **facts):
    """Store facts about the first answer of the run and return the addresses of its list and its page."""
    first = sample.run.predictions.best().order_by("example_id").first()
    Prediction.objects.filter(pk=first.pk).update(**facts)
    listed = f"/w/home/runs/{sample.run.pk}/predictions/"
    return listed, f"/w/home/review/?run={sample.run.pk}&example={first.example_id}"


def test_a_form_tells_how_often_training_had_it_and_where_it_is_from(sample, anna):
    listed, page = seen(sample, answer_in_training=1200, label_in_training=1, origin="training")
    assert "1,200" in anna.get(listed).content.decode()
    text = anna.get(page).content.decode().lower()
    assert all(seen_in_training(count) in text for count in (1200, 1))
    listed, page = seen(sample, answer_in_training=0, label_in_training=0, origin="substitution")
    assert ">new</span>" in anna.get(listed).content.decode()
    first = sample.run.predictions.best().order_by("example_id").first()
    told = f"{seen_in_training(0).capitalize()}; {origin_in_words(first)}"
    assert origin_in_words(first) and told in anna.get(page).content.decode()


def test_an_answer_to_the_beginning_of_an_utterance_says_so(sample, anna):
    listed, page = seen(sample)
    whole = [anna.get(address).content.decode() for address in (listed, page)]
    seen(sample, is_cut=True)
    for parser in ("ranker", "t5"):
        sample.world.runs.update(parser=parser)
        told = escape(cut_in_words(parser))
        assert ("64" in told) == (parser == "ranker")
        assert all(told not in text for text in whole)
        assert anna.get(listed).content.decode().count(told) == 1
        assert anna.get(page).content.decode().count(told) == 2  # and a title


def test_what_is_not_known_of_an_older_answer_is_not_made_up(sample, anna):
    _, page = seen(sample)
    text = anna.get(page).content.decode()
    assert not any(seen_in_training(count).capitalize() in text for count in (0, 1))
    assert 'class="score-parts"' not in text


def test_the_parts_of_a_score_stand_in_a_table(sample, anna):
    _, page = seen(sample, score_parts={"glosses": 3.25, "mystery": -0.5})
    sample.world.runs.update(score_kind="log_probability")
    text = anna.get(page).content.decode()
    sample.run.refresh_from_db()
    assert all(part in text for part in ("3.250", "Mystery", "−0.500"))
    assert f"({score_kind_in_words(sample.run)})" in text


def test_answers_are_filtered_by_whether_training_had_their_form(sample, anna):
    seen(sample, answer_in_training=3, label_in_training=0)
    assert totals(anna, sample, answer="seen") == totals(anna, sample, label="new") == 1
    assert totals(anna, sample, answer="new") == totals(anna, sample, label="seen") == 0
