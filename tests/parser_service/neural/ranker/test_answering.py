"""What a ranker answers."""

from dataclasses import replace
from math import exp, log

import pytest

from parser_service.neural.ranker.calibration import EQUAL, TERMS
from parser_service.neural.ranker.form_ranker import FormRanker
from parser_service.neural.ranker.ranked_forms import LEAST_PARAPHRASES, reword
from parser_service.parsers.interface import Cancelled, Knowledge
from tests.parser_service.neural.ranker.sample_domain import UNSEEN, domain, utterances


def accuracy(parser, pairs):
    answers = parser.predict(utterances(pairs))
    right = (a[0].form == p.form for a, p in zip(answers, pairs, strict=True))
    return sum(right) / len(pairs)


def test_it_learns_a_toy_language(learned, pairs):
    assert accuracy(learned, [pair for pair in pairs if pair.form != UNSEEN]) >= 0.9


def test_a_form_that_no_pair_has_is_among_the_answers(learned, pairs):
    [asked] = {
        pair.utterance
        for pair in pairs
        if pair.form == UNSEEN and " a " in pair.utterance and "look" in pair.utterance
    }
    assert UNSEEN in [candidate.form for candidate in learned.predict([asked], 30)[0]]


def test_scores_are_log_probabilities_that_sum_to_one(learned, pairs):
    for candidates in learned.predict(utterances(pairs)[:5], 10_000):
        scores = [candidate.score for candidate in candidates]
        assert scores == sorted(scores, reverse=True)
        assert sum(map(exp, scores)) == pytest.approx(1, abs=1e-3)
        assert len({candidate.form for candidate in candidates}) == len(candidates)


def test_a_closed_set_answers_forms_of_the_training_pairs_alone(config, pairs):
    parser = FormRanker(replace(config, forms="closed", steps=4))
    parser.fit(pairs[:9], pairs[9:])
    known = {pair.form for pair in pairs[:9]}
    assert {each.form for each in parser.predict(["find it"], 999)[0]} == known


def test_below_the_threshold_the_answer_is_unknown(learned, pairs):
    hesitant = FormRanker(replace(learned.config, unknown_below=0.9999), seed=1)
    hesitant._ranked, hesitant._decision = learned._ranked, learned._decision
    hesitant._model = learned._model
    [[first, second]] = hesitant.predict(["something else"], 2)
    assert (first.form, first.score) == ("UNKNOWN", log(0.9999))
    assert second == learned.predict(["something else"])[0][0]
    assert learned.predict(["something else"])[0][0].form != "UNKNOWN"


def test_other_pairs_calibrate_another_parser_and_this_one_stays(learned, pairs):
    asked = utterances(pairs)
    before = learned.predict(asked)
    spoken = [replace(pair, source="paraphrased") for pair in pairs]
    other = learned.calibrated(spoken[:4])
    assert other.calibrated(pairs).predict(asked) == before
    assert other.predict(asked) != before
    assert learned.predict(asked) == before


def test_a_cancelled_prediction_stops(learned):
    def cancel():
        raise Cancelled

    with pytest.raises(Cancelled):
        learned.predict(["bring the <object>"], check=cancel)


def test_the_first_candidate_does_not_depend_on_how_many_are_asked_for(learned, pairs):
    one, three = learned.predict(utterances(pairs), 1), learned.predict(utterances(pairs), 3)
    assert [a[0] for a in one] == [a[0] for a in three]


def test_the_order_of_the_questions_changes_no_answer(learned, pairs):
    asked = utterances(pairs)
    forward, backward = learned.predict(asked), learned.predict(asked[::-1])[::-1]
    assert [a[0].form for a in forward] == [a[0].form for a in backward]


def test_nothing_asked_nothing_answered(learned):
    assert learned.predict([]) == []


def test_asked_before_it_has_learned_it_says_so(config):
    with pytest.raises(ValueError):
        FormRanker(config).predict(["go"])


@pytest.mark.parametrize(("forms", "is_open"), [("open", True), ("closed", False)])
@pytest.mark.parametrize("asked", [5, 0], ids=["calibrated", "without validation"])
def test_new_forms_are_candidates_unless_the_set_is_closed(config, pairs, forms, is_open, asked):
    parser = FormRanker(replace(config, forms=forms, steps=1))
    parser.fit(pairs, pairs[:asked])
    answers = parser.predict(["find it"], 999)[0]
    known = {pair.form for pair in pairs}
    assert ({each.form for each in answers} > known) is is_open


@pytest.mark.parametrize("asked", [True, False], ids=["calibrated", "without validation"])
def test_known_forms_are_answered_where_validation_and_training_have_no_others(
    config, pairs, asked
):
    parser = FormRanker(config, seed=1)
    parser.fit(pairs, pairs if asked else [])
    known = {pair.form for pair in pairs}
    assert all(ranked[0].form in known for ranked in parser.predict(utterances(pairs)))


def test_whatever_is_validated_the_same_forms_are_new(config, pairs):
    known = [pair for pair in pairs if pair.form != UNSEEN]
    unseen = [pair for pair in pairs if pair.form == UNSEEN]
    parsers = [FormRanker(config, seed=1) for _ in range(3)]
    for parser, validation in zip(parsers, (known, unseen, ()), strict=True):
        parser.fit(known, validation)
    assert len({parser._decision.novelty for parser in parsers}) == 1


