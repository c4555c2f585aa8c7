"""Which parser is recommended with what a world has; rules and figures are those of the docs' table."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from annotations.language.corpus import Criterion
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.recommendation import (
    EXPECTED,
    ON_NEW_FORMS,
    RANKER,
    TrainingMaterial,
    expectation_of,
    recommend,
)
from parser_service.parsers.registry import PARSERS
from parser_service.results.published import published_accuracy

DOCS = Path(__file__).resolve().parents[3] / "docs/design/parsers.md"
DOMAIN, STRICT = Protocol.DOMAIN, Protocol.STRICT
FORM, SOURCE = Criterion.LOGICAL_FORM, Criterion.SOURCE_COMMAND
LINEAR = frozenset({"linear"})


def material(generated=800, paraphrases=1200, has_ontology=True, **others) -> TrainingMaterial:
    return TrainingMaterial(generated, paraphrases, has_ontology, **others)


@pytest.mark.parametrize(
    ("has", "lacking", "expected"),
    [
        (material(30, 10), (), ("knn", STRICT)),
        (material(30, 10, trained=frozenset({"knn"})), (), ("linear", DOMAIN)),
        (material(), (), ("linear", DOMAIN)),
        (material(has_ontology=False), (), ("linear", STRICT)),
        (material(trained=LINEAR), (), ("ranker", STRICT)),
        (material(trained=LINEAR, paraphrases=0), (), ("ranker", DOMAIN)),
        (material(trained=LINEAR, paraphrases=0, has_ontology=False), (), ("ranker", STRICT)),
        (material(trained=LINEAR, criterion=SOURCE), (), ("ranker", DOMAIN)),
        (material(trained=LINEAR), {"ranker"}, ("linear", DOMAIN)),
        (material(criterion=FORM), (), ("ranker", DOMAIN)),
        (material(criterion=FORM), {"ranker"}, ("seq2seq", STRICT)),
    ],
)
def test_the_parser_follows_from_what_there_is(has, lacking, expected):
    advice = recommend(has, lacking)
    assert (advice.parser, advice.protocol) == expected
    assert advice.protocol in PARSERS[advice.parser].protocols
    assert advice.reason.endswith(".")


def test_it_never_recommends_what_lacks_something():
    for trained in (frozenset(), LINEAR):
        for criterion in Criterion:
            has = material(criterion=criterion, trained=trained)
            assert recommend(has, {"ranker"}).parser != "ranker"


def rows_of_the_docs() -> dict[str, list[str]]:
    """Parser → the accuracies that "Which row to take" gives for it."""
    text = DOCS.read_text(encoding="utf-8")
    table = text.partition("## Which row to take")[2].partition("## ")[0]
    rows: dict[str, list[str]] = {}
    for line in table.splitlines():
        cells = [cell.strip() for cell in line.split("|")]
        if len(cells) > 4 and (named := re.match(r"`([\w-]+)`", cells[3])):
            rows.setdefault(named[1], []).append(re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", cells[4]))
    return rows


def test_what_pages_expect_is_what_the_docs_say():
    rows = rows_of_the_docs()
    expected = {name: [each.accuracy] for name, each in EXPECTED.items() if name in rows}
    expected["ranker"] = list(RANKER.values())
    assert rows.keys() == expected.keys()
    for name, said in expected.items():
        assert [each.replace(" %", "") for each in said] == rows[name], name


@pytest.mark.parametrize(
    ("has", "figure"),
    [
        (material(paraphrases=0), "71 %"),
        (material(), "86 to 89 %"),
        (material(criterion=SOURCE), "74 %"),
        (material(criterion=FORM), "61 %"),
    ],
)
def test_what_to_expect_of_the_ranker_depends_on_the_split(has, figure):
    assert expectation_of("ranker", has).accuracy.startswith(figure)


def test_by_form_nothing_is_expected_of_a_parser_that_answers_known_forms_alone():
    for name, entry in PARSERS.items():
        if not entry.writes_new_forms:
            expected = expectation_of(name, material(criterion=FORM))
            assert expected.accuracy == "0 % on unseen forms"


def test_by_form_the_papers_figure_stands_in_for_what_was_not_measured_here():
    for name, expected in ON_NEW_FORMS.items():
        assert expectation_of(name, material(criterion=FORM)).accuracy == expected
        if expected.endswith(" in the paper"):
            theirs = published_accuracy(name, ("gen+para", "para"), FORM)
            assert expected.startswith(f"{theirs:.0f} % ")
