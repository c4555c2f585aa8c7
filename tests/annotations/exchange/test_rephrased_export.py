"""What people say with plans, for others to train and test with, and GET /api/v1/worlds/<w>/paraphrases/export/"""

from __future__ import annotations

import json

import pytest
from jsonschema import validate

from annotations.exchange.rephrased_export import RephrasedExport, instructions, plan_line, steps_of
from annotations.language.forms import read_form
from annotations.language.plans import default_book, task_plan_schema
from annotations.language.texts.errors import Refusal
from annotations.models import Example, Split
from annotations.rows.task_plans import TaskPlanner
from tests.annotations.commands.run_command import run
from tests.sample_world import make_paraphrase

BRING = '( bring ( lambda $1 e ( is_a $1 " tea " ) ( at $1 " kitchen " ) ) )'
GO = '( go " bath " )'
COUNT = '( say ( count ( lambda $1 e ( person $1 ) ( at $1 " kitchen " ) ) ) )'


@pytest.fixture
def rephrased(tiny_world):
    """The tiny world with what people say for three commands, one of them not accepted."""
    make_paraphrase(
        tiny_world,
        "bring me the tea from the kitchen",
        "go to the kitchen, find a tea, and bring it to me",
        grounded_form=BRING,
        logical_form=BRING,
    )
    make_paraphrase(tiny_world, "go to the bath", "off to the bath", grounded_form=GO)
    make_paraphrase(
        tiny_world, "go to the bath", "swim", grounded_form=GO, logical_form=GO, status="rejected"
    )
    return tiny_world


def cases(world, as_, *chosen):
    export = RephrasedExport(world, world.paraphrases.all(), as_, *chosen)
    return [json.loads(line) for line in b"".join(export.pieces()).splitlines()]


def plan_of(world, form):
    return TaskPlanner.of(world).plan(read_form(form))


def test_chat_is_what_fine_tuning_takes(rephrased):
    first, second = cases(rephrased, "chat")
    assert [each["role"] for each in first["messages"]] == ["system", "user", "assistant"]
    assert first["messages"][0] == second["messages"][0]
    assert first["messages"][1]["content"] == "go to the kitchen, find a tea, and bring it to me"
    answered = json.loads(first["messages"][2]["content"])
    assert answered == list(steps_of(plan_of(rephrased, BRING)))
    assert answered[0] == {"primitive": "go_to", "arguments": {"place": "kitchen"}}


def test_a_model_is_told_every_primitive_and_every_parameter(rephrased):
    told = cases(rephrased, "chat")[0]["messages"][0]["content"]
    assert told == instructions(default_book())
    for primitive in default_book().primitives:
        assert f"{primitive.name}({', '.join(map(str, primitive.parameters))})" in told


def test_pairs_have_a_plan_in_one_line(rephrased):
    first, second = cases(rephrased, "pairs")
    assert first["target"] == (
        'go_to("kitchen") find_object("tea") pick_up("tea") go_to(operator) give("tea", operator)'
    )
    assert second == {"utterance": "off to the bath", "target": 'go_to("bath")'}


def test_a_result_is_said_by_its_step(rephrased):
    plan = plan_of(rephrased, COUNT)
    assert plan_line(plan).endswith("go_to(operator) say(#2, operator)")
    *_, last = steps_of(plan)
    assert last["arguments"]["text"] == {"result": 2}


def test_tests_have_a_plan_of_the_published_schema(rephrased):
    for case in cases(rephrased, "tests"):
        validate(case["expected"], task_plan_schema())
        assert case["expected"] == plan_of(rephrased, case["form"]).as_json()
        row = rephrased.paraphrases.get(pk=case["id"])
        assert (case["input"], case["command"]) == (row.utterance, row.prompt)
        assert (case["source"], case["part"]) == ("paraphrased", "")


def test_what_recipes_do_not_say_is_no_target_but_a_test(rephrased):
    form = '( juggle ( lambda $1 e ( is_a $1 " tea " ) ) )'
    make_paraphrase(rephrased, "juggle the tea", "juggle", grounded_form=form, logical_form=form)
    for as_, count in (("chat", 2), ("pairs", 2), ("tests", 3)):
        export = RephrasedExport(rephrased, rephrased.paraphrases.all(), as_)
        lines = b"".join(export.pieces()).splitlines()
        assert (len(lines), export.cases, export.left_out) == (count, count, 3 - count)


@pytest.mark.parametrize("as_", ["chat", "pairs", "tests"])
def test_a_text_that_is_no_form_breaks_nothing_off(rephrased, as_):
    rephrased.paraphrases.filter(utterance="off to the bath").update(grounded_form="go")
    export = RephrasedExport(rephrased, rephrased.paraphrases.all(), as_)
    assert len(b"".join(export.pieces()).splitlines()) == export.cases == 1
    assert export.left_out == 1


