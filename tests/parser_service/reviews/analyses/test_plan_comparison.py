"""Plans of answers, compared when a run is scored, and again later."""

from __future__ import annotations

import io

import numpy as np
import pytest

from annotations.background import Stopped
from annotations.background.progress import UNWATCHED
from annotations.language.corpus import KNOWN
from annotations.models import Recipe, Split
from parser_service.models import Evaluation, Prediction
from parser_service.results.stored_columns import answers_of, examples_of
from parser_service.reviews import plan_comparison
from parser_service.reviews.plan_comparison import compare_plans
from tests.annotations.commands.run_command import run as run_command
from tests.parser_service.made_up import make_split
from tests.parser_service.runs.test_train_run import trained

# What one does for both: the thing is found and taken, and brought to whoever asks.
BRING = '( bring ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <room> " ) ) )'
IN_STEPS = (
    '( sequence ( go " <room> " ) ( find ( lambda $1 e ( is_a $1 " <object> " ) ) ) ( bring it ) )'
)


@pytest.fixture
def split(world, transactional_db):
    return make_split(world)


@pytest.fixture
def run(split):
    """A run with an answer that says in steps what its label says in one word."""
    for part, form in (("train", IN_STEPS), ("validation", BRING), ("test", BRING)):
        chosen = split.examples.filter(part=part, source="generated").first()
        split.examples.filter(pk=chosen.pk).update(utterance="fetch it", logical_form=form)
    return trained(split, train_sources="gen+para")


def plans_of(run):
    return dict(run.predictions.values_list("pk", "is_same_plan"))


def test_a_run_is_scored_with_its_plans(run):
    assert None not in plans_of(run).values()
    only_plan = run.predictions.with_outcome("only_plan")
    assert {row.logical_form for row in only_plan} == {IN_STEPS}
    assert not run.predictions.filter(is_equivalent=True, is_same_plan=False).exists()
    for score in run.evaluations.all():
        assert score.accuracy <= score.equivalent <= score.same_plan
        assert sum(of[4] for of in score.outcomes.values()) == round(score.same_plan * score.count)
    assert any(score.same_plan > score.equivalent for score in run.evaluations.all())


def test_runs_from_before_get_what_a_run_stores(run):
    before = plans_of(run), list(run.evaluations.values())
    columns = answers_of(run, "validation", examples_of(run.split, "validation"))
    run.predictions.update(is_same_plan=None)
    for score in run.evaluations.all():
        score.outcomes = {name: counts[:4] for name, counts in score.outcomes.items()}
        score.same_plan = None
        score.save()
    assert compare_plans(run, UNWATCHED) == len(before[0])
    assert (plans_of(run), list(run.evaluations.values())) == before
    again = answers_of(run, "validation", examples_of(run.split, "validation"))
    assert (again["is_same_plan"] == columns["is_same_plan"]).all()
    assert compare_plans(run, UNWATCHED) == 0


def test_the_recipes_of_the_world_decide_and_are_read_once(run, django_assert_max_num_queries):
    assert run.predictions.with_outcome("only_plan").exists()
    recipes = Recipe.objects.filter(world=run.world, action="bring")
    earlier = list(recipes)
    recipes.delete()
    with django_assert_max_num_queries(60):
        assert compare_plans(run, UNWATCHED) > 0
    assert not run.predictions.with_outcome("only_plan").exists()
    Recipe.objects.bulk_create(earlier)
    compare_plans(run, UNWATCHED)
    assert run.predictions.with_outcome("only_plan").exists()


def test_columns_from_before_are_read_again(run):
    examples = examples_of(run.split, "validation")
    columns = answers_of(run, "validation", examples)
    stored = run.columns.get(part="validation")
    with np.load(io.BytesIO(stored.data)) as archive:
        earlier = {name: archive[name] for name in archive.files if name != "is_same_plan"}
    file = io.BytesIO()
    np.savez_compressed(file, **earlier)
    run.columns.update(data=file.getvalue())
    for _ in range(2):
        again = answers_of(run, "validation", examples)
        assert (again["is_same_plan"] == columns["is_same_plan"]).all()
    assert run.columns.get(part="validation").data == stored.data


def test_of_known_forms_the_count_stays(split):
    Split.objects.filter(pk=split.pk).update(criterion="logical_form")
    split.refresh_from_db()
    run = trained(split, train_sources="gen+para")
    before = list(run.evaluations.filter(part=KNOWN).values())
    assert before and before[0]["same_plan"] is not None
    compare_plans(run, UNWATCHED)
    assert list(run.evaluations.filter(part=KNOWN).values()) == before


def test_it_can_be_stopped_and_goes_on(run, monkeypatch):
    monkeypatch.setattr(plan_comparison, "AT_ONCE", 3)
    expected = plans_of(run)
    run.predictions.update(is_same_plan=None)

    class Stopping:
        def __init__(self):
            self.checks = 0

        def __getattr__(self, name):
            return getattr(UNWATCHED, name)

        def check(self):
            self.checks += 1
            if self.checks > 2:
                raise Stopped("enough")

    with pytest.raises(Stopped):
        compare_plans(run, Stopping())
    known = Prediction.objects.filter(is_same_plan__isnull=False).count()
    assert known == 6
    assert compare_plans(run, UNWATCHED) == len(expected) - known
    assert plans_of(run) == expected


def test_the_command_compares_all_runs_or_one(run):
    run.predictions.update(is_same_plan=None)
    Evaluation.objects.update(same_plan=None)
    report, failure = run_command("compare_plans", "home")
    assert failure is None
    assert report["changed"] == {str(run.pk): run.predictions.count()}
    assert not Evaluation.objects.filter(same_plan__isnull=True).exists()
    report, _ = run_command("compare_plans", "home", "--run", run.pk)
    assert report["changed"] == {str(run.pk): 0}


def test_a_run_that_is_not_there_is_refused(run):
    _, failure = run_command("compare_plans", "home", "--run", run.pk + 1)
    assert failure.returncode == 1
