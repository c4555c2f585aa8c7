import torch

from parser_service.neural.ranker.model import SCALE, NearestExamples
from parser_service.parsers.interface import keep_going


class Compass:
    """An encoder of four words."""

    def vectors(self, utterances, check):
        check()
        places = {
            "east": (1.0, 0.0),
            "north": (0.0, 1.0),
            "west": (-1.0, 0.0),
            "south": (0.0, -1.0),
        }
        return torch.tensor([places[each] for each in utterances])


def test_a_form_is_as_near_as_the_nearest_of_its_examples():
    head = NearestExamples([0, 0, 1], width=2)
    head.encode(Compass(), ["east", "west", "north"], keep_going)
    asked = torch.tensor([[1.0, 0.0], [0.6, 0.8], [0.0, -1.0]])
    assert torch.allclose(head(asked), SCALE * torch.tensor([[1, 0], [0.6, 0.8], [0, -1]]))


def test_before_the_examples_have_vectors_nothing_is_nearer():
    assert NearestExamples([0, 1, 1], width=2)(torch.ones(1, 2)).tolist() == [[0, 0]]


def test_vectors_are_kept_and_forms_are_not_for_they_stand_elsewhere():
    assert set(NearestExamples([0, 1], width=2).state_dict()) == {"vectors"}
