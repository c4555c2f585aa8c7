import json
import sys

import h5py
import numpy
import pytest
import torch

from annotations.language.texts.errors import Refusal
from parser_service.neural.elmo.config import find_elmo
from parser_service.neural.elmo.encoder import Elmo
from parser_service.neural.elmo.files import read_elmo_options
from parser_service.neural.elmo.layers import spell
from parser_service.neural.word_vectors.scalar_mix import ContextShape, ScalarMix
from tests.parser_service.neural.tiny_weights import ELMO, write_elmo

SENTENCE = ("bring", "me", "the", "<object>", "über", "pneumonoultramicroscopic")
OPTIONS, WEIGHTS = "tiny_options.json", "tiny_weights.hdf5"


@pytest.fixture
def folder(tmp_path):
    return write_elmo(tmp_path / "elmo")


def test_without_its_package_its_files_are_refused(folder, monkeypatch):
    assert find_elmo("elmo", folder.parent).options == folder / OPTIONS
    monkeypatch.setitem(sys.modules, "h5py", None)
    with pytest.raises(Refusal) as refused:
        find_elmo("elmo", folder.parent)
    assert refused.value.code == "package_absent"


def load(folder):
    return Elmo(folder / OPTIONS, folder / WEIGHTS)


def sigmoid(x):
    return 1 / (1 + numpy.exp(-x))


def word_by_hand(weights, word):
    """One word's vector without context, by loops over places and filters, in double precision."""
    longest, table = ELMO["char_cnn"]["max_characters_per_token"], weights["char_embed"]
    spelled = [258, *word[: longest - 2], 259]
    spelled += [260] * (longest - len(spelled))
    values = []
    for index, (width, number) in enumerate(ELMO["char_cnn"]["filters"]):
        kernel, bias = weights[f"CNN/W_cnn_{index}"][0], weights[f"CNN/b_cnn_{index}"]
        for each in range(number):
            places = [
                sum(table[spelled[at + k]] @ kernel[k, :, each] for k in range(width)) + bias[each]
                for at in range(longest - width + 1)
            ]
            values.append(max(0.0, max(places)))
    x = numpy.array(values)
    for index in range(ELMO["char_cnn"]["n_highway"]):
        high = f"CNN_high_{index}"
        carry = sigmoid(x @ weights[f"{high}/W_carry"] + weights[f"{high}/b_carry"])
        new = numpy.maximum(0, x @ weights[f"{high}/W_transform"] + weights[f"{high}/b_transform"])
        x = carry * new + (1 - carry) * x
    return x @ weights["CNN_proj/W_proj"] + weights["CNN_proj/b_proj"]


def lstm_by_hand(weights, direction, layer, inputs):
    root = f"RNN_{direction}/RNN/MultiRNNCell/Cell{layer}/LSTMCell"
    w, b, p = (weights[f"{root}/{name}"] for name in ("W_0", "B", "W_P_0"))
    n = ELMO["lstm"]["dim"]
    h, c, outputs = numpy.zeros(p.shape[1]), numpy.zeros(n), []
    for x in inputs:
        z = numpy.concatenate([x, h]) @ w + b
        i, j, f, o = z[:n], z[n : 2 * n], z[2 * n : 3 * n], z[3 * n :]
        c = sigmoid(f + 1) * c + sigmoid(i) * numpy.tanh(j)
        c = numpy.clip(c, -ELMO["lstm"]["cell_clip"], ELMO["lstm"]["cell_clip"])
        h = (sigmoid(o) * numpy.tanh(c)) @ p
        h = numpy.clip(h, -ELMO["lstm"]["proj_clip"], ELMO["lstm"]["proj_clip"])
        outputs.append(h)
    return numpy.array(outputs)


def by_hand(folder, sentence):
    """All layers [words, 3, width] from the equations of the paper and the file, without torch."""
    with h5py.File(folder / WEIGHTS) as file:
        names = []
        file.visititems(lambda name, item: names.append(name) if hasattr(item, "shape") else None)
        weights = {name: file[name][...].astype("float64") for name in names}
    words = [[256], *[list(word.encode()) for word in sentence], [257]]
    plain = numpy.array([word_by_hand(weights, word) for word in words])
    layers = [numpy.concatenate([plain, plain], axis=1)]
    ahead, behind = plain, plain[::-1]
    for layer in range(ELMO["lstm"]["n_layers"]):
        read = lstm_by_hand(weights, 0, layer, ahead), lstm_by_hand(weights, 1, layer, behind)
        ahead, behind = read if layer == 0 else (read[0] + ahead, read[1] + behind)
        layers.append(numpy.concatenate([ahead, behind[::-1]], axis=1))
    return numpy.stack(layers, axis=1)[1:-1]


