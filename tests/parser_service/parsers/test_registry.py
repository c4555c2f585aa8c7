import gc
import subprocess
import sys
from dataclasses import FrozenInstanceError, is_dataclass

import pytest

from annotations.language.texts.errors import Refusal
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.interface import Parser, ScoreKind
from parser_service.parsers.registry import (
    config_class,
    config_fields,
    config_values,
    load_class,
    make_config,
    parsers,
)


@pytest.mark.parametrize("name", parsers())
def test_every_entry_agrees_with_its_class(name):
    entry, parser = parsers()[name], load_class(name)
    assert issubclass(parser, Parser)
    assert (parser.name, parser.version, parser.protocols) == (name, entry.version, entry.protocols)
    assert parser.Config is config_class(name)
    assert set(entry.protocols) <= set(Protocol)
    assert entry.queue in ("cpu", "gpu", "quick")


@pytest.mark.parametrize("name", parsers())
def test_a_config_is_frozen_and_survives_json(name):
    config = make_config(name)
    assert is_dataclass(config)
    assert make_config(name, config_values(config)) == config
    if fields := config_fields(name):
        with pytest.raises(FrozenInstanceError):
            setattr(config, fields[0].name, fields[0].default)


@pytest.mark.parametrize("name", parsers())
def test_every_hyperparameter_has_a_description_and_a_default_within_its_bounds(name):
    for field in config_fields(name):
        assert field.description.endswith(".")
        assert field.minimum is None or field.minimum <= field.default
        assert field.maximum is None or field.default <= field.maximum


def test_an_unknown_parser_is_refused_with_the_names_there_are():
    with pytest.raises(Refusal) as refused:
        make_config("transformer")
    assert refused.value.code == "unknown_parser"


def test_reading_the_hyperparameters_of_every_parser_loads_neither_torch_nor_sklearn():
    code = (
        "import sys; from parser_service.parsers.registry import parsers, config_fields, make_config\n"
        "for name in parsers(): config_fields(name), make_config(name)\n"
        "sys.exit(bool({'torch', 'scipy', 'sklearn'} & {*sys.modules}))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_loading_a_class_leaves_the_garbage_collector_on():
    assert gc.isenabled()
    load_class("knn")
    with pytest.raises(Refusal) as refused:
        load_class("nobody")
    assert refused.value.code == "unknown_parser"
    assert gc.isenabled()


@pytest.mark.parametrize("name", parsers())
def test_every_parser_says_what_its_scores_are(name):
    kinds = {
        "grammar-oracle": None,
        "llm": None,
        "knn": ScoreKind.SIMILARITY,
        "linear": ScoreKind.PROBABILITY,
    }
    assert load_class(name).score_kind == kinds.get(name, ScoreKind.LOG_PROBABILITY)
