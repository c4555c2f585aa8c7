"""What each decoding may answer: anything, forms of a list, or forms of the right types."""

import json

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from annotations.language.forms import read_form
from annotations.language.world import check_form, infer_signatures
from parser_service.parsers.interface import Knowledge
from parser_service.parsers.written_forms import canonical
from tests.parser_service.neural.t5.conftest import DECLARED, ODD, TWENTY, UTTERANCES, parser_of
from tests.parser_service.neural.t5.weights import make_random

pytestmark = pytest.mark.usefixtures("kept_there")


@pytest.fixture(scope="module")
def untrained(writers):
    """A parser of each decoding, and one that lists under domain, after one step."""

    def after_a_step(decoding, knowledge=None, encoder="t5"):
        parser = parser_of(1, knowledge, decoding=decoding, steps=1, encoder=encoder)
        parser.fit(TWENTY)
        return parser

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("parser_service.parsers.pretrained_files._encoders", writers)
        domain = Knowledge(predicates=DECLARED)
        return {
            "free": after_a_step("free"),
            "listed": after_a_step("listed"),
            "typed": after_a_step("typed"),
            "typed bart": after_a_step("typed", encoder="bart"),
            "listed domain": after_a_step("listed", domain),
            "typed domain": after_a_step("typed", domain),
        }


@pytest.mark.parametrize("name", ["listed", "listed domain"])
def test_what_is_listed_is_never_left(name, untrained):
    parser = untrained[name]
    listed = set(parser._targets.origins)
    for seed in range(2):
        for answer in make_random(parser, seed).predict([*UTTERANCES[:3], *ODD], 8):
            assert answer and {candidate.form for candidate in answer} <= listed


def test_a_list_shorter_than_the_beam_is_answered_whole(untrained):
    parser = untrained["listed"]
    listed = parser._targets.origins
    [answer] = parser.predict([UTTERANCES[0]], len(listed) + 20)
    assert {candidate.form for candidate in answer} == set(listed)


@pytest.mark.parametrize("name", ["typed", "typed bart", "typed domain"])
@settings(
    max_examples=4, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(seed=st.integers(0, 10**6), texts=st.lists(st.text(max_size=30), min_size=1, max_size=2))
def test_every_typed_answer_passes_the_checker(name, untrained, seed, texts):
    known = {
        "typed domain": DECLARED,
    }.get(name, infer_signatures(read_form(pair.form) for pair in TWENTY))
    for answer in make_random(untrained[name], seed).predict(texts, 2):
        assert answer
        for candidate in answer:
            assert canonical(candidate.form) == candidate.form
            assert not check_form(read_form(candidate.form), known)


def test_what_is_freely_written_may_be_no_form(untrained):
    answers = make_random(untrained["free"], 1).predict(UTTERANCES[:3], 2)
    assert any(canonical(candidate.form) is None for answer in answers for candidate in answer)


def test_strict_gets_no_domain_knowledge_and_domain_more_forms(untrained):
    strict, domain = untrained["listed"], untrained["listed domain"]
    of_pairs = {pair.form for pair in TWENTY}
    assert set(strict._targets.origins) == of_pairs < set(domain._targets.origins)
    assert "greet" not in json.dumps([strict._targets.to_json(), strict._network.atoms])
    assert {"greet:", ":<gesture>"} <= set(domain._network.atoms)
