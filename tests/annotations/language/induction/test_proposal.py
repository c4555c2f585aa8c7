"""Proposals: what lines make, what is left for a person to say, and that the oracle understands the lines by them."""

from __future__ import annotations

from time import process_time

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from annotations.language.forms import Application, Wildcard, canonical_text, to_template
from annotations.language.induction import (
    MOST_LINES,
    KnownWorld,
    Mark,
    OfferKind,
    Proposal,
    Rule,
    propose,
    read_example,
    with_class_named,
    with_predicate_named,
)
from annotations.language.world import PredicateKind
from benchmarks.language.induction import grounded, oracle_of

GREENHOUSE = """
water the [tomatoes](plant) in [bed two](bed)
water the [roses]
prune the [roses] with the [shears](tool)
go to the [shed](place)
take the [shears] and bring them to the [shed]
turn off the [lamp](device)
"""


def signatures(proposal: Proposal) -> dict[str, list[str]]:
    return {
        each.predicate.name: [str(signature) for signature in each.predicate.signatures]
        for each in proposal.predicates
    }


def test_a_greenhouse_is_proposed() -> None:
    proposal = propose(GREENHOUSE)
    assert {each.token: each.texts for each in proposal.classes} == {
        "plant": ("tomatoes", "roses"),
        "bed": ("bed two",),
        "tool": ("shears",),
        "place": ("shed",),
        "device": ("lamp",),
    }
    assert signatures(proposal) == {
        "water": ["(plant)", "(plant, bed)"],
        "prune": ["(plant, tool)"],
        "go": ["(place)"],
        "take": ["(tool)"],
        "bring": ["(tool, place)"],
        "turn_off": ["(device)"],
    }
    assert all(each.predicate.kind is PredicateKind.ACTION for each in proposal.predicates)
    glosses = {each.predicate.name: each.predicate.gloss for each in proposal.predicates}
    assert glosses["water"] == "water {1} | water {1} in {2}"
    templates = {each.pattern: each.form for each in proposal.templates}
    assert templates["bring the {tool} to the {place}"] == "(bring {tool} {place})"


def test_other_verbs_are_one_predicate_only_when_somebody_says_so() -> None:
    lines = "water the [roses] in [bed two]\nirrigate the [roses] in [bed two]"
    apart = propose(lines)
    assert signatures(apart).keys() == {"water", "irrigate"}
    assert [(each.kind, each.first, each.second) for each in apart.doubts] == [
        ("predicate", "water", "irrigate")
    ]
    joined = propose(with_predicate_named(lines, apart, "irrigate", "water"))
    assert signatures(joined).keys() == {"water"}
    assert [each.phrases for each in joined.synonyms] == [(("water",), ("irrigate",))]
    assert len(joined.templates) == 1


def test_roles_that_take_one_anothers_place_are_predicates_of_their_own() -> None:
    lines = "bring [the hose]\nbring [the hose] to [bed two]\nbring [the hose] from [bed two]"
    assert signatures(propose(lines)).keys() == {"bring", "bring_from"}


def test_naming_a_class_names_all_its_marks_and_no_other() -> None:
    lines = "water the [roses]\nwater the [tulips]\ngo to the [shed]"
    proposal = propose(lines)
    token = proposal.tokens[Mark("roses")]
    named = with_class_named(lines, proposal, token, "plant")
    assert named == "water the [roses](plant)\nwater the [tulips](plant)\ngo to the [shed]"


def test_marks_of_different_named_classes_stay_apart() -> None:
    proposal = propose("go to the [shed](place)\ngo to the [roses](plant)\ngo to the [tulips]")
    assert {each.token for each in proposal.classes} >= {"place", "plant"}


def test_a_form_may_be_given() -> None:
    proposal = propose('bring the [hose](tool) = (bring (λ$1:e (is_a $1 "hose")))')
    assert [each.form for each in proposal.templates] == ["(bring (λ$1:e (is_a $1 {tool})))"]


def test_offers_are_lines_that_can_be_taken() -> None:
    proposal = propose(GREENHOUSE + "unload the [van](device) at the [shed]")
    lines = {each.kind: each.line for each in proposal.offers}
    assert lines.keys() >= {OfferKind.ORDER, OfferKind.WORDING}
    taken = propose("\n".join([GREENHOUSE, *(each.line for each in proposal.offers)]))
    assert not taken.problems
    assert signatures(taken).keys() >= signatures(proposal).keys()


def test_what_the_world_has_is_used() -> None:
    form = Application("water", (Wildcard("plant", id=1), Wildcard("bed", id=2)))
    known = KnownWorld(
        texts={"rose": "plant"},
        rules=(Rule(("irrigate", "the", "<plant>", "in", "<bed>"), form),),
        nonterminals=frozenset(("hose",)),
    )
    lines = "irrigate the [roses] in the [north wall]\nhose the [roses]\nspray the [roses] = hose"
    proposal = propose(lines, known)
    assert {each.token for each in proposal.classes} == {"plant", "bed"}
    assert signatures(proposal).keys() == {"water", "hose"}
    assert [each.name for each in proposal.synonyms] == ["hose2"]


