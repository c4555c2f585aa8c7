from dataclasses import dataclass

import pytest

from annotations.language.texts.errors import Refusal
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
    ("values", "named"),
    [
        ({"width": 0}, r"width .*\b0\b.* 1\b"),
        ({"width": 65}, r"width .*\b65\b.* 64\b"),
        ({"width": "8"}, "width .*'8'"),
        ({"width": True}, "width .*True"),
        ({"rate": float("nan")}, r"rate .*nan.* 0\b"),
        ({"kind": "huge"}, "kind .*'huge'.* small, large"),
        ({"depth": 2}, "depth.*: width, rate, kind"),
    ],
)
def test_a_value_out_of_bounds_is_refused_with_what_is_allowed(values, named):
    with pytest.raises(Refusal, match=named) as refused:
        read_config(Config, values)
    is_unknown = values.keys() - {"width", "rate", "kind"}
    code = "unknown_hyperparameter" if is_unknown else "hyperparameter_out_of_range"
    assert refused.value.code == code


def test_a_whole_number_stands_for_a_fraction():
    config = read_config(Config, {"rate": 1})
    assert config.rate == 1.0 and type(config.rate) is float
