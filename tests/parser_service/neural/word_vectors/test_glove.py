import gzip

import pytest
import torch

from annotations.language.texts.errors import Refusal
from parser_service.neural.word_vectors.glove import read_glove
from tests.parser_service.neural.tiny_weights import write_glove

LINES = "the 0.5 -1 2e-1\n, 1 1 1\nápple 0.25 0 3\n"


@pytest.fixture
def path(tmp_path):
    return tmp_path / "vectors.txt"


@pytest.mark.parametrize("packed", [False, True])
def test_wanted_words_are_read_and_no_others(path, packed):
    path.write_bytes(gzip.compress(LINES.encode()) if packed else LINES.encode())
    vectors = read_glove(path, {"ápple", "the", "absent"}, 3)
    assert vectors.keys() == {"ápple", "the"}
    assert torch.equal(vectors["the"], torch.tensor([0.5, -1.0, 0.2]))


def test_lines_may_end_as_on_any_system(path):
    path.write_bytes(b"the 1 2 \r\nan 3 4")
    assert read_glove(path, {"the", "an"}, 2)["an"].tolist() == [3, 4]


@pytest.mark.parametrize("fault", ["me 1 2", "me 1 2 3 4", "me 1  2 3", "me", ""])
def test_a_line_of_another_width_is_refused_with_its_number(path, fault):
    path.write_text(f"the 1 2 3\n{fault}\n")
    with pytest.raises(Refusal, match=r"vectors\.txt, line 2: .* 3 ") as refused:
        read_glove(path, {"the"}, 3)
    assert refused.value.code == "pretrained_weights_unreadable"


@pytest.mark.parametrize("fault", ["x", "nan", "inf"])
def test_what_is_no_number_is_refused_with_its_line(path, fault):
    path.write_text(f"the 1 2 3\nme 1 {fault} 3\n")
    with pytest.raises(Refusal, match=r"vectors\.txt, line 2: ") as refused:
        read_glove(path, {"me"}, 3)
    assert refused.value.code == "pretrained_weights_unreadable"


def test_vectors_of_another_width_say_which_setting_to_change(tmp_path):
    path = write_glove(tmp_path / "wide.txt", ["the"], 50)
    with pytest.raises(Refusal, match=r"line 1: .* 100 .* 50\b.*embedding_size") as refused:
        read_glove(path, {"the"}, 100)
    assert refused.value.code == "pretrained_weights_unreadable"


def test_a_cut_archive_is_refused(path):
    path.write_bytes(gzip.compress(LINES.encode() * 1000)[:-20])
    with pytest.raises(Refusal, match="gzip") as refused:
        read_glove(path, {"the"}, 3)
    assert refused.value.code == "pretrained_weights_unreadable"
