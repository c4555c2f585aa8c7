"""What a robot gets from a world: counted, calibrated without its own cluster, and stored."""

from __future__ import annotations

import json
from dataclasses import replace
from io import StringIO

import pytest
from django.core.management import CommandError, call_command

from annotations.background.progress import UNWATCHED
from annotations.language.world import Entity, Ontology
from annotations.models import Example, Job, JobKind
from parser_service.analysis.sureness import (
    LEAST_PEOPLE,
    AnsweredForm,
    AnsweringPart,
    Calibration,
    Evidence,
)
from parser_service.models import AnswererEvaluation, Answering
from parser_service.results.answerer_figures import FIGURES, as_said, evaluate_answerer
from parser_service.results.answerer_rows import (
    answerer_tables,
    as_row,
    figure_of,
    newest_answerer_table,
    reliability_chart,
    reliability_of,
)
from parser_service.results.measuring_job import measure as measure_job
from parser_service.serving.calibrating import calibrated
from tests.parser_service.answerers import WrittenAnswerer

GO, FIND = '( go " <room> " )', '( find ( lambda $1 e ( is_a $1 " <object> " ) ) )'
ORACLE = Evidence(AnsweringPart.ORACLE, is_exact=True)
LEARNED = Evidence(AnsweringPart.LEARNED, learned_log_probability=-0.001, margin=6)


@pytest.fixture
def people(sample):
    """What forty people said, each to another command, in the validation part."""
    Example.objects.filter(split=sample.split).exclude(part="train").delete()
    return [
        Example.objects.create(
            split=sample.split,
            part="validation",
            source="paraphrased",
            position=number,
            utterance=f"walk there {number}",
            source_command=f"go {number}",
            logical_form=GO,
        )
        for number in range(40)
    ]


def measure(sample, answers, **about):
    return evaluate_answerer(sample.world, sample.split, WrittenAnswerer(answers, **about))


def answers_of(people, evidence, form=GO, **about):
    return {each.utterance: AnsweredForm(form, evidence, **about) for each in people}


def test_what_is_decided_is_counted(sample, people):
    said = answers_of(people, ORACLE)
    said |= answers_of(people[:2], ORACLE, FIND)
    said |= answers_of(people[2:5], ORACLE, open_slots=True)
    said |= answers_of(people[5:9], ORACLE, objections=True)
    said[people[9].utterance] = AnsweredForm(seconds=0.4)
    (row,) = measure(sample, said)
    assert (row.part, row.test_source, row.count) == ("validation", "para", 40)
    assert (row.correct, row.same_plan) == (37, 37)
    assert (row.asked, row.refused) == (3, 5)
    assert row.acted + row.confirmed + row.asked + row.refused == row.count
    assert row.wrong_acts + row.confirmed - row.confirmed_right == 2
    assert row.seconds == pytest.approx(0.01)
    assert len(row.answers) == 40
    assert [each for each in row.answers if each[0] is None] == [[None, False, "refuse"]]


def test_every_share_is_inside_its_interval(sample, people):
    said = answers_of(people, LEARNED) | answers_of(people[:4], LEARNED, FIND)
    (row,) = measure(sample, said)
    for name, whole in FIGURES.items():
        if getattr(row, whole):
            low, high = row.intervals[name]
            assert 0 <= low <= getattr(row, name) / getattr(row, whole) <= high <= 1
        else:
            assert name not in row.intervals


def test_a_learned_parser_acts_only_where_people_were_heard(sample, people):
    (row,) = measure(sample, answers_of(people, LEARNED))
    assert row.acted == 40
    few = people[: LEAST_PEOPLE - 1]
    Example.objects.exclude(pk__in=[each.pk for each in few]).filter(part="validation").delete()
    (row,) = measure(sample, answers_of(few, LEARNED))
    assert (row.acted, row.confirmed) == (0, len(few))
    Example.objects.filter(part="validation").update(source="generated")
    (row,) = measure(sample, answers_of(few, LEARNED))
    assert (row.test_source, row.acted, row.calibration["examples"]) == ("gen", 0, 0)