def test_it_takes_as_many_queries_for_many_paraphrases(rephrased, django_assert_max_num_queries):
    for number in range(20):
        make_paraphrase(rephrased, "go", f"go {number}", grounded_form=GO, logical_form=GO)
    with django_assert_max_num_queries(8):
        assert len(cases(rephrased, "pairs")) == 22


@pytest.fixture
def split(rephrased):
    """A split that has the first paraphrase in training and the second in the test part."""
    split = Split.objects.create(
        world=rephrased, name="first", criterion="command", content_hash="0" * 64
    )
    for position, (part, row) in enumerate(
        zip(("train", "test"), rephrased.paraphrases.accepted(), strict=True)
    ):
        add(split, part, position, row.utterance)
    return split


def add(split, part, position, utterance, source="paraphrased"):
    return Example.objects.create(
        split=split,
        part=part,
        position=position,
        source=source,
        utterance=utterance,
        logical_form=GO,
    )


@pytest.mark.parametrize(
    ("part", "count"), [(None, 1), ("train", 1), ("validation", 0), ("test", 1)]
)
def test_a_part_of_a_split_has_its_own_alone(rephrased, split, part, count):
    found = cases(rephrased, "tests", split, part)
    assert len(found) == count
    assert {case["part"] for case in found} <= {part or "train"}
    inputs = {case["input"] for case in found}
    assert inputs <= set(
        split.examples.filter(part=part or "train").values_list("utterance", flat=True)
    )


def test_what_is_held_out_in_other_letters_is_in_no_training_part(rephrased, split):
    add(split, "validation", 0, "Go to the kitchen; find a tea and bring it to me!")
    assert cases(rephrased, "pairs", split, "train") == []


def test_what_came_after_the_split_is_in_no_part(rephrased, split):
    make_paraphrase(rephrased, "go", "off you go", grounded_form=GO, logical_form=GO)
    for part in ("train", "validation", "test"):
        inputs = {case["utterance"] for case in cases(rephrased, "pairs", split, part)}
        assert "off you go" not in inputs


def test_a_part_needs_a_split(rephrased):
    with pytest.raises(Refusal) as refused:
        RephrasedExport(rephrased, rephrased.paraphrases.all(), "chat", part="test")
    assert refused.value.code == "split_needed"


def test_the_command_writes_the_file_and_counts(rephrased, split, tmp_path):
    target = tmp_path / "cases.jsonl"
    report, failure = run("export_rephrased", "home", "--as", "tests", "--output", target)
    assert failure is None
    assert (report["cases"], report["left_out"], report["split"]) == (2, 0, None)
    assert len(target.read_text().splitlines()) == 2
    chosen = ("--split", "first", "--part", "test", "--output", target)
    report, _ = run("export_rephrased", "home", "--as", "tests", *chosen)
    assert (report["cases"], report["part"]) == (1, "test")
    _, failure = run("export_rephrased", "home", "--part", "test", "--output", target)
    assert failure.returncode == 1


EXPORT = "/api/v1/worlds/home/paraphrases/export/"


@pytest.mark.parametrize("as_", ["chat", "pairs", "tests"])
def test_members_get_it_over_rest(rephrased, anna, as_):
    response = anna.get(EXPORT, {"as": as_})
    assert response["Content-Type"].startswith("application/jsonl")
    assert f'filename="home-{as_}.jsonl"' in response["Content-Disposition"]
    lines = b"".join(response.streaming_content).splitlines()
    assert [json.loads(line) for line in lines] == cases(rephrased, as_)


def test_filters_of_the_list_and_a_part_choose_over_rest(rephrased, split, anna):
    def inputs(**query):
        response = anna.get(EXPORT, {"as": "pairs", **query})
        lines = b"".join(response.streaming_content).splitlines()
        return [json.loads(line)["utterance"] for line in lines]

    assert inputs(q="bath") == ["off to the bath"]
    assert inputs(status="rejected") == []
    assert inputs(split=split.pk, part="test") == ["off to the bath"]
    assert inputs(split=split.pk, part="test", q="kitchen") == []


def test_what_cannot_be_asked_is_refused(rephrased, other_world, anna):
    for query in ({"as": "moon"}, {"part": "test"}, {"split": "x"}, {"split": "0"}):
        assert anna.get(EXPORT, query).status_code == 400, query
    other = Split.objects.create(
        world=other_world, name="other", criterion="command", content_hash="1" * 64
    )
    for key in (other.pk, other.pk + 1):
        assert anna.get(EXPORT, {"split": key}).status_code == 404


def test_the_pages_offer_it(rephrased, split, anna):
    assert f"{EXPORT}?as=chat" in anna.get("/w/home/paraphrases/").content.decode()
    page = anna.get(f"/w/home/splits/{split.pk}/").content.decode()
    assert f"{EXPORT}?as=chat&amp;split={split.pk}&amp;part=train" in page
    assert f"{EXPORT}?as=chat&amp;split={split.pk}&amp;part=test" not in page
