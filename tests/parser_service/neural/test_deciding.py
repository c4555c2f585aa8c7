from dataclasses import asdict

import pytest
import torch

from parser_service.neural.deciding import (
    EQUAL,
    SUPPORT_LEFT_OUT,
    VOICES,
    Decision,
    Scores,
    best_gate,
    best_weights,
    calibrated,
    calibrated_gate,
)

FIRST, SECOND = VOICES.index("examples"), VOICES.index("glosses")


def said(first, second=None):
    """Scores [voices, utterances, forms] of the first two voices; the others say nothing."""
    scores = torch.zeros(len(VOICES), *torch.tensor(first).shape)
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
    closed = Scores(SCORES.known, torch.zeros(len(VOICES), 2, 0))
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


NONE = torch.zeros(0)


def test_where_all_forms_were_known_new_ones_are_rare_unless_the_evidence_is_strong():
    known, left_out = torch.linspace(-2, 2, 100), torch.linspace(6, 10, 100)
    novelty, slope = best_gate(known, torch.zeros(100, dtype=torch.bool), left_out)
    assert slope > 0 and novelty < -4
    assert novelty + slope * 8 > 0


def test_where_forms_left_out_look_like_the_others_evidence_counts_nothing():
    evidence, known = torch.zeros(100), torch.zeros(100, dtype=torch.bool)
    novelty, slope = best_gate(evidence, known, torch.zeros(100))
    assert (novelty < -4, slope) == (True, 0)
    assert best_gate(evidence, ~known, NONE) == (-novelty, 0)


def test_evidence_counts_where_it_tells_new_from_known():
    is_new = torch.tensor([True, False] * 50)
    telling = torch.where(is_new, 3.0, -1.0)
    novelty, slope = best_gate(telling, is_new, NONE)
    assert slope == 1 and novelty == pytest.approx(-1)
    assert best_gate(torch.zeros(100), is_new, NONE) == (0, 0)


def test_without_a_pair_the_evidence_decides():
    assert best_gate(NONE, torch.zeros(0, dtype=torch.bool), NONE) == (0, 1)


def test_a_form_left_out_is_among_the_new_ones_and_no_more_among_the_known():
    scores = Scores(said([[5.0, 0.0]], [[4.0, 1.0]]), said([[0.0]], [[2.0]]))
    there = torch.tensor([2.0, 4.0 + SUPPORT_LEFT_OUT]).logsumexp(-1)
    assert scores.evidence_without(torch.tensor([0])) == there - 1
    assert scores.evidence_without(torch.tensor([1])) < scores.evidence_without(torch.tensor([0]))


def test_the_only_known_form_can_be_left_out():
    scores = Scores(said([[1.0]] * 3), said([[0.0]] * 3))
    novelty, slope = calibrated_gate(scores, torch.zeros(3, dtype=torch.long))
    assert novelty < 0 <= slope < float("inf")
    assert Decision(novelty, slope).log_probabilities(scores).isfinite().all()


def test_a_voice_counts_as_much_as_it_is_right():
    right, wrong = [[2.0, 0.0]] * 20, [[0.0, 2.0]] * 20
    weights = best_weights(said(right, wrong), torch.zeros(20, dtype=torch.long))
    assert weights[FIRST] > 1.5
    assert weights[SECOND] < 0.8
    assert weights[2:] == (1, 1)


def test_a_few_pairs_silence_no_voice_and_none_change_nothing():
    few = said([[9.0, 0.0]], [[0.0, 9.0]])
    assert best_weights(few, torch.tensor([0]))[SECOND] > 0.2
    assert best_weights(few[:, :0], torch.zeros(0, dtype=torch.long)) == EQUAL


def test_the_weights_follow_how_often_the_scores_are_right():
    scores = said([[3.0, 0.0]] * 40)
    sure = best_weights(scores, torch.zeros(40, dtype=torch.long))
    unsure = best_weights(scores, torch.tensor([0, 1] * 20))
    assert sure[FIRST] > 1 > unsure[FIRST]


def test_a_form_that_is_in_no_list_counts_as_new_and_for_no_weight():
    found = calibrated(SCORES, torch.tensor([-1, -1]))
    assert found.known == found.new == EQUAL
    assert found.novelty > 0
    assert calibrated(SCORES, torch.tensor([0, 2])).known != EQUAL


def test_a_decision_can_be_written_and_read():
    decision = calibrated(SCORES, torch.tensor([0, 2]))
    assert Decision.read(asdict(decision)) == decision
