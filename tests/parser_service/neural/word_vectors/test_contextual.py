import json

import pytest
import torch

from annotations.language.texts.errors import Refusal
from parser_service.neural.word_vectors.contextual import TransformerWords, mean_by_word
from tests.parser_service.neural.tiny_weights import write_bert, write_gpt

SENTENCE = ("bring", "me", "the", "<object>", "kitchenette's", "☃", "room")
WRITERS = [write_bert, write_gpt]


def directly(folder, sentence):
    """What transformers says of each word, from its own tokenizer, model and word numbers."""
    from transformers import AutoModel, AutoTokenizer

    tokenizer, model = AutoTokenizer.from_pretrained(folder), AutoModel.from_pretrained(folder)
    cut = tokenizer([list(sentence)], is_split_into_words=True, return_tensors="pt")
    with torch.no_grad():
        states = model.eval()(cut["input_ids"]).last_hidden_state[0]
    rows = []
    for word in range(len(sentence)):
        own = [at for at, each in enumerate(cut.word_ids(0)) if each == word]
        rows.append(sum(states[at] for at in own) / len(own) if own else torch.zeros(8))
    return torch.stack(rows)


@pytest.mark.parametrize("write", WRITERS)
def test_vectors_agree_with_transformers_called_directly(tmp_path, write):
    folder = write(tmp_path / "encoder")
    vectors = TransformerWords.named(str(folder)).vectors(SENTENCE)
    assert vectors.shape == (len(SENTENCE), 1, 8)
    assert torch.allclose(vectors[:, 0], directly(folder, SENTENCE), atol=1e-6)
    assert vectors[4].norm() > 0


@pytest.mark.parametrize("write", WRITERS)
def test_the_tokenizers_of_these_tests_do_cut_words(tmp_path, write):
    from transformers import AutoTokenizer

    tokenizer = AutoTokenizer.from_pretrained(write(tmp_path / "encoder"))
    assert len(tokenizer.tokenize("kitchenette")) > 1


@pytest.mark.parametrize("write", WRITERS)
def test_a_word_is_read_in_its_context(tmp_path, write):
    encoder = TransformerWords.named(str(write(tmp_path / "encoder")))
    one, other = encoder.vectors(("find", "room")), encoder.vectors(("the", "room"))
    assert not torch.allclose(one[1], other[1], atol=1e-3)


@pytest.mark.parametrize("write", WRITERS)
def test_an_utterance_longer_than_the_encoder_is_read_as_far_as_it_goes(tmp_path, write):
    encoder = TransformerWords.named(str(write(tmp_path / "encoder")))
    vectors = encoder.vectors(("the",) * 60)
    assert vectors.shape == (60, 1, 8)
    assert vectors[20].norm() > 0 and vectors[59].norm() == 0


def test_an_utterance_without_words_has_no_vectors(tmp_path):
    encoder = TransformerWords.named(str(write_bert(tmp_path / "encoder")))
    assert encoder.vectors(()).shape == (0, 1, 8)


def test_weights_in_half_precision_are_read_in_single(tmp_path):
    from transformers import AutoModel

    folder = write_bert(tmp_path / "encoder")
    AutoModel.from_pretrained(folder).half().save_pretrained(folder)
    assert TransformerWords.named(str(folder)).vectors(("the",)).dtype == torch.float32


def test_reading_an_encoder_draws_no_global_random_numbers(tmp_path):
    folder = write_bert(tmp_path / "encoder")
    before = torch.get_rng_state()
    TransformerWords.named(str(folder))
    assert torch.equal(before, torch.get_rng_state())


@pytest.mark.parametrize("write", WRITERS)
def test_a_pickle_under_a_safe_name_is_refused(tmp_path, write):
    folder = write(tmp_path / "encoder")
    torch.save({"weights": torch.zeros(3)}, folder / "model.safetensors")
    with pytest.raises(Refusal, match=str(folder)) as refused:
        TransformerWords.named(str(folder))
    assert refused.value.code == "pretrained_weights_unreadable"


def test_weights_of_another_network_are_not_made_up(tmp_path):
    folder, other = write_bert(tmp_path / "bert"), write_gpt(tmp_path / "gpt")
    (other / "model.safetensors").replace(folder / "model.safetensors")
    with pytest.raises(
        Refusal, match=r"/bert/model\.safetensors .*\b\d+\b.* config\.json"
    ) as refused:
        TransformerWords.named(str(folder))
    assert refused.value.code == "pretrained_weights_unreadable"


def test_code_beside_the_weights_is_not_run(tmp_path):
    folder = write_gpt(tmp_path / "encoder")
    config = json.loads((folder / "config.json").read_text())
    config |= {"model_type": "home_made", "auto_map": {"AutoModel": "code.Model"}}
    (folder / "config.json").write_text(json.dumps(config))
    (folder / "code.py").write_text(f"open({str(tmp_path / 'ran')!r}, 'w')")
    with pytest.raises(Refusal, match=str(folder)) as refused:
        TransformerWords.named(str(folder))
    assert refused.value.code == "pretrained_weights_unreadable"
    assert not (tmp_path / "ran").exists()


def test_a_word_is_the_mean_of_its_subwords_and_zero_without():
    subwords = torch.tensor([[9.0], [1.0], [2.0], [4.0], [9.0]])
    assert mean_by_word(subwords, [None, 0, 2, 2, None], 4).tolist() == [[1], [0], [3], [0]]
