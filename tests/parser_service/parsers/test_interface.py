import pytest

from annotations.language.world import Ontology
from parser_service.parsers.interface import Candidate, Knowledge

EVERYTHING = Knowledge(predicates={}, ontology=Ontology(()), grammar=())


@pytest.mark.parametrize("protocol", ["strict", "domain", "grammar"])
def test_knowledge_is_cut_to_its_protocol(protocol):
    assert EVERYTHING.limited_to(protocol).protocol == protocol


def test_the_strict_protocol_knows_nothing():
    assert EVERYTHING.limited_to("strict") == Knowledge()


def test_the_domain_protocol_hides_the_grammar():
    limited = EVERYTHING.limited_to("domain")
    assert limited.ontology is EVERYTHING.ontology and limited.grammar is None


def test_form_and_score_alone_tell_two_answers_apart():
    told = Candidate("( go )", 0.5, "training", {"similarity": 0.5})
    assert told == Candidate("( go )", 0.5)
    assert len({told, Candidate("( go )", 0.5)}) == 1
    assert told != Candidate("( go )", 0.6)
