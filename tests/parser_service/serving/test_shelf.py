"""What the parse server holds, and how that follows the database."""

from __future__ import annotations

import json

import pytest
from django.utils import timezone

from annotations.exchange.generator_import import import_generator
from annotations.models import Entity, World
from parser_service.models import Answering, AnsweringOrder
from parser_service.runs import run_requests
from parser_service.runs.checkpoints import model_folder, remove_folder
from parser_service.runs.knowledge import knowledge_of
from parser_service.runs.promoting import promote
from parser_service.serving.metrics import Metrics
from parser_service.serving.shelf import NotServed, Shelf
from tests.annotations.conftest import TINY, as_bytes
from tests.parser_service.made_up import make_split
from tests.parser_service.served import make_home, trained_run

RED_CUP = '( bring ( lambda $1 e ( is_a $1 " red cup " ) ) )'


@pytest.fixture
def split(world):
    return make_home(world)


@pytest.fixture
def shelf():
    return Shelf(10_000_000, Metrics())


def answer_of(shelf: Shelf, utterance: str, run: int | None = None, world: str = "home") -> dict:
    return json.loads(shelf.find(world, run, 0).parse([utterance], 5)[0])


def test_the_promoted_parser_answers_with_the_entities_of_the_utterance(split, shelf):
    run = trained_run(split, train_sources="gen")
    promote(run, None)
    assert not shelf.is_ready
    shelf.update()
    answer = answer_of(shelf, "Bring me the red cup")
    assert shelf.is_ready
    assert (answer["run"], answer["parser"], answer["score_kind"]) == (run.pk, "knn", "similarity")
    assert answer["anonymized"] == "Bring me the <object>"
    assert answer["parsed_text"] == answer["utterance"] == "Bring me the red cup"
    assert answer["spans"] == [
        {
            "start": 13,
            "end": 20,
            "text": "red cup",
            "token": "<object>",
            "entity_class": "object",
            "value": "red cup",
            "likeness": "exact",
        }
    ]
    first = answer["candidates"][0]
    assert (first["grounded"], first["english"]) == (RED_CUP, "bring me the red cup")
    assert first["open_slots"] == [] and answer["is_unknown"] is False
    assert first["plan"]["is_executable"]


def test_what_stays_open_is_offered(split, shelf):
    promote(trained_run(split, train_sources="gen"), None)
    shelf.update()
    answer = answer_of(shelf, "bring me the bowl the red cup")["candidates"][0]
    (slot,) = answer["open_slots"]
    assert (slot["choices"], slot["is_named"]) == (["bowl", "red cup"], True)
    assert slot["question"].endswith("Bowl or red cup?")
    assert answer["plan"]["problems"][0]["code"] == "ambiguous"


def test_a_parser_that_abstains_answers_unknown(split, shelf):
    promote(trained_run(split, config={"least_overlap": 0.9}), None)
    shelf.update()
    answer = answer_of(shelf, "sing a song")
    assert (answer["is_unknown"], answer["candidates"]) == (True, [])


def test_a_newly_promoted_run_takes_over_and_who_began_ends_with_the_old_one(split, shelf):
    first, second = trained_run(split), trained_run(split, seed=1)
    promote(first, None)
    shelf.update()
    begun = shelf.find("home", None, 0)
    promote(second, None)
    shelf.update()
    assert answer_of(shelf, "find the bowl")["run"] == second.pk
    assert json.loads(begun.parse(["find the bowl"], 5)[0])["run"] == first.pk


def test_a_parser_that_cannot_be_loaded_leaves_the_old_one(split, shelf):
    first, second = trained_run(split), trained_run(split, seed=1)
    promote(first, None)
    shelf.update()
    promote(second, None)
    remove_folder(model_folder(second.pk))
    shelf.update()
    assert answer_of(shelf, "find the bowl")["run"] == first.pk
    (said,) = shelf.describe()
    assert (said["promoted"], said["run"]) == (second.pk, first.pk)
    assert str(model_folder(second.pk)) in said["problem"]


def test_a_fault_of_the_program_is_in_the_log_and_not_among_what_people_read(
    split, shelf, monkeypatch, caplog
):
    def break_down(run):
        raise ValueError("inner words of a library")

    run = trained_run(split)
    promote(run, None)
    monkeypatch.setattr("parser_service.serving.shelf.load_anew", break_down)
    shelf.update()
    (said,) = shelf.describe()
    assert f"Run {run.pk} " in said["problem"]
    assert "inner words" not in said["problem"] and "inner words" in caplog.text


