"""Freezing a split by page, and what its page says about it."""

from __future__ import annotations

from dataclasses import asdict

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from annotations.generation.split_statistics import figures_of, store_figures
from annotations.models import Split
from tests.parser_service.made_up import make_split

GOOD = {
    "name": "mine",
    "criterion": "logical_form",
    "train": "50",
    "validation": "0",
    "test": "50",
    "seed": "1",
}


def test_counting_first_stores_nothing(sample, anna):
    page = anna.post("/w/home/splits/new/", {**GOOD, "preview": "1"})
    (counts,) = page.context["counts"]
    assert (counts["source"], counts["total"], counts["forms"]) == ("generated", 3, 2)
    assert Split.objects.count() == 1


def test_freezing_leads_to_the_split(sample, anna, annotator):
    answer = anna.post("/w/home/splits/new/", {**GOOD, "freeze": "1"})
    made = Split.objects.get(name="mine")
    assert answer.url == f"/w/home/splits/{made.pk}/"
    assert (made.criterion, made.seed, made.created_by) == ("logical_form", 1, annotator)


def test_what_was_counted_is_what_is_frozen(sample, anna):
    counted = anna.post("/w/home/splits/new/", {**GOOD, "preview": "1"}).context["counts"]
    anna.post("/w/home/splits/new/", {**GOOD, "freeze": "1"})
    made = Split.objects.get(name="mine")
    frozen = figures_of(made).counts
    assert [{**asdict(each), "total": each.total} for each in frozen] == counted


@pytest.mark.parametrize(
    ("changes", "field", "named"),
    [
        ({"train": "90"}, "test", "140 %"),
        ({"name": "home-split"}, "__all__", "home-split"),
        ({"name": "two words"}, "name", ""),
        ({"seed": "-1"}, "seed", "0"),
    ],
)
def test_what_cannot_be_frozen_is_told_at_its_field(changes, field, named, sample, anna):
    answer = anna.post("/w/home/splits/new/", {**GOOD, **changes, "freeze": "1"})
    assert named in str(answer.context["form"].errors[field])
    assert Split.objects.count() == 1


def test_a_world_without_commands_cannot_be_split(world, anna):
    answer = anna.post("/w/home/splits/new/", {**GOOD, "freeze": "1"})
    assert answer.status_code == 200 and answer.context["form"].errors
    assert not world.splits.exists()


def test_the_list_counts_pairs_by_part_and_source(sample, anna):
    ((split, counts),) = anna.get("/w/home/splits/").context["rows"]
    assert split == sample.split
    assert [(each.source, each.train, each.validation, each.test) for each in counts] == [
        ("generated", 24, 6, 6),
        ("paraphrased", 24, 6, 6),
    ]


def test_the_list_costs_no_query_a_split(sample, anna, django_assert_num_queries):
    anna.get("/w/home/splits/")
    with CaptureQueriesContext(connection) as of_one:
        anna.get("/w/home/splits/")
    for number in range(5):
        make_split(sample.world, f"split-{number}")
    with django_assert_num_queries(len(of_one)):
        anna.get("/w/home/splits/")


def test_what_parts_share_is_shown_as_it_is(sample):
    for part, text in (("train", "go get the <object>"), ("test", "go get the <object>")):
        sample.split.examples.create(
            part=part,
            source="generated",
            utterance=text,
            source_command=text,
            logical_form="( go )",
            position=100,
        )
    store_figures(sample.split)
    leaks = {
        (leak.part, leak.what): (leak.shared, leak.pairs) for leak in figures_of(sample.split).leaks
    }
    assert leaks["test", "source commands"] == (1, 1)
    assert leaks["test", "utterances"][0] >= 1
    assert leaks["validation", "utterances"] == (0, 12)


def test_examples_are_filtered_by_part_and_source(sample, anna):
    chosen = {"part": "test", "source": "paraphrased"}
    listing = anna.get(f"/w/home/splits/{sample.split.pk}/", chosen).context["listing"]
    assert listing.total == 6
    assert {row.part for row in listing.rows} == {"test"}


def test_the_page_of_a_split_leads_to_its_exports(sample, anna):
    page = anna.get(f"/w/home/splits/{sample.split.pk}/").content.decode()
    for end in ("?as=jsonl", "?as=csv", "?as=txt&amp;source=generated&amp;part=train"):
        assert f"/api/v1/worlds/home/splits/{sample.split.pk}/export/{end}" in page


def test_near_duplicates_stand_beside_what_training_has(sample, anna):
    for part, text in (
        ("train", "Bring me the big <object>"),
        ("test", "bring me teh big <object>"),
    ):
        sample.split.examples.create(
            part=part, source="paraphrased", utterance=text, logical_form="( go )", position=100
        )
    address = f"/w/home/splits/{sample.split.pk}/"
    assert f'hx-get="{address}near/"' in anna.get(address).content.decode()
    answer = anna.get(f"{address}near/")
    duplicates = {leak.part: rows for leak, rows, _ in answer.context["parts"]}
    assert ("bring me teh big <object>", "bring me the big <object>") in [
        (each.utterance, each.training) for each in duplicates["test"]
    ]
    assert "Similarity" in answer.content.decode()


def test_more_comparisons_than_a_page_can_make_are_left_to_the_command(sample, anna, monkeypatch):
    monkeypatch.setattr("annotations.generation.split_statistics.comparisons", lambda *_: 10**9)
    page = anna.get(f"/w/home/splits/{sample.split.pk}/near/").content.decode()
    assert f"manage leakage home {sample.split.name}" in page
