"""Which parts answer in a world, and who chooses them."""

from __future__ import annotations

import pytest

from annotations.language.texts.errors import Refusal
from annotations.models import SemanticTemplate
from parser_service.models import Answering
from parser_service.models.answering import answering_of
from parser_service.runs.promoting import promote
from parser_service.serving.answering import answering_parts, choose_answering, version_of
from tests.annotations.conftest import import_tiny
from tests.parser_service.made_up import make_split
from tests.parser_service.served import make_home, trained_run


@pytest.fixture
def run(world):
    return trained_run(make_home(world))


def test_a_world_without_templates_and_promotion_has_no_part(run, world):
    assert not answering_parts(world) and answering_parts(world).titles == ()


def test_templates_that_are_ready_answer_first(world):
    import_tiny(world)
    assert answering_parts(world).has_oracle and answering_parts(world).run is None
    SemanticTemplate.objects.filter(grammar__world=world).update(status="draft")
    assert not answering_parts(world)


@pytest.mark.parametrize(
    ("order", "has_oracle", "has_run"),
    [("both", True, True), ("oracle", True, False), ("learned", False, True)],
)
def test_the_order_says_which_parts_are_asked(world, admin, order, has_oracle, has_run):
    import_tiny(world)
    run = trained_run(make_split(world))
    promote(run, None)
    choose_answering(world, order, 0.02, admin, 0)
    parts = answering_parts(world)
    assert (parts.has_oracle, parts.run) == (has_oracle, run if has_run else None)
    assert len(parts.titles) == has_oracle + has_run


def test_without_a_promoted_run_the_oracle_answers_whatever_was_chosen(world, admin):
    import_tiny(world)
    choose_answering(world, "learned", 0.02, admin, 0)
    assert answering_parts(world).has_oracle


def test_a_choice_says_who_made_it_and_counts_its_versions(world, admin):
    assert version_of(answering_of(world)) == 0
    row = choose_answering(world, "oracle", 0.1, admin, 0)
    assert (row.version, row.changed_by) == (1, admin)
    row = choose_answering(world, "both", 0.05, admin, 1)
    assert (row.order, row.allowed_wrong, row.version) == ("both", 0.05, 2)


@pytest.mark.parametrize("version", [0, 2, 10**6])
def test_a_choice_about_another_version_is_refused(world, admin, version):
    choose_answering(world, "oracle", 0.1, admin, 0)
    with pytest.raises(Refusal) as refused:
        choose_answering(world, "learned", 0.2, admin, version)
    assert refused.value.status == 409
    assert Answering.objects.get().order == "oracle"


@pytest.mark.parametrize(
    ("order", "allowed"),
    [("", 0.02), ("neither", 0.02), ("both", -0.01), ("both", 0.51), ("both", float("nan"))],
)
def test_what_cannot_be_chosen_is_refused(world, admin, order, allowed):
    with pytest.raises(Refusal):
        choose_answering(world, order, allowed, admin, 0)
    assert not Answering.objects.exists()
