from dataclasses import asdict
from math import log

import pytest
import torch

from parser_service.neural.ranker.calibration import (
    EQUAL,
    EXPERTS,
    USUAL_NOVELTY,
    Decision,
    Scores,
    best_novelty,
    best_weights,
    calibrate,
)

FIRST, SECOND = EXPERTS.index("examples"), EXPERTS.index("glosses")


def said(first, second=None):
    """Scores [experts, utterances, forms] of the first two experts; the others score 0."""
    scores = torch.zeros(len(EXPERTS), *torch.tensor(first).shape)
    scores[FIRST] = torch.tensor(first)
    if second is not None:
        scores[SECOND] = torch.tensor(second)
    return scores


SCORES = Scores(
    known=said([[2.0, 0.0], [0.0, 1.0]], [[2.0, 0.0], [0.0, 0.0]]),
    new=said([[0.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [3.0, 0.0]]),
)


def test_each_row_is_a_distribution_over_known_and_new_forms():
    logs = Decision(novelty=0.5, known=(0.7, 1, 1, 1)).log_probabilities(SCORES)
    assert logs.shape == (2, 4)
    assert torch.allclose(logs.exp().sum(-1), torch.ones(2))


def test_without_new_forms_all_is_known():
    closed = Scores(SCORES.known, torch.zeros(len(EXPERTS), 2, 0))
    logs = Decision(novelty=9.0).log_probabilities(closed)
    assert torch.allclose(logs.exp().sum(-1), torch.ones(2))


def test_evidence_is_how_much_better_the_new_forms_fit_without_their_examples():
    one = Scores(said([[5.0]], [[1.0]]), said([[0.0]], [[3.0]]))
    assert one.evidence.tolist() == [2]


def test_the_more_often_forms_are_new_the_more_new_forms_are_answered():
    chosen = [
        Decision(novelty).log_probabilities(SCORES).argmax(-1).tolist() for novelty in (-9, 0, 9)
    ]
    assert chosen == [[0, 1], [0, 2], [3, 2]]


def novelty_of(evidence, new, forms):
    """The novelty after so many pairs, of so many ``forms``, the first ``new`` of which are new."""
    number = torch.arange(len(evidence)) % forms
    return best_novelty(evidence, number < new, number)


def test_without_a_pair_the_novelty_is_as_usual():
    assert novelty_of(torch.zeros(0), 0, 1) == USUAL_NOVELTY


@pytest.mark.parametrize("new", [1, 5, 10])
def test_some_new_forms_leave_it_as_it_is(new):
    evidence = torch.where(torch.arange(120) % 40 < new, 5.0, 0.0)
    assert novelty_of(evidence, new, 40) == pytest.approx(USUAL_NOVELTY, abs=0.2)


@pytest.mark.parametrize("pairs", [1, 200])
def test_where_all_forms_are_new_the_set_is_open(pairs):
    novelty = novelty_of(torch.full((pairs,), 2.0), 12, 12)
    assert novelty == pytest.approx(log(pairs / 0.5 + 1))


def test_where_most_forms_are_new_they_need_not_fit_better():
    evidence = torch.where(torch.arange(200) % 40 < 36, 2.0, -2.0)
    assert novelty_of(evidence, 36, 40) > -2


def test_where_known_forms_were_meant_that_fitted_worse_new_ones_are_rarer():
    assert novelty_of(torch.linspace(-2, 4, 200), 0, 200) < USUAL_NOVELTY - 1


def test_many_pairs_of_one_form_say_no_more_than_one_of_it():
    evidence, number = torch.linspace(-2, 4, 200), torch.arange(200)
    once = best_novelty(evidence, number < 0, number)
    thrice = best_novelty(evidence.repeat(3), number.repeat(3) < 0, number.repeat(3))
    assert thrice == once


def test_the_only_known_form_has_a_probability_when_nothing_is_new():
    scores = Scores(said([[1.0]] * 3), torch.zeros(len(EXPERTS), 3, 0))
    decision = calibrate(scores, torch.zeros(3, dtype=torch.long))
    assert decision.novelty <= USUAL_NOVELTY
    assert decision.log_probabilities(scores).tolist() == [[0]] * 3


def test_an_expert_counts_as_much_as_it_is_right():
    right, wrong = [[2.0, 0.0]] * 20, [[0.0, 2.0]] * 20
    weights = best_weights(said(right, wrong), torch.zeros(20, dtype=torch.long))
    assert weights[FIRST] > 1.5
    assert weights[SECOND] < 0.8
    assert weights[2:] == (1, 1)


def test_a_few_pairs_silence_no_expert_and_none_change_nothing():
    few = said([[9.0, 0.0]], [[0.0, 9.0]])
    assert best_weights(few, torch.tensor([0]))[SECOND] > 0.2
    assert best_weights(few[:, :0], torch.zeros(0, dtype=torch.long)) == EQUAL


def test_the_weights_follow_how_often_the_scores_are_right():
    scores = said([[3.0, 0.0]] * 40)
    sure = best_weights(scores, torch.zeros(40, dtype=torch.long))
    unsure = best_weights(scores, torch.tensor([0, 1] * 20))
    assert sure[FIRST] > 1 > unsure[FIRST]


def test_a_form_that_is_in_no_list_counts_as_new_and_for_no_weight():
    decision = calibrate(SCORES, torch.tensor([-1, -1]))
    assert decision.known == decision.new == EQUAL
    assert decision.novelty > 0
    assert calibrate(SCORES, torch.tensor([0, 2])).known != EQUAL


def test_a_decision_can_be_written_and_read():
    decision = calibrate(SCORES, torch.tensor([0, 2]))
    assert Decision.read(asdict(decision)) == decision
