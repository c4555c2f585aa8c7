"""The search of a whole world: every kind, the first few rows, and the list with the same words."""

from __future__ import annotations

import pytest

from annotations.labelling.collecting import collect
from annotations.models import Entity, Paraphrase
from gpsr_site.pages import search
from tests.sample_world import make_paraphrase


@pytest.fixture
def paraphrase(sample) -> Paraphrase:
    return make_paraphrase(
        sample.world,
        prompt="find the tea",
        utterance="where is my tea",
        grounded_form="( find )",
        logical_form="( find )",
    )


def matches_of(client, words):
    """Title → texts of the matches on the search page of ``home``."""
    groups = client.get("/w/home/search/", {"q": words}).context["groups"]
    return {group.title: [hit.text for hit in group.hits] for group in groups}


@pytest.mark.parametrize(
    ("words", "kind", "text"),
    [
        ("milk", "Entities", "milk"),
        ("is_a", "Predicates", "is_a"),
        ("kobject", "Productions", "$object = {{kobject}}"),
        ("vbfind", "Templates", "$vbfind the $object"),
        ("LOCATE", "Commands", "locate the <object>"),
        ("( go", "Logical forms", "go(⟨room⟩)"),
        ("my tea", "Paraphrases", "where is my tea"),
        ("say hello", "Utterances", "say hello"),
        ("home-sp", "Splits", "home-split"),
        ("knn", "Runs", "run {run}"),
        ("nearest neighbour", "Runs", "run {run}"),
        ("run {run}", "Runs", "run {run}"),
    ],
)
def test_every_kind_is_found(words, kind, text, sample, paraphrase, anna):
    collect(sample.world, ["say hello"])
    run = sample.run.pk
    assert text.format(run=run) in matches_of(anna, words.format(run=run))[kind]


def test_each_match_and_all_of_a_kind_are_linked(sample, anna):
    page = anna.get("/w/home/search/", {"q": "the <"})
    content = page.content.decode()
    command = sample.world.commands.first()
    assert f'href="/w/home/commands/{command.pk}/"' in content
    assert 'href="/w/home/commands/?q=the+%3C"' in content
    for group in page.context["groups"]:
        listed = anna.get(group.url).context["listing"]
        assert listed.total == group.count


def test_nothing_and_no_words_are_told(sample, anna):
    found = anna.get("/w/home/search/?q=zebra")
    assert not found.context["groups"] and "“zebra”" in found.content.decode()
    page = " ".join(anna.get("/w/home/search/").content.decode().split())
    assert (
        "Searches pages, worlds, documents, entities, predicates, productions, templates, commands, "
        "logical forms, paraphrases, utterances, splits and runs."
    ) in page


def test_a_match_leads_to_its_own_page(sample, anna):
    groups = anna.get("/w/home/search/", {"q": "find"}).context["groups"]
    hits = {group.title: group.hits[0].url for group in groups}
    predicate = sample.world.predicates.get(name="find")
    assert hits["Predicates"] == f"/w/home/predicates/{predicate.pk}/"
    assert hits["Productions"].startswith("/w/home/grammar/")
    assert all(anna.get(url).status_code == 200 for url in hits.values())


@pytest.mark.parametrize(
    "words", ["%", "_", "\\", "\0", "'", "<script>", "(" * 2000, "9" * 30, "²"]
)
def test_any_words_are_taken(words, sample, anna):
    page = anna.get("/w/home/search/", {"q": words})
    assert page.status_code == 200
    assert "<script>" not in page.content.decode().split("<main", 1)[1]


def test_other_worlds_are_not_searched(sample, other_sample, anna):
    words = other_sample.split.name
    assert matches_of(anna, words) == {}


@pytest.mark.parametrize("words", ["CAFETI", "cafetière", 'the "pot"'])
def test_entities_answer_to_their_aliases(words, sample, anna):
    entity = Entity.objects.filter(ontology__world=sample.world, text="milk").get()
    entity.aliases = ["cafetière", 'the "pot"']
    entity.save()
    assert matches_of(anna, words)["Entities"] == ["milk"]


@pytest.mark.parametrize("words", ["[", "]", ", "])
def test_what_stands_between_aliases_is_not_searched(words, sample, anna):
    Entity.objects.update(aliases=["tea pot", "kettle"])
    assert "Entities" not in matches_of(anna, words)


def found_by(client, words):
    """Title → texts and addresses of what the top bar lists while somebody types."""
    groups = client.get("/w/home/search/found/", {"q": words}).context["groups"]
    return {group.title: {hit.text: hit.url for hit in group.hits} for group in groups}


def test_pages_worlds_and_documents_are_found_by_their_names(sample, other_sample, anna):
    assert found_by(anna, "learn cur")["Pages"] == {"Learning curves": "/w/home/results/curves/"}
    assert found_by(anna, "inbox")["Pages"] == {"Inbox": "/inbox/"}
    assert found_by(anna, "hom")["Worlds"] == {"home": "/w/home/"}
    assert "Worlds" not in found_by(anna, other_sample.world.name)
    assert all(
        url.startswith("/docs/") for url in found_by(anna, "campaigns")["Documents"].values()
    )
    leads = anna.get("/w/home/search/", {"q": "learn cur"}).context["leads"]
    assert [hit.text for hit in leads[0].hits] == ["Learning curves"]


def test_a_page_is_found_by_those_alone_who_may_open_it(sample, anna, adam):
    assert "Pages" not in found_by(anna, "audit log")
    assert found_by(adam, "audit log")["Pages"] == {"Audit log": "/w/home/log/"}


@pytest.mark.parametrize("words", ["milk", "is_a", "locate", "home-sp", "nearest neighbour"])
def test_rows_are_found_while_somebody_types(words, sample, anna):
    listed, found = matches_of(anna, words), found_by(anna, words)
    assert {title: set(texts) for title, texts in listed.items()} == {
        title: set(hits) for title, hits in found.items() if title in listed
    }


def test_while_somebody_types_the_newest_rows_alone_are_read(sample, anna, monkeypatch):
    monkeypatch.setattr(search, "MOST_SCANNED", 1)
    newest = sample.world.commands.order_by("pk").last()
    words = newest.anonymized_text.split()[0]
    assert list(found_by(anna, words)["Commands"]) == [newest.anonymized_text]
    oldest = sample.world.commands.order_by("pk").first().anonymized_text
    assert "Commands" not in found_by(anna, oldest) and "Commands" in matches_of(anna, oldest)


def test_a_key_costs_as_many_queries_in_every_world(sample, anna, django_assert_max_num_queries):
    with django_assert_max_num_queries(24):
        found_by(anna, "the")
