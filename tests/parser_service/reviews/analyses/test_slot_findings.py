"""Confusions of slots are counted as the core counts them, and lead to their answers."""

from __future__ import annotations

from annotations.background.progress import UNWATCHED
from parser_service.analysis.confusions import confuse_slots
from parser_service.models import Prediction, RunAnalysis
from parser_service.results.slot_confusions import SLOTS
from parser_service.reviews.analysis_job import confusion_findings, names_of_steps
from parser_service.reviews.target import Target

PAGE = "/w/home/compare/"


def let_confuse(run):
    """Let the run answer some utterances with a slot of another kind."""
    for row in run.predictions.filter(is_exact_match=False).select_related("example")[:5]:
        form = row.example.logical_form.replace("<object>", "<category>")
        Prediction.objects.filter(pk=row.pk).update(logical_form=form)


def test_slots_are_counted_as_the_core_counts_them(sample):
    let_confuse(sample.run)
    rows = list(sample.run.predictions.select_related("example"))
    core = confuse_slots(
        [row.example.logical_form for row in rows], [row.logical_form for row in rows]
    )
    expected = [
        [row.predicate, row.place, row.gold, row.predicted, row.count]
        for row in core
        if row.is_error
    ]
    found = confusion_findings(Target(sample.run, "validation"), UNWATCHED)
    assert found["rows"] == expected
    assert expected
    assert confusion_findings(Target(sample.run, "test"), UNWATCHED) == {"rows": [], "examples": {}}


def test_a_confusion_leads_to_its_answers(sample, anna):
    let_confuse(sample.run)
    from tests.sample_world import scored_run

    second = scored_run(sample.world, sample.split, right=8, seed=1)
    query = {"run": [sample.run.pk, second.pk], "part": "validation"}
    assert anna.get(PAGE, query).context["slots"] is None
    findings = confusion_findings(Target(sample.run, "validation"), UNWATCHED)
    RunAnalysis.objects.create(
        run=sample.run, part="validation", version=1, findings={SLOTS: findings}
    )
    slots = anna.get(PAGE, query).context["slots"]
    assert [row.count for row in slots] == [row[-1] for row in findings["rows"]]
    for row in slots:
        key = f"{row.predicate}:{row.place}:{row.gold}:{row.predicted}"
        chosen = anna.get(row.url).context["listing"]
        assert {each.example_id for each in chosen.rows} == set(findings["examples"][key])
    RunAnalysis.objects.update(findings={SLOTS: {"rows": [], "examples": {}}})
    assert list(anna.get(PAGE, query).context["slots"]) == []


def test_a_worker_stores_them_where_pages_read_them():
    assert SLOTS in names_of_steps()


def test_a_confusion_that_nobody_knows_chooses_nothing(sample, anna):
    for slot in ("x", "1:2:3", f"{sample.run.pk}:bring:1:a:b", f"{10**30}:bring", "%00"):
        page = anna.get(f"/w/home/runs/{sample.run.pk}/predictions/", {"slot": slot})
        assert page.context["listing"].total == 0