def test_no_answer_is_calibrated_by_its_own_cluster(sample, people):
    """Alone in its cluster, a wrong answer lowers all others and not itself."""
    said = answers_of(people, LEARNED) | answers_of(people[:1], LEARNED, FIND)
    (row,) = measure(sample, said)
    of = dict(zip([each.utterance for each in people], row.answers, strict=True))
    wrong = of[people[0].utterance]
    assert wrong[1] is False
    assert (
        wrong[0]
        == max(sure for sure, _, _ in row.answers)
        > min(sure for sure, _, _ in row.answers)
    )


def test_the_test_part_is_calibrated_on_validation_and_chooses_nothing(sample, people):
    test = people[20:]
    Example.objects.filter(pk__in=[each.pk for each in test]).update(part="test")
    said = answers_of(people[:20], LEARNED) | answers_of(test, LEARNED, FIND)
    validation, tested = measure(sample, said)
    assert (validation.part, tested.part) == ("validation", "test")
    assert tested.calibration == validation.calibration
    assert tested.calibration["examples"] == 20
    sure = Calibration.read(tested.calibration).probability(LEARNED)
    assert {each[0] for each in tested.answers} == {round(sure, 4)}


def test_another_measurement_takes_the_place_of_the_one_before(sample, people):
    measure(sample, answers_of(people, ORACLE), order="oracle")
    measure(sample, answers_of(people, LEARNED))
    measure(sample, answers_of(people, LEARNED, FIND))
    of_oracle, both = AnswererEvaluation.objects.order_by("-order")
    assert (of_oracle.order, of_oracle.correct) == ("oracle", 40)
    assert (both.order, both.correct) == ("both", 0)


def test_an_unknown_command_that_nobody_answers_is_right(sample, people):
    Example.objects.filter(pk=people[0].pk).update(logical_form="UNKNOWN")
    (row,) = measure(sample, {})
    assert (row.correct, row.same_plan, row.refused) == (1, 1, 40)
    assert row.brier is None
    assert reliability_of([row]) is None


def test_what_was_measured_is_what_the_world_answers_by(sample, people):
    said = answers_of(people, LEARNED) | answers_of(people[:4], LEARNED, FIND)
    (row,) = measure(sample, said)
    now = calibrated(sample.world, None, "both", 0.02)
    assert now.calibration == Calibration.read(row.calibration)
    assert now.point.act == row.calibration["point"]["act"]
    assert now.has_people
    assert calibrated(sample.world, None, "both", 0.5).point.act < now.point.act
    other = calibrated(sample.world, sample.run.pk, "both", 0.02)
    assert (other.calibration, other.has_people) == (Calibration(), False)


def test_the_world_chooses_what_is_allowed(sample, people):
    Answering.objects.create(world=sample.world, allowed_wrong=0.4)
    (row,) = measure(sample, answers_of(people, replace(LEARNED, learned_log_probability=-0.4)))
    assert row.calibration["allowed_wrong"] == 0.4
    assert row.calibration["point"]["act"] == 0.6


def test_a_robot_hears_entities(sample):
    ontology = Ontology(
        (Entity("room", "kitchen"), Entity("room", "hall"), Entity("object", "tea"))
    )
    said = as_said("go from the <room> to the <room> with the <object1> and <object1>", ontology)
    first, second = ("kitchen", "hall") if "from the kitchen" in said else ("hall", "kitchen")
    assert said == f"go from the {first} to the {second} with the tea and tea"
    assert said == as_said(
        "go from the <room> to the <room> with the <object1> and <object1>", ontology
    )
    assert as_said("greet <name>", ontology) == "greet <name>"