PLANTS, BEDS = ["roses", "tomatoes", "old oak"], ["bed two", "bed three", "the north wall"]
VERBS = st.sampled_from(["water", "prune", "inspect", "cover up"])


@st.composite
def lines(draw: st.DrawFn) -> str:
    verb, plant = draw(VERBS), draw(st.sampled_from(PLANTS))
    place = draw(st.sampled_from([None, *BEDS]))
    preposition = draw(st.sampled_from(["in", "near"]))
    behind = f" {preposition} [{place}](bed)" if place else ""
    return f"{verb} the [{plant}](plant){behind}"


@settings(max_examples=25, deadline=None)
@given(st.lists(lines(), min_size=1, max_size=6, unique=True))
def test_the_oracle_of_a_proposal_understands_every_line(written: list[str]) -> None:
    proposal = propose("\n".join(written))
    oracle = oracle_of(proposal)
    for line in written:
        example = read_example(line)
        (candidate, *_) = oracle.predict([example.text])[0]
        said = {Mark(each.text, each.entity_class).text for each in example.marks}
        assert set(candidate.values) == said, (line, candidate)
        form = grounded(candidate)
        (head,) = proposal.predicates_of_lines[written.index(line) + 1]
        assert canonical_text(form).split()[1] == head


@pytest.mark.parametrize("line", ["stop", "[bed two]", "in the [bed]", "and", "[a] [b] [c]", "= "])
def test_odd_lines_make_something_or_a_problem(line: str) -> None:
    proposal = propose(line)
    assert proposal.problems or proposal.templates


def test_very_many_classes_without_a_name_have_tokens() -> None:
    proposal = propose("\n".join(f"w{n} [x{n}]" for n in range(60)))
    assert len({each.token for each in proposal.classes}) == 60


def test_a_doubt_that_is_denied_is_not_asked_again() -> None:
    lines = "water the [roses] in [bed two]\nirrigate the [roses] in [bed two]\ngo in the [shed]"
    doubts = propose(lines).doubts
    assert {each.kind for each in doubts} == {"predicate", "class"}
    assert not propose("\n".join([lines, *(each.comment for each in doubts)])).doubts


@pytest.mark.parametrize("line", ["say <b> to [x]", "give $5 to [x]", "go " * 40])
def test_what_no_template_can_say_is_refused(line: str) -> None:
    assert propose(line).problems and not propose(line).templates


def test_lines_that_are_alike_are_compared_only_so_often() -> None:
    begun = process_time()
    proposal = propose(
        "\n".join(f"v{n} {'same ' * 25}the [x{n % 7}](thing)" for n in range(MOST_LINES))
    )
    assert process_time() - begun < 10  # every pair of them took 26 s
    assert len(proposal.templates) >= MOST_LINES and proposal.doubts


def understood(lines: str, said: str) -> str:
    found = oracle_of(propose(lines)).predict([said])[0]
    return to_template(grounded(found[0])) if found else ""


CLINIC = """
call [doctor Brandt](staff)
guide [Mrs Alvarez](patient) to [room nine](room)
find the book [Moby Dick](book)
feed [goat Ella](animal)
"""


@pytest.mark.parametrize(
    "said, form",
    [
        ("call the doctor Brandt", '(call "doctor Brandt")'),
        ("call Dr. Brandt", '(call "doctor Brandt")'),
        ("call Brandt", '(call "doctor Brandt")'),
        ("call Brandt the doctor", '(call "doctor Brandt")'),
        ("guide the patient Alvarez to the room nine", '(guide "Mrs Alvarez" "room nine")'),
        ("guide Missus Alvarez to room number nine", '(guide "Mrs Alvarez" "room nine")'),
        ("find the book Moby Dick", '(find_book "Moby Dick")'),
        ("call nurse Brandt", ""),
        ("guide the doctor Alvarez to room nine", ""),
    ],
)
def test_people_and_things_are_named_with_titles_and_nouns(said: str, form: str) -> None:
    assert understood(CLINIC, said) == form


def test_a_title_before_a_mark_is_part_of_the_name() -> None:
    proposal = propose("call the doctor [Brandt](staff)\nask the nurse [in charge](staff)")
    assert [each.texts for each in proposal.classes] == [("doctor Brandt", "in charge")]
    assert [each.pattern for each in proposal.templates] == [
        "call the {staff}",
        "ask the nurse {staff}",
    ]


def test_a_name_is_no_other_name_twice_nor_where_it_is_refused() -> None:
    names = propose("call [doctor Kim](staff)\ncall [nurse Kim](staff)").names
    assert not any("Kim" in each for each in names.values())
    refused = propose("call [doctor Brandt](staff)\n# [Brandt] is not [doctor Brandt]").names
    assert "Brandt" not in refused["doctor Brandt"] and "Dr Brandt" in refused["doctor Brandt"]


def test_what_stands_in_front_of_a_command_is_no_command() -> None:
    proposal = propose("in [bed two](bed), water the [roses](plant), then go to the [shed](place)")
    assert signatures(proposal) == {"water": ["(plant, bed)"], "go": ["(place)"]}