def test_an_entity_that_is_added_is_known_from_then_on(split, shelf):
    promote(trained_run(split, train_sources="gen"), None)
    shelf.update()
    before = shelf.find("home", None, 0)
    assert answer_of(shelf, "bring me the flurb")["spans"] == []
    ontology = split.world.ontology
    Entity.objects.create(ontology=ontology, entity_class="object", text="flurb", position=9)
    shelf.update()
    answer = answer_of(shelf, "bring me the flurb")
    assert answer["candidates"][0]["english"] == "bring me the flurb"
    assert shelf.find("home", None, 0).learned is before.learned  # it need not be loaded again


def test_a_parser_that_knows_the_ontology_is_loaded_again_with_it(split, shelf, monkeypatch):
    knowledge = []
    monkeypatch.setattr(
        "parser_service.serving.loading.knowledge_of",
        lambda world, protocol: (
            (protocol == "domain" and knowledge.append(world)) or knowledge_of(world, protocol)
        ),
    )
    run = trained_run(split)
    type(run).objects.filter(pk=run.pk).update(protocol="domain")
    promote(run, None)
    shelf.update()
    shelf.update()
    assert len(knowledge) == 1
    Entity.objects.filter(text="bowl").update(text="basin", version=2)
    shelf.update()
    assert len(knowledge) == 2


def test_another_run_of_the_world_can_be_asked(split, other_world, shelf):
    first, other = trained_run(split), trained_run(split, seed=1)
    promote(first, None)
    shelf.update()
    assert answer_of(shelf, "find the bowl", other.pk)["run"] == other.pk
    assert answer_of(shelf, "find the bowl", first.pk)["run"] == first.pk
    with pytest.raises(NotServed, match=rf"\b{other.pk}\b.*laboratory") as refused:
        shelf.find("laboratory", other.pk, 0)
    assert refused.value.status == 409


def test_runs_that_are_not_promoted_have_a_bound_on_memory(split):
    shelf = Shelf(1, Metrics())
    shelf.update()
    run = trained_run(split)
    with pytest.raises(NotServed, match="PARSER_MEMORY_MB"):
        shelf.find("home", run.pk, 0)
    size = sum(each.stat().st_size for each in model_folder(run.pk).iterdir())
    roomy = Shelf(int(2.5 * size), Metrics())
    roomy.update()
    for seed in range(1, 5):
        roomy.find("home", trained_run(split, seed=seed).pk, 0)
        roomy.find("home", run.pk, 0)
    assert len(roomy._others) == 2


def test_what_cannot_be_asked_is_a_sentence(split, shelf):
    shelf.update()
    with pytest.raises(NotServed, match="home") as refused:
        shelf.find("home", None, 0)
    assert refused.value.status == 409
    told = refused.value.message
    run_requests.request(split.world, split, "seq2seq", send=False)
    with pytest.raises(NotServed, match="home") as refused:
        shelf.find("home", None, 0)
    assert (refused.value.status, refused.value.message == told) == (409, False)
    with pytest.raises(NotServed, match="moon") as refused:
        shelf.find("moon", None, 0)
    assert refused.value.status == 404
    with pytest.raises(NotServed) as refused:
        Shelf(1, Metrics()).find("home", None, 0)
    assert refused.value.status == 503


def test_a_world_that_is_new_or_gone_is_noticed(split, shelf):
    promote(trained_run(split), None)
    shelf.update()
    World.objects.create(name="new")
    with pytest.raises(NotServed, match="new") as refused:
        shelf.find("new", None, 0)
    assert refused.value.status == 409
    split.world.promotions.all().delete()
    shelf.update()
    with pytest.raises(NotServed, match="home") as refused:
        shelf.find("home", None, 0)
    assert refused.value.status == 409


def test_an_encoder_decoder_is_served_without_the_folder_that_it_was_trained_from(
    split, shelf, tmp_path
):
    from tests.parser_service.neural.tiny_encoder_decoder import write_t5

    folder = write_t5(tmp_path / "t5")
    config = {"encoder": str(folder), "steps": 2, "threads": 1}
    promote(trained_run(split, parser="t5", protocol="domain", config=config, anywhere=True), None)
    folder.rename(tmp_path / "elsewhere")
    shelf.update()
    answer = answer_of(shelf, "Bring me the red cup")
    assert (answer["parser"], answer["score_kind"]) == ("t5", "log_probability")
    assert answer["candidates"][0]["score"] < 0
    assert all(candidate["english"] for candidate in answer["candidates"])


