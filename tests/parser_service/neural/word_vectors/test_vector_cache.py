import pytest
import torch

from parser_service.neural.word_vectors.vector_cache import VectorCache
from parser_service.parsers.interface import Cancelled

SENTENCES = [("bring", "it"), ("go",), (), ("find", "the", "apple")]
NOTHING_IN_MEMORY = 0


class Counting:
    """An encoder that says how often it was asked."""

    layers, width = 2, 3

    def __init__(self, identity="a" * 64):
        self.identity = identity
        self.read = []

    def vectors(self, words):
        self.read.append(words)
        numbers = [[len(word), at] for at, word in enumerate(words)]
        rows = torch.tensor(numbers, dtype=torch.float32).reshape(len(words), 2, 1)
        return rows.expand(-1, -1, 3).contiguous()


def same(cache, sentence):
    return torch.equal(cache.of(sentence), Counting().vectors(sentence))


@pytest.mark.parametrize("on_disk", [False, True])
def test_each_distinct_utterance_is_read_once(tmp_path, on_disk):
    encoder = Counting()
    cache = VectorCache(encoder, tmp_path if on_disk else None, NOTHING_IN_MEMORY)
    cache.prepare([*SENTENCES, *SENTENCES])
    cache.prepare(SENTENCES)
    assert all(same(cache, sentence) for sentence in SENTENCES * 2)
    assert sorted(encoder.read) == sorted(SENTENCES)


def test_what_is_much_is_there_for_the_next_training(tmp_path):
    VectorCache(Counting(), tmp_path, NOTHING_IN_MEMORY).prepare(SENTENCES)
    encoder = Counting()
    cache = VectorCache(encoder, tmp_path, NOTHING_IN_MEMORY)
    cache.prepare([*SENTENCES, ("new",)])
    assert encoder.read == [("new",)]
    assert all(same(cache, sentence) for sentence in [*SENTENCES, ("new",)])


def test_what_is_little_stays_in_memory(tmp_path):
    VectorCache(Counting(), tmp_path).prepare(SENTENCES)
    assert not list(tmp_path.rglob("*.*"))


def test_vectors_of_other_weights_are_not_taken(tmp_path):
    VectorCache(Counting(), tmp_path, NOTHING_IN_MEMORY).prepare(SENTENCES)
    other = Counting("b" * 64)
    VectorCache(other, tmp_path, NOTHING_IN_MEMORY).prepare(SENTENCES)
    assert len(other.read) == len(SENTENCES)


def test_a_damaged_file_is_passed_over(tmp_path):
    VectorCache(Counting(), tmp_path, NOTHING_IN_MEMORY).prepare(SENTENCES)
    for path in tmp_path.rglob("*.safetensors"):
        path.write_bytes(b"damaged")
    encoder = Counting()
    cache = VectorCache(encoder, tmp_path, NOTHING_IN_MEMORY)
    cache.prepare(SENTENCES)
    assert len(encoder.read) == len(SENTENCES)
    assert all(same(cache, sentence) for sentence in SENTENCES)


def test_files_hold_about_the_size_that_is_asked_for(tmp_path):
    sentences = [(str(number), "word") for number in range(10)]
    size = 4 * 2 * 2 * 3  # bytes of one of them
    VectorCache(Counting(), tmp_path, in_memory=3 * size).prepare(sentences)
    assert len(list(tmp_path.rglob("*.safetensors"))) == 4


def test_an_utterance_asked_for_later_is_kept_for_a_while():
    encoder = Counting()
    cache = VectorCache(encoder)
    assert same(cache, ("go",)) and same(cache, ("go",))
    assert encoder.read == [("go",)]


def test_the_work_can_be_watched_and_stopped():
    seen, encoder = [], Counting()

    def check():
        if len(encoder.read) == 2:
            raise Cancelled

    with pytest.raises(Cancelled):
        VectorCache(encoder).prepare(SENTENCES, check, lambda *numbers: seen.append(numbers))
    assert seen == [(1, 4), (2, 4)]
