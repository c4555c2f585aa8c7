"""Which parser is recommended with what a split holds; the figures are those of the docs' table."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from annotations.language.corpus import FormOverlap, Overlap
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.recommendation import (
    MEASURED,
    TrainingMaterial,
    expectation_of,
    recommend,
)
from parser_service.parsers.registry import parsers

DOCS = Path(__file__).resolve().parents[3] / "docs/design/parsers.md"
DOMAIN, STRICT = Protocol.DOMAIN, Protocol.STRICT
LINEAR = frozenset({"linear"})


def asked(known: int, new: int = 0, taught: int = 12, new_commands: int = 0) -> Overlap:
    """What is asked of a source: each form once, ``known`` of them with ``taught`` training pairs."""
    forms = (FormOverlap(1, taught),) * known + (FormOverlap(1, 0),) * new
    return Overlap(forms, new_commands)


def material(
    commands=800, paraphrases=1200, has_ontology=True, trained=frozenset(), **by_source: Overlap
) -> TrainingMaterial:
    return TrainingMaterial(commands, paraphrases, has_ontology, by_source, trained)


FULL = {"generated": asked(100), "paraphrased": asked(100)}
THIRD = {"generated": asked(60, 30), "paraphrased": asked(10, 5)}
NONE = {"generated": asked(0, 80), "paraphrased": asked(0, 20)}
# A sample of a competition's language: few pairs of each of many forms.
SAMPLE = {"generated": asked(191, 9, taught=2), "paraphrased": asked(25, taught=4)}


@pytest.mark.parametrize(
    ("has", "lacking", "expected"),
    [
        (material(30, 10), (), ("knn", STRICT)),
        (material(30, 10, **NONE), (), ("ranker", DOMAIN)),
        (material(30, 10, trained=frozenset({"knn"})), (), ("linear", DOMAIN)),
        (material(), (), ("linear", DOMAIN)),
        (material(**FULL), (), ("linear", DOMAIN)),
        (material(has_ontology=False, **FULL), (), ("linear", STRICT)),
        (material(trained=LINEAR, **FULL), (), ("ranker", STRICT)),
        (material(trained=LINEAR, **FULL), {"ranker"}, ("linear", DOMAIN)),
        (material(trained=LINEAR, paraphrases=0, **FULL), (), ("ranker", DOMAIN)),
        (material(paraphrases=0, has_ontology=False, trained=LINEAR), (), ("ranker", STRICT)),
        (
            material(trained=LINEAR, paraphrased=asked(100, new_commands=100)),
            (),
            ("ranker", DOMAIN),
        ),
        (material(**THIRD), (), ("ranker", DOMAIN)),
        (material(**NONE), (), ("ranker", DOMAIN)),
        (material(**NONE), {"ranker"}, ("seq2seq", STRICT)),
        (material(1400, 172, **SAMPLE), (), ("ranker", DOMAIN)),
        (material(1400, 172, **SAMPLE), {"ranker"}, ("seq2seq", STRICT)),
        (material(1400, 0, generated=SAMPLE["generated"]), (), ("ranker", DOMAIN)),
    ],
)
def test_the_parser_follows_from_what_there_is(has, lacking, expected):
    advice = recommend(has, lacking)
    assert (advice.parser, advice.protocol) == expected
    assert advice.protocol in parsers()[advice.parser].protocols
    assert advice.reason.endswith(".")


@pytest.mark.parametrize("overlaps", [FULL, THIRD, NONE, SAMPLE, {}])
@pytest.mark.parametrize("trained", [frozenset(), LINEAR])
def test_it_never_recommends_what_lacks_something(overlaps, trained):
    assert recommend(material(trained=trained, **overlaps), {"ranker"}).parser != "ranker"


@pytest.mark.parametrize("overlaps", [THIRD, NONE])
@pytest.mark.parametrize("lacking", [(), {"ranker"}])
def test_where_a_third_is_new_no_parser_of_known_forms_is_recommended(overlaps, lacking):
    for pairs in (50, 1000):
        advice = recommend(material(pairs, pairs, **overlaps), lacking)
        assert parsers()[advice.parser].writes_new_forms


def test_a_parser_of_known_forms_is_expected_to_be_right_on_those_alone():
    for name in ("knn", "linear"):
        full, third, none = (expectation_of(name, material(**each)) for each in (FULL, THIRD, NONE))
        assert (none.generated, none.said) == (0, 0)
        assert third.generated == pytest.approx(full.generated * 2 / 3)
        assert third.said == pytest.approx(full.said * 2 / 3)


def test_few_pairs_of_a_form_are_expected_to_teach_little():
    expected = expectation_of("linear", material(1400, 172, **SAMPLE))
    assert expected.generated < 0.2 < 0.7 < expected.said
    assert expected.accuracy == "12 % of generated commands; 76 % of what people say"
    assert expectation_of("ranker", material(1400, 172, **SAMPLE)).generated > 0.9


def test_paraphrases_to_learn_from_raise_what_to_expect_of_people():
    shares = [
        expectation_of("ranker", material(paraphrases=count, **FULL)).said
        for count in (0, 100, 200, 5000)
    ]
    assert shares == [pytest.approx(each) for each in (0.71, 0.795, 0.88, 0.88)]
    others = material(paraphrased=asked(100, new_commands=100))
    assert expectation_of("ranker", others).said == pytest.approx(0.74)


def test_without_a_word_of_people_generated_commands_say_which_forms_they_ask_for():
    said = expectation_of("linear", material(generated=asked(50, 50))).said
    assert said == pytest.approx(0.4)
    assert expectation_of("linear", material()).said == pytest.approx(0.8)


@pytest.mark.parametrize("parser", parsers())
@pytest.mark.parametrize("overlaps", [FULL, THIRD, NONE, SAMPLE, {}])
def test_what_to_expect_is_a_share(parser, overlaps):
    expected = expectation_of(parser, material(**overlaps))
    for share in (expected.generated, expected.said) if expected else ():
        assert share is None or 0 <= share <= 1


def rows_of_the_docs() -> dict[str, list[str]]:
    """Parser → the cells that "What to expect" gives for it."""
    text = DOCS.read_text(encoding="utf-8")
    table = text.partition("## What to expect")[2].partition("The first four")[0]
    rows = re.findall(r"^\| `([\w-]+)` \| (.*) \|$", table, re.MULTILINE)
    return {name: [cell.strip() for cell in cells.split("|")] for name, cells in rows}


def test_what_pages_expect_is_what_the_docs_say():
    rows = rows_of_the_docs()
    assert rows.keys() == MEASURED.keys()
    for name, measured in MEASURED.items():
        shares = (
            measured.said,
            measured.from_generated,
            measured.other_commands,
            measured.new_forms,
        )
        cells = ["–" if share is None else f"{100 * share:.0f}" for share in shares]
        by_pairs = ", ".join(f"{least}: {100 * share:.0f}" for least, share in measured.generated)
        assert rows[name] == [*cells, by_pairs or "–"], name


def test_a_parser_that_writes_no_new_form_is_right_on_none():
    for name, measured in MEASURED.items():
        assert measured.new_forms == 0 or parsers()[name].writes_new_forms
