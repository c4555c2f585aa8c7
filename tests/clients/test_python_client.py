"""The Python client against a site and a parse server that run."""

from __future__ import annotations

import ast
import json
import subprocess
import sys
import tomllib

import pytest
from command_desk import SORRY_AWAY, WILL, WILL_NOT, CommandDesk
from pytest_django.live_server_helper import LiveServer

from annotations.models import ApiToken
from gpsr_client import Away, Dialogue, Parse, Refused, Workbench, WorkbenchError
from parser_service.serving.parser_client import AWAY
from parser_service.web.serving import parsing_rest
from tests.clients.conftest import CLIENT


@pytest.fixture
def home(parse_server, live_server: LiveServer, annotator) -> Workbench:
    _, token = ApiToken.issue(annotator, "robot", scope="annotate")
    return Workbench(live_server.url, "home", token)


def test_an_utterance_is_parsed(home):
    parse = home.parse("find the red cup", beam=2)
    assert len(parse.candidates) == 2 and parse.best is not None
    assert "red cup" in parse.best.grounded
    assert parse.best.plan is not None and parse.best.plan.is_executable
    assert parse.best.plan.steps[0].action == "find"
    assert (parse.parser, parse.run, parse.decision) == ("knn", parse.raw["run"], "confirm")
    assert not parse.may_act and 0 < parse.probability < 1 and "red cup" in parse.spoken
    assert (parse.reasons, parse.several, parse.joint_plan, parse.agrees) == ((), (), None, None)


def test_a_refusal_says_why(home):
    parse = home.parse("Do not bring me the red cup")
    assert (parse.decision, parse.best, parse.may_act) == ("refuse", None, False)
    assert [each.code for each in parse.reasons] == ["forbidden"]
    assert parse.reasons[0].message in parse.spoken


def test_one_run_is_asked_alone(home):
    run = home.parse("find the red cup").run
    assert home.parse("find the red cup", run=run).run == run
    (parse,) = home.parse_many(["find the red cup"], run=run)
    assert parse.run == run
    with pytest.raises(Refused):
        home.parse("find the red cup", run=run, parser="grammar-oracle")


def test_a_form_becomes_a_plan_and_a_behaviour_tree(home):
    best = home.parse("find the red cup").best
    assert home.plan(best.grounded) == best.plan
    assert home.behavior_tree(best.grounded).startswith("<?xml")
    assert home.task_plan(best.grounded) == best.task_plan
    assert [step.primitive for step in best.task_plan.steps] == ["find_object"]
    assert "find_object" in home.behavior_tree(best.grounded, in_primitives=True)
    assert "red cup" in best.spoken
    with pytest.raises(Refused) as refused:
        home.behavior_tree("( find")
    assert refused.value.status == 400


def test_several_commands_become_one_plan(home):
    joint = home.joint_plan(
        ["find the red cup", "bring me the flurb"], {("kitchen", "operator"): 3.0}
    )
    assert {number for commands in joint.serves for number in commands} == {1, 2}
    assert joint.length <= joint.length_before and joint.spoken and joint.unit == "m"
    assert joint.ends_at == {"kind": "operator"} and not joint.not_understood
    assert {"way_back", "walk"} <= {note.code for note in joint.notes}
    assert joint.is_interleaved is bool(joint.raw["joint_plan"]["interleaved"])
    robust = home.behavior_tree('(go "kitchen")', in_primitives=True, tries=5, seconds=2.5)
    assert 'num_attempts="5"' in robust and 'msec="2500"' in robust
    assert [each.commands for each in joint.plan.problems] == [(2,)]
    with pytest.raises(Refused):
        home.joint_plan(["find the red cup"] * 4)


def test_many_utterances_are_parsed_in_order(home):
    said = ["find the red cup", "bring me the bowl", "bring me the flurb"]
    parses = list(home.parse_many(said))
    assert [parse.utterance for parse in parses] == said
    (slot,) = parses[2].best.open_slots
    assert (slot.phrases, slot.choices) == (("flurb",), ("red cup", "bowl"))
    assert list(home.parse_many([])) == []
    with pytest.raises(WorkbenchError, match=r"\b2\b"):
        list(home.parse_many(["find the bowl", " "]))


def test_a_batch_that_breaks_off_is_not_taken_for_whole(home, monkeypatch):
    monkeypatch.setattr(parsing_rest, "MOST_SECONDS", 0)
    answered = []
    with pytest.raises(Away, match=r"\b\d+ of 200 "):
        for parse in home.parse_many(["find the red cup"] * 200):
            answered.append(parse)
    assert len(answered) < 200


def test_a_dialogue_is_held_and_gone_on_with(home):
    talk = home.dialogue("bring me the flurb")
    assert (talk.phase, talk.asked.phrases) == ("asking", ("flurb",))
    after = home.dialogue_at(talk.id).answer("the bowl")
    assert after.prompt == "Shall I bring you the bowl?" and after.asked is None
    with pytest.raises(Refused) as late:
        talk.answer("red cup")
    assert (late.value.status, late.value.code) == (409, "dialogue_answered_meanwhile")
    done = after.answer("yes")
    assert done.is_agreed and done.may_act and "bowl" in done.grounded
    raw = {**done.raw, "task_plan": {**done.raw["task_plan"], "is_executable": False}}
    stopped = Dialogue(done._transport, done._path, raw)
    assert stopped.is_agreed and not stopped.may_act
    assert done.task_plan.is_executable and done.task_plan.steps[-1].releases["kind"]
    assert "bowl" in done.spoken


