from parser_service.parsers.interface import UNKNOWN, Candidate, Pair
from parser_service.parsers.knn import NearestNeighbour
from parser_service.serving.several_commands import commands_in

GO, TAKE = '( go " kitchen " )', '( take " tea " )'


class Knowing(NearestNeighbour):
    """Answers UNKNOWN to what it has not learned word by word."""

    def predict(self, utterances, beam_width=1, check=lambda: None):
        known = {"go to the kitchen": GO, "take the tea": TAKE}
        return [[Candidate(known.get(each.casefold(), UNKNOWN), 0.0)] for each in utterances]


def test_the_commands_that_a_parser_understands_are_found():
    parser = Knowing()
    parser.fit([Pair("go to the kitchen", GO)])
    said = "Go to the kitchen and then take the tea. Finally go to the kitchen."
    assert commands_in(parser, said) == ("Go to the kitchen", "take the tea", "go to the kitchen")
    assert commands_in(parser, "take the tea") == ("take the tea",)
    assert commands_in(parser, "open the door. take the tea") == ("open the door. take the tea",)
