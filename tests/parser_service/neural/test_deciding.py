import pytest
import torch

from parser_service.neural.deciding import (
    Decision,
    Scores,
    best_gate,
    best_temperature,
    calibrated,
)

SCORES = Scores(
    known=torch.tensor([[2.0, 0.0], [0.0, 1.0]]),
    new=torch.tensor([[0.0, 3.0], [1.0, 0.0]]),
    evidence=torch.tensor([-1.0, 1.0]),
)


def test_each_row_is_a_distribution_over_known_and_new_forms():
    logs = Decision(novelty=0.5, known_temperature=0.7).log_probabilities(SCORES)
    assert logs.shape == (2, 4)
    assert torch.allclose(logs.exp().sum(-1), torch.ones(2))


def test_without_new_forms_all_is_known():
    closed = Scores(SCORES.known, torch.zeros(2, 0), torch.zeros(2))
    logs = Decision(novelty=9.0).log_probabilities(closed)
    assert torch.allclose(logs.exp().sum(-1), torch.ones(2))


def test_the_more_often_forms_are_new_the_more_new_forms_are_answered():
    chosen = [
        Decision(novelty).log_probabilities(SCORES).argmax(-1).tolist() for novelty in (-9, 0, 9)
    ]
    assert chosen == [[0, 1], [0, 2], [3, 2]]


def test_where_all_forms_were_known_evidence_counts_nothing_and_new_ones_are_rare():
    novelty, slope = best_gate(torch.randn(100), torch.zeros(100, dtype=torch.bool))
    assert slope == 0 and novelty < -4
    assert best_gate(torch.randn(100), torch.ones(100, dtype=torch.bool)) == (-novelty, 0)


def test_evidence_counts_where_it_tells_new_from_known():
    is_new = torch.tensor([True, False] * 50)
    telling = torch.where(is_new, 3.0, -1.0)
    novelty, slope = best_gate(telling, is_new)
    assert slope == 1 and novelty == pytest.approx(-1)
    assert best_gate(torch.zeros(100), is_new) == (0, 0)


def test_without_validation_the_evidence_decides():
    assert best_gate(torch.zeros(0), torch.zeros(0, dtype=torch.bool)) == (0, 1)


def test_the_temperature_follows_how_often_the_scores_are_right():
    scores = torch.tensor([[3.0, 0.0]] * 10)
    sure = best_temperature(scores, torch.zeros(10, dtype=torch.long))
    unsure = best_temperature(scores, torch.tensor([0, 1] * 5))
    assert sure < 1 < unsure
    assert best_temperature(scores[:0], torch.zeros(0, dtype=torch.long)) == 1


def test_a_form_that_is_in_no_list_counts_as_new_and_for_no_temperature():
    found = calibrated(SCORES, torch.tensor([-1, -1]))
    assert (found.known_temperature, found.new_temperature) == (1, 1)
    assert found.novelty > 0
    assert calibrated(SCORES, torch.tensor([0, 2])).known_temperature == pytest.approx(0.5)