def test_known_training_utterances_are_answered_where_all_validation_forms_are_new(config, pairs):
    parser = FormRanker(replace(config, steps=300), seed=2)
    known = [pair for pair in pairs if pair.form != UNSEEN]
    parser.fit(known, [pair for pair in pairs if pair.form == UNSEEN])
    assert accuracy(parser, known) >= 0.95


@pytest.mark.parametrize("knowledge", [Knowledge(), domain()], ids=["strict", "domain"])
def test_the_parts_of_a_score_sum_to_it(knowledge, config, pairs):
    parser = FormRanker(config, 1, knowledge)
    parser.fit(pairs[:18], pairs[18:])
    for candidates in parser.predict(utterances(pairs), 10_000):
        for each in candidates:
            assert sum(each.parts.values()) == pytest.approx(each.score, abs=1e-4)
            assert set(each.parts) <= set(TERMS) and "glosses" in each.parts
            assert ("examples" in each.parts) == (each.origin == "training")


def test_an_answer_tells_which_step_made_its_form(learned, pairs):
    known = {pair.form for pair in pairs} - {UNSEEN}
    answers = learned.predict([pairs[0].utterance], 10_000)[0]
    assert {each.form for each in answers if each.origin == "training"} == known
    made = {each.form: each.origin for each in answers if each.form not in known}
    assert UNSEEN in made
    assert set(made.values()) <= {"geca", "exchange", "drop", "add", "transplant", "retype"}


def test_a_refusal_says_so(learned):
    hesitant = FormRanker(replace(learned.config, unknown_below=0.9999), seed=1)
    hesitant._ranked, hesitant._decision = learned._ranked, learned._decision
    hesitant._model = learned._model
    assert hesitant.predict(["something else"])[0][0].origin == "refusal"


@pytest.mark.parametrize("text", ["", "   ", "\u3000"], ids=["nothing", "blanks", "a wide blank"])
def test_served_it_answers_nothing_to_nothing(learned, text):
    [[first, second]] = learned.hesitant().predict([text], 2)
    assert (first.form, first.origin) == ("UNKNOWN", "refusal")
    assert second == learned.predict([text])[0][0]


def test_served_it_withholds_few_answers_that_are_right(learned, pairs):
    known = [pair for pair in pairs if pair.form != UNSEEN]
    right = [
        pair.utterance
        for pair, ranked in zip(known, learned.predict(utterances(known)), strict=True)
        if ranked[0].form == pair.form
    ]
    served = learned.hesitant().predict(right)
    withheld = sum(ranked[0].form == "UNKNOWN" for ranked in served)
    assert withheld <= 0.05 * len(right)


def test_served_it_does_not_answer_what_is_far_from_all_that_it_knows(learned):
    strict = learned.hesitant()
    strict._decision = replace(strict._decision, least_nearness=20.1)
    assert strict.predict(["bring the <object>"])[0][0].form == "UNKNOWN"
    assert learned.predict(["bring the <object>"])[0][0].form != "UNKNOWN"


def test_an_utterance_longer_than_the_encoder_reads_says_so(learned):
    [short], [long, other] = (
        learned.predict(["bring the <object>"])[0],
        learned.predict(["bring the <object> " * 40], 2)[0],
    )
    assert not short.is_cut and long.is_cut and other.is_cut


@pytest.fixture(scope="module")
def learned_domain(config, pairs):
    parser = FormRanker(replace(config, steps=60, rewordings=2), 1, domain())
    parser.fit(pairs, pairs)
    return parser


def test_what_is_no_command_is_answered_with_unknown_by_a_hesitant_parser_alone(learned_domain):
    [[answer, *_]] = learned_domain.hesitant().predict(["never mind"], 2)
    assert (answer.form, answer.origin) == ("UNKNOWN", "refusal")
    assert learned_domain.predict(["never mind"])[0][0].form != "UNKNOWN"


def test_kinds_of_requests_are_no_answers(learned_domain):
    answers = learned_domain.predict(["find it"], 10_000)[0]
    ranked = learned_domain._ranked
    assert ranked.requests > 5
    assert len(answers) == len(ranked.forms) - ranked.requests
    assert all(each.form.startswith("(") for each in answers)


def test_a_form_with_few_paraphrases_has_rewordings(pairs):
    generated = [replace(pair, source="generated") for pair in pairs]
    paraphrases = [
        replace(pairs[0], source="paraphrased", utterance=f"{pairs[0].utterance} {number}")
        for number in range(LEAST_PARAPHRASES)
    ]
    knowledge = domain()
    said = reword([*generated, *paraphrases], knowledge, 3, seed=0)
    assert {form for _, form in said} == {pair.form for pair in pairs} - {pairs[0].form}
    assert said == reword([*generated, *paraphrases], knowledge, 3, seed=0)
    few = reword([*generated, *paraphrases[1:]], knowledge, 3, seed=0)
    assert {form for _, form in few} == {pair.form for pair in pairs}
    assert reword(generated, Knowledge(), 3, seed=0) == []


def test_generated_commands_do_not_weigh_the_experts(learned, pairs):
    generated = [replace(pair, source="generated") for pair in pairs]
    spoken = [replace(pair, source="paraphrased") for pair in pairs]
    assert learned.calibrated(generated)._decision.known == EQUAL
    assert learned.calibrated([*generated, *spoken])._decision.known != EQUAL
