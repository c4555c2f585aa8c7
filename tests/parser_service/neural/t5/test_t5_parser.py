"""The fine-tuned encoder–decoder: what it learns and answers."""

import json
from contextlib import suppress

import pytest
import torch

from parser_service.neural.t5.fine_tuning import summed_loss
from parser_service.neural.t5.t5_parser import T5
from parser_service.parsers.interface import Cancelled, Pair
from parser_service.parsers.written_forms import canonical
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


def test_code_beside_a_checkpoint_is_never_run(learned, tmp_path):
    """A configuration that names code of its own is refused or read as if it did not."""
    learned.save(tmp_path)
    ran = tmp_path / "ran"
    for name in ("modeling_own", "configuration_own", "tokenization_own"):
        (tmp_path / f"{name}.py").write_text(f"open({str(ran)!r}, 'w').close()", "utf-8")

    def name_code(value):
        if isinstance(value, dict):
            named = {"auto_map": AUTO_MAP} if "model_type" in value else {}
            return {key: name_code(each) for key, each in value.items()} | named
        return value

    configs = list(tmp_path.rglob("*.json"))
    texts = [path.read_text("utf-8") for path in configs]
    assert any("model_type" in text for text in texts)
    for path, text in zip(configs, texts, strict=True):
        path.write_text(json.dumps(name_code(json.loads(text))), "utf-8")
    with suppress(ValueError):
        T5.load(tmp_path).predict(["go to the kitchen"], 1)
    assert not ran.exists()


AUTO_MAP = {
    "AutoConfig": "configuration_own.OwnConfig",
    "AutoModelForSeq2SeqLM": "modeling_own.OwnModel",
    "AutoTokenizer": ["tokenization_own.OwnTokenizer", None],
}