@pytest.mark.parametrize("sentence", [SENTENCE, ("go",)])
def test_every_layer_agrees_with_a_calculation_by_hand(folder, sentence):
    vectors, expected = load(folder).vectors(sentence).numpy(), by_hand(folder, sentence)
    assert vectors.shape == (len(sentence), 3, 12)
    assert numpy.abs(vectors - expected).max() < 1e-5
    assert numpy.abs(expected).max() > 0.1


def test_the_calculation_reaches_both_clips(folder):
    clip = ELMO["lstm"]["proj_clip"]
    first = by_hand(folder, SENTENCE)[:, 1]
    assert (numpy.abs(first) == clip).any() and (numpy.abs(first) < clip).any()


def test_nothing_that_was_read_before_changes_vectors(folder):
    elmo = load(folder)
    before = elmo.vectors(SENTENCE)
    elmo.vectors(("something", "else"))
    assert torch.equal(before, elmo.vectors(SENTENCE))


def test_an_utterance_without_words_has_no_vectors(folder):
    assert load(folder).vectors(()).shape == (0, 3, 12)


def test_words_are_spelled_in_bytes_between_markers():
    assert spell(["é"], 6) == [
        [258, 256, 259, 260, 260, 260],
        [258, 0xC3, 0xA9, 259, 260, 260],
        [258, 257, 259, 260, 260, 260],
    ]
    assert spell(["abcdef"], 5)[1] == [258, 97, 98, 99, 259]


def test_the_mix_is_a_weighted_mean_times_gamma():
    mix = ScalarMix(ContextShape(layers=3, width=2))
    layers = torch.randn(1, 4, 3, 2, generator=torch.Generator().manual_seed(0))
    assert torch.allclose(mix(layers), layers.mean(dim=2))
    with torch.no_grad():
        mix.weights.copy_(torch.tensor([0.0, 1.0, -1.0]))
        mix.gamma.fill_(2.0)
    a, b, c = numpy.exp([0, 1, -1]) / numpy.exp([0, 1, -1]).sum()
    expected = 2 * (a * layers[:, :, 0] + b * layers[:, :, 1] + c * layers[:, :, 2])
    assert torch.allclose(mix(layers), expected, atol=1e-6)


def test_the_identity_follows_weights_and_options(folder, tmp_path):
    same, other = write_elmo(tmp_path / "same"), write_elmo(tmp_path / "other", seed=1)
    assert load(folder).identity == load(same).identity != load(other).identity


def test_a_file_that_lacks_weights_is_refused_with_their_name(folder):
    with h5py.File(folder / WEIGHTS, "a") as file:
        del file["CNN_high_1/b_carry"]
    with pytest.raises(Refusal, match=r"CNN_high_1/b_carry .*\[15\]") as refused:
        load(folder)
    assert refused.value.code == "pretrained_weights_unreadable"


def test_weights_that_do_not_fit_their_options_are_refused(folder):
    changed = {**ELMO, "lstm": {**ELMO["lstm"], "dim": 11}}
    (folder / OPTIONS).write_text(json.dumps(changed))
    with pytest.raises(Refusal, match=r"W_0 .*\[12, 44\].*\[12, 40\]") as refused:
        load(folder)
    assert refused.value.code == "pretrained_weights_unreadable"


def test_a_file_that_is_no_hdf5_is_refused(folder):
    torch.save({}, folder / WEIGHTS)
    with pytest.raises(Refusal, match=f"{WEIGHTS}.*HDF5") as refused:
        load(folder)
    assert refused.value.code == "pretrained_weights_unreadable"


@pytest.mark.parametrize("text", ["{}", "no json", '{"char_cnn": {}, "lstm": {}}', "[]"])
def test_options_of_something_else_are_refused(folder, text):
    (folder / OPTIONS).write_text(text)
    with pytest.raises(Refusal, match=OPTIONS) as refused:
        read_elmo_options(folder / OPTIONS)
    assert refused.value.code == "pretrained_weights_unreadable"


def test_an_unknown_activation_is_refused(folder):
    changed = {**ELMO, "char_cnn": {**ELMO["char_cnn"], "activation": "swish"}}
    (folder / OPTIONS).write_text(json.dumps(changed))
    with pytest.raises(Refusal, match=r"'swish'.*relu.*tanh") as refused:
        read_elmo_options(folder / OPTIONS)
    assert refused.value.code == "pretrained_weights_unreadable"