def test_examples_are_exported_whole(home, parse_server, world, tmp_path):
    split = world.splits.get()
    file = home.export(split.pk, tmp_path / "train.jsonl", part="train", source="paraphrased")
    rows = [json.loads(line) for line in file.read_text().splitlines()]
    assert len(rows) == split.examples.filter(part="train", source="paraphrased").count()
    with pytest.raises(Refused) as refused:
        home.export(split.pk + 1, file)
    assert refused.value.status == 404
    assert len(file.read_text().splitlines()) == len(rows)
    assert [each.name for each in tmp_path.iterdir()] == ["train.jsonl"]


def test_a_split_is_exported_by_its_name(home, parse_server, world, tmp_path):
    split = world.splits.get()
    by_name = home.export(split.name, tmp_path / "one.jsonl")
    assert by_name.read_text() == home.export(split.pk, tmp_path / "two.jsonl").read_text()
    with pytest.raises(Refused, match=f"{split.name}-2") as refused:
        home.export(f"{split.name}-2", tmp_path / "three.jsonl")
    assert refused.value.status == 404


def test_results_are_tables_that_pandas_reads(home, parse_server, world, tmp_path):
    import pandas

    parquet = pandas.read_parquet(home.export_results(tmp_path / "all.parquet", "parquet"))
    table = pandas.read_csv(home.export_results(tmp_path / "all.csv"))
    assert list(table) == list(parquet)
    assert table["run_id"].tolist() == parquet["run_id"].tolist()
    with pytest.raises(Refused) as refused:
        home.export_results(tmp_path / "all.xlsx", "xlsx")
    assert refused.value.status == 400


def test_refusals_and_absence_are_sentences(home, live_server, settings):
    with pytest.raises(Refused) as refused:
        Workbench(live_server.url, "home", "nonsense").parse("go")
    assert refused.value.status == 401
    with pytest.raises(Refused) as refused:
        home.parse("")
    assert refused.value.problems[0]["field"] == "utterance"
    settings.PARSER_URL = "http://127.0.0.1:9"
    with pytest.raises(Away, match=AWAY):
        home.parse("go")
    with pytest.raises(Away, match=r"127\.0\.0\.1:9"):
        Workbench("http://127.0.0.1:9", "home", "t", timeout=1).parse("go")
    with pytest.raises(ValueError, match="file:///etc/passwd"):
        Workbench("file:///etc/passwd", "home", "t")
    assert "nonsense" not in repr(vars(Workbench(live_server.url, "home", "nonsense")))


def test_a_desk_confirms_asks_refuses_and_hands_over_what_is_agreed(home, settings):
    said: list[str] = []
    plans: list[str] = []
    desk = CommandDesk(home, said.append, plans.append)
    for text in ("find the bowl", "", "no", "find the bowl", "Do not find it", "find the bowl"):
        desk.hear(text)
    assert not plans and said[1] == WILL_NOT and "bowl" in said[-1]
    desk.hear("Yes!")
    assert said[-1] == WILL
    (plan,) = map(json.loads, plans)
    assert [step["primitive"] for step in plan["steps"]] == ["find_object"]
    settings.PARSER_URL = "http://127.0.0.1:9"
    desk.hear("find the bowl")
    assert said[-1] == SORRY_AWAY


@pytest.mark.parametrize("decision", ["act", "confirm"])
def test_what_cannot_be_carried_out_is_not_handed_over(home, decision):
    raw = {**home.parse("find the bowl").raw, "decision": decision}
    problem = {"code": "hands_full", "step": 1, "message": "There is no hand free.", "hint": ""}
    first = raw["candidates"][0]
    plan = {**first["task_plan"], "is_executable": False, "problems": [problem], "unresolved": []}
    stopped = Parse.from_json({**raw, "candidates": [{**first, "task_plan": plan}]})
    assert not stopped.may_act
    assert Parse.from_json(raw).may_act is (decision == "act")

    class Stopped:
        def parse(self, utterance: str) -> Parse:
            return stopped

        def dialogue(self, utterance: str) -> Dialogue:
            return home.dialogue(utterance)

    said: list[str] = []
    plans: list[str] = []
    desk = CommandDesk(Stopped(), said.append, plans.append)
    desk.hear("find the bowl")
    if decision == "confirm":
        desk.hear("yes")
    assert not plans and said[-1] == problem["message"]


def test_the_client_needs_the_standard_library_alone():
    names = {
        alias.split(".")[0]
        for path in (CLIENT / "gpsr_client").glob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        for alias in (
            [each.name for each in node.names]
            if isinstance(node, ast.Import)
            else [node.module or ""]
            if isinstance(node, ast.ImportFrom)
            else []
        )
    }
    assert names - {"gpsr_client"} <= sys.stdlib_module_names
    project = tomllib.loads((CLIENT / "pyproject.toml").read_text())["project"]
    assert project["dependencies"] == []


def test_the_client_and_its_examples_are_typed_and_compile():
    assert (CLIENT / "gpsr_client" / "py.typed").exists()
    for path in CLIENT.rglob("*.py"):
        compile(path.read_text(encoding="utf-8"), str(path), "exec")
    checked = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--config-file=", "gpsr_client"],
        cwd=CLIENT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert checked.returncode == 0, checked.stdout
