from dataclasses import asdict

import pytest
import torch

from parser_service.neural.ranker.calibration import (
    EQUAL,
    EXPERTS,
    NEAR,
    USUAL_NEARNESS,
    USUAL_NOVELTY,
    DecisionRule,
    Scores,
    best_novelty,
    best_weights,
    least_nearness,
    weigh,
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
    logs = DecisionRule(novelty=0.5, known=(0.7, 1, 1, 1)).log_probabilities(SCORES)
    assert logs.shape == (2, 4)
    assert torch.allclose(logs.exp().sum(-1), torch.ones(2))


def test_without_new_forms_all_is_known():
    closed = Scores(SCORES.known, torch.zeros(len(EXPERTS), 2, 0))
    logs = DecisionRule(novelty=9.0).log_probabilities(closed)
    assert torch.allclose(logs.exp().sum(-1), torch.ones(2))


def test_evidence_is_how_much_better_the_best_new_form_fits():
    one = Scores(said([[NEAR]], [[1.0]]), said([[0.0]], [[3.0]]))
    assert one.evidence.tolist() == [2]


def test_a_near_example_speaks_for_the_known_forms_and_a_far_one_against_them():
    near, far = (
        Scores(said([[NEAR + by]], [[1.0]]), said([[0.0]], [[1.0]])).evidence for by in (4, -4)
    )
    assert near.tolist() == [-2] and far.tolist() == [2]


def test_new_forms_with_examples_have_theirs_weighed_alike():
    same = Scores(said([[14.0]], [[1.0]]), said([[14.0]], [[1.0]]))
    assert same.evidence.tolist() == [0]


@pytest.mark.parametrize("times", [10, 10_000])
def test_evidence_is_the_same_for_ten_and_for_ten_thousand_forms(times):
    many = Scores(SCORES.known, SCORES.new.repeat(1, 1, times))
    assert torch.equal(many.evidence, SCORES.evidence)
    worse = SCORES.new - torch.tensor([0.0, 5.0, 0.0, 0.0])[:, None, None]
    others = Scores(SCORES.known, torch.cat([SCORES.new, worse.repeat(1, 1, times)], -1))
    assert torch.equal(others.evidence, SCORES.evidence)


def test_the_more_often_forms_are_new_the_more_new_forms_are_answered():
    chosen = [
        DecisionRule(novelty).log_probabilities(SCORES).argmax(-1).tolist()
        for novelty in (-20, -6, 9)
    ]
    assert chosen == [[0, 1], [0, 2], [3, 2]]


def novelty_of(of_new, of_known, pairs_a_form=1):
    """The novelty by so much evidence for utterances of new and of known forms."""
    new, known = (
        [f"{kind} {at // pairs_a_form}" for at in range(len(evidence))]
        for kind, evidence in (("new", of_new), ("known", of_known))
    )
    return best_novelty(torch.tensor(of_new), new, torch.tensor(of_known), known)


def test_where_nothing_was_held_out_the_novelty_is_as_usual():
    assert novelty_of([], []) == novelty_of([1.0], []) == novelty_of([], [1.0]) == USUAL_NOVELTY


def test_two_forms_move_it_less_than_many():
    few, many = (novelty_of([3.0] * forms, [1.0] * forms) for forms in (2, 60))
    assert USUAL_NOVELTY > few > many
    assert few == pytest.approx(USUAL_NOVELTY, abs=0.5)
    assert many == pytest.approx(USUAL_NOVELTY - 2, abs=0.3)


def test_it_lies_between_the_evidence_of_new_and_of_known_forms():
    assert novelty_of([2.0] * 9, [-2.0] * 9) == pytest.approx(USUAL_NOVELTY, abs=0.1)


@pytest.mark.parametrize("wrong", [-30.0, -12.0])
def test_one_mislabelled_pair_of_eighteen_moves_it_by_little(wrong):
    right = [2.0] * 9, [-2.0] * 9
    assert novelty_of([2.0] * 8 + [wrong], right[1]) == pytest.approx(novelty_of(*right), abs=0.5)
    assert novelty_of(right[0], [-2.0] * 8 + [-wrong]) == pytest.approx(novelty_of(*right), abs=0.5)


def test_many_pairs_of_one_form_say_no_more_than_one_of_it():
    new, known = [3.0, 1.0, 2.0], [-1.0, 0.5, -3.0]
    thrice = [[each for each in some for _ in range(3)] for some in (new, known)]
    assert novelty_of(*thrice, pairs_a_form=3) == novelty_of(new, known)


def test_known_forms_are_not_more_likely_for_being_many():
    new, known = [3.0, 1.0], [-1.0, 0.5]
    assert novelty_of(new, known * 50) == novelty_of(new, known)


def test_the_only_known_form_has_a_probability_when_nothing_is_new():
    scores = Scores(said([[1.0]] * 3), torch.zeros(len(EXPERTS), 3, 0))
    decision = weigh(2.0, scores, torch.zeros(3, dtype=torch.long))
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


def test_a_form_that_is_in_no_list_counts_for_no_weight_and_no_pair_moves_the_novelty():
    decision = weigh(1.5, SCORES, torch.tensor([-1, -1]))
    assert decision == DecisionRule(1.5)
    assert weigh(1.5, SCORES, torch.tensor([0, 2])).known != EQUAL
    assert weigh(1.5, SCORES, torch.tensor([2, 3])).novelty == 1.5


def test_a_decision_can_be_written_and_read():
    decision = weigh(0.5, SCORES, torch.tensor([0, 2]))
    assert DecisionRule.read(asdict(decision)) == decision


def test_the_bound_of_nearness_withholds_five_right_answers_in_a_hundred_at_most():
    of_right = torch.linspace(5, 20, 100)
    assert int((of_right < least_nearness(of_right)).sum()) == 5
    assert int((of_right[:19] < least_nearness(of_right[:19])).sum()) == 0
    assert float((of_right - least_nearness(of_right)).abs().min()) > 1e-4  # it is nobody's own


def test_the_bound_is_for_what_people_say_and_the_usual_one_where_nobody_was_heard():
    far = Scores(SCORES.known - 3, SCORES.new - 3)
    both = Scores(
        *(torch.cat(parts, 1) for parts in ((SCORES.known, far.known), (SCORES.new, far.new)))
    )
    targets = DecisionRule().log_probabilities(both).argmax(-1)
    bounds = [
        weigh(USUAL_NOVELTY, both, targets, torch.tensor(spoken)).least_nearness
        for spoken in ([True, True, False, False], [False, False, True, True], [False] * 4)
    ]
    assert bounds[0] > bounds[1]
    assert bounds[2] == USUAL_NEARNESS


def test_few_right_answers_do_not_raise_the_bound():
    assert least_nearness(torch.full((3,), 19.0)) == USUAL_NEARNESS
    assert least_nearness(torch.zeros(0)) == USUAL_NEARNESS
    assert least_nearness(torch.full((50,), 19.0)) == 19


def test_a_decision_of_before_there_was_a_bound_has_the_usual_one():
    written = asdict(DecisionRule(0.5))
    del written["least_nearness"]
    assert DecisionRule.read(written) == DecisionRule(0.5)