def test_a_figure_says_what_it_is_a_share_of(sample, people):
    (row,) = measure(sample, answers_of(people, ORACLE, open_slots=True))
    nothing = figure_of(row, "wrong_acts")
    assert nothing.percent is None
    asked = figure_of(row, "asked")
    assert asked.percent == 100
    assert asked.low < 100
    assert "40 of 40" in asked.sentence
    assert as_row(row)["wrong_acts"] is None
    assert as_row(row)["asked"] == 1


def test_the_diagram_has_all_answers(sample, people):
    (row,) = measure(sample, answers_of(people, LEARNED) | answers_of(people[:3], ORACLE, FIND))
    measured = reliability_of([row])
    assert sum(each.count for each in measured.bins) == 40
    right, diagonal = reliability_chart(measured)["series"]
    assert all(low <= share <= high for _, share, low, high in right["points"])
    assert [each[:2] for each in diagonal["points"]] == [[0, 0], [100, 100]]


def test_pages_show_the_newest_of_the_order_that_the_world_has(sample, people):
    assert newest_answerer_table(sample.world) is None
    measure(sample, answers_of(people, ORACLE), order="oracle")
    assert answerer_tables(sample.world, [sample.split], "validation") == []
    measure(sample, answers_of(people, LEARNED))
    (table,) = answerer_tables(sample.world, [sample.split], "validation")
    assert (table.first.row.order, table.is_outdated, table.examples) == ("both", False, 40)
    sample.world.mark_changed()
    newest = newest_answerer_table(sample.world)
    assert (newest.first.row, newest.is_outdated) == (table.first.row, True)


@pytest.mark.usefixtures("people")
def test_the_command_measures_with_the_oracle_alone(sample):
    out = StringIO()
    call_command("evaluate_answerer", "home", "--order", "oracle", "--json", stdout=out)
    (row,) = json.loads(out.getvalue())["rows"]
    assert (row["order"], row["run"], row["count"]) == ("oracle", None, 40)
    assert row["refused"] == 1
    call_command("evaluate_answerer", "home", "--order", "oracle", stdout=out)


def test_a_job_measures_what_the_page_asks_for(sample, people, rene):
    sample.run.delete()
    answer = rene.post("/w/home/results/measure/", {"split": sample.split.pk})
    job = Job.objects.get(kind=JobKind.MEASURE)
    assert answer.url == f"/jobs/{job.pk}/"
    assert measure_job(job, UNWATCHED) == {"split": "home-split", "examples": 40, "people": 0}
    assert AnswererEvaluation.objects.get().split == sample.split
    asked = rene.post("/api/v1/worlds/home/results/measure/", {}, "application/json")
    assert asked.json()["id"] == job.pk


def test_the_command_refuses_a_share_that_is_none(sample):
    with pytest.raises(CommandError) as refused:
        call_command("evaluate_answerer", "home", "--allowed-wrong", "0.9")
    assert refused.value.__cause__.code == "option_out_of_range"


def test_a_world_without_a_split_is_told_so(world):
    with pytest.raises(CommandError) as refused:
        call_command("evaluate_answerer", world.name)
    assert refused.value.__cause__.code == "no_split"


def test_results_and_overview_show_what_a_robot_gets(sample, people, anna, rene):
    for address in ("/w/home/", "/w/home/results/?part=validation"):
        assert "/w/home/results/measure/" in rene.get(address).content.decode()
        assert "/w/home/results/measure/" not in anna.get(address).content.decode()
    said = answers_of(people, LEARNED) | answers_of(people[:4], LEARNED, FIND)
    (row,) = measure(sample, said)
    overview = anna.get("/w/home/")
    assert overview.context["measured"].first.row == row
    results = anna.get("/w/home/results/?part=validation")
    (shown,) = results.context["answerer"]
    assert shown.first.row == row
    for figure in shown.first.figures:
        assert figure.sentence in results.content.decode()
        assert figure.sentence in overview.content.decode()
    assert not anna.get("/w/home/results/?part=test").context["answerer"]
    (exported,) = anna.get("/w/home/results.json?part=validation").json()["answerer"]
    assert (exported["count"], exported["same_plan"]) == (40, 0.9)