@pytest.fixture
def tiny(world):
    """A world with templates and no run."""
    assert not import_generator(world.name, as_bytes(TINY)).problems
    return world


def who_answers(shelf: Shelf) -> list[str]:
    """Return who answers a command of the templates, and a sentence that only a learned part may understand."""
    said = ("find the tea", "where is the tea now")
    return [answer_of(shelf, each)["parser"] for each in said]


def test_the_oracle_of_a_world_without_a_run_answers_when_it_is_first_asked(tiny, shelf):
    shelf.update()
    assert shelf.is_ready and shelf.describe() == []
    answer = answer_of(shelf, "find the tea")
    assert (answer["parser"], answer["run"], answer["decision"]) == ("grammar-oracle", None, "act")
    held = shelf.find("home", None, 0)
    shelf.update()
    assert shelf.find("home", None, 0) is held
    Entity.objects.create(ontology=tiny.ontology, entity_class="object", text="gin", position=99)
    shelf.update()
    assert answer_of(shelf, "find the gin")["decision"] == "act"


def test_both_parts_of_a_world_are_held(tiny, shelf):
    run = trained_run(make_split(tiny))
    promote(run, None)
    shelf.update()
    assert who_answers(shelf) == ["grammar-oracle", "knn"]
    assert answer_of(shelf, "find the tea", run.pk)["parser"] == "knn"
    alone = shelf.find("home", None, 0, "grammar-oracle")
    assert (alone.learned, alone.oracle.name) == (None, "grammar-oracle")


def test_a_world_without_templates_has_no_oracle_to_ask(split, shelf):
    promote(trained_run(split), None)
    shelf.update()
    with pytest.raises(NotServed) as refused:
        shelf.find("home", None, 0, "grammar-oracle")
    assert (refused.value.status, refused.value.code) == (409, "no_templates")


@pytest.mark.parametrize(
    ("order", "parsers"),
    [
        (AnsweringOrder.ORACLE, ["grammar-oracle", "grammar-oracle"]),
        (AnsweringOrder.LEARNED, ["knn", "knn"]),
    ],
)
def test_a_changed_order_takes_effect_with_the_next_look(tiny, shelf, order, parsers):
    promote(trained_run(make_split(tiny)), None)
    shelf.update()
    assert who_answers(shelf) == ["grammar-oracle", "knn"]
    Answering.objects.create(world=tiny, order=order)
    shelf.update()
    assert who_answers(shelf) == parsers
    Answering.objects.all().delete()
    shelf.update()
    assert who_answers(shelf) == ["grammar-oracle", "knn"]


def test_a_learned_part_that_cannot_be_loaded_leaves_the_oracle_with_a_warning(tiny, shelf):
    run = trained_run(make_split(tiny))
    promote(run, None)
    remove_folder(model_folder(run.pk))
    shelf.update()
    answer = answer_of(shelf, "find the tea")
    assert (answer["parser"], answer["decision"]) == ("grammar-oracle", "act")
    (said,) = shelf.describe()
    assert said["run"] is None and said["problem"] in answer["warnings"]


def test_a_learned_part_that_went_leaves_the_oracle_alone(tiny, shelf):
    promote(trained_run(make_split(tiny)), None)
    shelf.update()
    tiny.promotions.all().delete()
    shelf.update()
    assert who_answers(shelf) == ["grammar-oracle", "grammar-oracle"]
    assert shelf.describe() == []


def test_a_world_that_is_deleted_answers_no_more(tiny, shelf):
    shelf.update()
    assert answer_of(shelf, "find the tea")["decision"] == "act"
    World.objects.filter(pk=tiny.pk).update(deletion_requested_at=timezone.now())
    shelf.update()
    with pytest.raises(NotServed) as refused:
        shelf.find("home", None, 0)
    assert refused.value.status == 404


def test_a_share_of_wrong_acts_that_is_changed_decides_anew(tiny, shelf):
    shelf.update()
    before = answer_of(shelf, "find the tea")
    Answering.objects.create(world=tiny, allowed_wrong=0.0)
    shelf.update()
    after = answer_of(shelf, "find the tea")
    assert (before["decision"], after["decision"]) == ("act", "confirm")
    assert before["probability"] == after["probability"]
