"""The fine-tuned encoder–decoder: what it learns and answers."""

import pytest
import torch

from parser_service.neural.t5.parser import T5
from parser_service.neural.t5.training import summed_loss
from parser_service.parsers.interface import Cancelled, Pair
from parser_service.parsers.logical_forms import canonical
from tests.parser_service.neural.conftest import form
from tests.parser_service.neural.t5.conftest import ODD, TWENTY, UTTERANCES

pytestmark = pytest.mark.usefixtures("kept_there")


def test_it_learns_twenty_pairs_by_heart(learned):
    answers = learned.predict(UTTERANCES)
    assert [answer[0].form for answer in answers] == [pair.form for pair in TWENTY]


def test_candidates_are_distinct_ranked_and_of_known_origin(learned):
    for answer in learned.predict(UTTERANCES[:4], 3):
        assert len({candidate.form for candidate in answer}) == len(answer) == 3
        scores = [candidate.score for candidate in answer]
        assert scores == sorted(scores, reverse=True) and scores[0] < 0
        assert answer[0].origin == "training"


def test_a_score_is_the_log_probability_of_what_was_written(learned):
    [[best, *_]] = learned.predict(UTTERANCES[:1], 2)
    [example] = learned._examples([Pair(UTTERANCES[0], best.form)], lambda: None)
    with torch.no_grad():
        loss = summed_loss(learned._network, [example]).item()
    assert best.score == pytest.approx(-loss, abs=1e-4)
    assert best.parts == {"log_probability": best.score, "tokens": len(example.target) - 1}


def test_utterances_asked_together_and_alone_are_answered_alike(learned):
    asked = [*UTTERANCES[:6], *ODD]
    together = learned.predict(asked, 2)
    for utterance, answer in zip(asked, together, strict=True):
        [alone] = learned.predict([utterance], 2)
        assert [each.form for each in alone] == [each.form for each in answer]


def test_saved_and_loaded_it_answers_alike(learned, tmp_path):
    learned.save(tmp_path)
    loaded = T5.load(tmp_path)
    assert loaded.predict([*UTTERANCES, *ODD], 2) == learned.predict([*UTTERANCES, *ODD], 2)
    assert loaded.parameters() == learned.parameters() > 0
    assert (loaded.config, loaded.seed) == (learned.config, learned.seed)
    assert {path.suffix for path in tmp_path.iterdir()} == {".json", ".safetensors"}


def test_a_prediction_can_be_cancelled_between_tokens(learned):
    calls = []

    def cancel():
        calls.append(1)
        if len(calls) == 3:
            raise Cancelled

    with pytest.raises(Cancelled):
        learned.predict(UTTERANCES[:2], check=cancel)


def test_a_toy_form_is_what_the_tests_take_it_for():
    assert canonical(form("bring", "object", "")) == TWENTY[0].form
