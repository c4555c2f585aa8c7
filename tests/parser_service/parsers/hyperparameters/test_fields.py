from dataclasses import dataclass

import pytest

from annotations.language.errors import Refusal
from parser_service.parsers.hyperparameters.fields import (
    describe,
    hyperparameter,
    read_config,
    validate,
)


@dataclass(frozen=True)
class Config:
    width: int = hyperparameter(8, "Cells a layer.", minimum=1, maximum=64)
    rate: float = hyperparameter(0.1, "Step of the optimiser.", minimum=0.0, maximum=1.0)
    kind: str = hyperparameter("small", "Which one.", choices=("small", "large"))

    def __post_init__(self) -> None:
        validate(self)


def test_fields_are_described_in_their_order():
    first, *others = describe(Config)
    assert (first.name, first.type, first.default, first.maximum) == ("width", int, 8, 64)
    assert [field.name for field in others] == ["rate", "kind"]


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"width": 0}, "width is 0, but it has to be at least 1"),
        ({"width": 65}, "width is 65, but it has to be at most 64"),
        ({"width": "8"}, "width is '8', but it has to be a whole number"),
        ({"width": True}, "width is True, but it has to be a whole number"),
        ({"rate": float("nan")}, "rate is nan, but it has to be at least 0"),
        ({"kind": "huge"}, "kind is 'huge', but it has to be one of small, large"),
        ({"depth": 2}, "No hyperparameter is called depth; there are: width, rate, kind"),
    ],
)
def test_a_value_out_of_bounds_is_refused_with_a_sentence(values, sentence):
    with pytest.raises(Refusal, match=sentence) as refused:
        read_config(Config, values)
    is_unknown = values.keys() - {"width", "rate", "kind"}
    code = "unknown_hyperparameter" if is_unknown else "hyperparameter_out_of_range"
    assert refused.value.code == code


def test_a_whole_number_stands_for_a_fraction():
    config = read_config(Config, {"rate": 1})
    assert config.rate == 1.0 and type(config.rate) is float
