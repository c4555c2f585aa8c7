"""A world that is downloaded and imported is the same world again, row for row."""

from __future__ import annotations

import io
import json
from typing import Any

import pytest
from django.apps import apps
from django.db import models

from annotations.campaigns import answering
from annotations.campaigns.model_rewrites import ModelSettings, model_contributor, store_rewrites
from annotations.campaigns.tasks import begin
from annotations.editing.commenting import SUBJECTS, add_comment
from annotations.editing.edits import change, delete
from annotations.exchange.archive_tables import tables
from annotations.exchange.competition_import import import_competition
from annotations.exchange.generator_import import import_generator
from annotations.exchange.pair_import import import_pairs
from annotations.exchange.starter_world import STARTER_WORLD, load_starter_world
from annotations.exchange.world_export import world_archive
from annotations.exchange.world_import import import_world
from annotations.generation.generating import generate_pairs
from annotations.labelling.audit_findings import store_findings
from annotations.labelling.collecting import collect
from annotations.labelling.enqueuing import set_share
from annotations.labelling.finishing import finish
from annotations.labelling.giving import next_item
from annotations.labelling.label_answers import label, take_back_label
from annotations.labelling.label_decisions import decide
from annotations.language.plans import ActionName
from annotations.language.texts.errors import LanguageError
from annotations.models import (
    FindingStatus,
    Grammar,
    Label,
    Membership,
    Ontology,
    Recipe,
    SemanticTemplate,
    Verdict,
    WorkKind,
    World,
)
from annotations.models.worlds import Duty
from annotations.rows.from_rows import recipe_book_of
from parser_service.models.answering import Answering, answering_of
from parser_service.serving.action_naming import names_of, store_names, version_of
from parser_service.serving.answering import choose_answering
from tests.annotations.exchange.packing import (
    everything_of,
    members_of,
    pack,
    pack_members,
    same_again,
)
from tests.doubted_labels import doubt, say
from tests.launched_campaigns import small_campaign
from tests.sample_world import make_paraphrase


def test_the_starter_world(db):
    load_starter_world(lambda sentence: None)
    again = same_again(World.objects.get(name=STARTER_WORLD))
    assert len(everything_of(again)["examples"]) > 1000


def test_the_generator_of_2018_with_the_published_pairs(db, shared_data):
    import_generator("gpsr2018", shared_data / "generator-2018")
    world = World.objects.get(name="gpsr2018")
    generate_pairs(world)
    import_pairs("gpsr2018", "walker", shared_data / "walker2019")
    again = same_again(world)
    assert again.commands.count() == 1211
    assert again.splits.count() == 2


def test_the_folder_of_a_competition(db, shared_data):
    import_competition("c25", shared_data / "competition-2025")
    again = same_again(World.objects.get(name="c25"))
    assert {"/" in each.source for each in again.ontology.entities.all()} == {True}


def test_a_world_without_anything(world):
    same_again(world)


def test_text_that_looks_like_an_escape_sequence(world):
    world.description = "\\u0000, \\\\u0000, \\ud800"
    world.save()
    same_again(world)


def test_drafts_and_disputed_templates_keep_status_version_and_author(tiny_world, annotator):
    first, second = tiny_world.grammar.templates.all()
    SemanticTemplate.objects.filter(pk=first.pk).update(
        status="draft", version=3, form="(unfinished"
    )
    SemanticTemplate.objects.filter(pk=second.pk).update(status="disputed", author=annotator)
    again = same_again(tiny_world)
    assert [row.author for row in again.grammar.templates.all()] == [None, annotator]


def test_utterances_keep_every_answer_with_its_time(tiny_world, annotator):
    collect(tiny_world, ["bring me tea", "hello"], by=annotator)
    first, second = tiny_world.utterances.all()
    label(first, Verdict.FORM, '(go "<room>")', annotator, 1, seconds=2.5)
    take_back_label(label(second, Verdict.UNKNOWN, "", annotator, 1), annotator)
    again = same_again(tiny_world)
    times = Label.objects.order_by("created_at").values_list("created_at", flat=True)
    assert len(times) == 4
    assert len(set(times)) == 2
    assert again.utterances.labelled().get().accepted_label.annotator == annotator


def test_the_queue_keeps_who_answers_what_and_what_follows(tiny_world, annotator, admin):
    collect(tiny_world, ["bring me tea", "hello"], by=annotator)
    set_share(tiny_world, WorkKind.UNLABELLED, 100)
    for person, form in ((annotator, '(go "<room>")'), (admin, '(go "<name>")')):
        part = next_item(person, tiny_world)
        row = label(part.item.utterance, Verdict.FORM, form, person, 1, is_blind=True)
        decision = finish(part, row)
    again = same_again(tiny_world)
    followed = again.work_items.get(kind=WorkKind.ADJUDICATION).follows
    assert followed.title == decision.item.title
    assert {each.label.annotator for each in followed.assignments.all()} == {annotator, admin}


def test_findings_of_an_audit_keep_their_reasons_and_decisions(tiny_world, annotator):
    rows = [say(tiny_world, "how many girls"), say(tiny_world, "count the girls")]
    store_findings(tiny_world, [doubt(row) for row in rows])
    decide(rows[0].audit_findings.get(), FindingStatus.CORRECTED, annotator, reason="girls")
    again = same_again(tiny_world)
    finding = again.audit_findings.decided().get()
    assert finding.paraphrase == again.paraphrases.first()
    assert (finding.decision.decided_by, finding.decision.reason) == (annotator, "girls")
    assert finding.reasons.count() == again.audit_findings.open().count() == 1


def test_the_names_of_actions_go_with_the_world(tiny_world, annotator):
    names = {"go": ActionName("NavigateTo", {"destination": "goal"})}
    store_names(tiny_world, names, annotator, version=0)
    again = same_again(tiny_world)
    assert names_of(again) == names and version_of(again) == 1
    assert again.action_names.changed_by == annotator
    moment = again.action_names.changed_at
    assert moment == tiny_world.action_names.changed_at


def test_the_choice_of_what_answers_goes_with_the_world(tiny_world, admin):
    choose_answering(tiny_world, "oracle", 0.1, admin, 0)
    Answering.objects.update(asks_language_model=True)
    row = answering_of(same_again(tiny_world))
    assert (row.order, row.allowed_wrong, row.changed_by) == ("oracle", 0.1, admin)
    assert row.asks_language_model


@pytest.mark.parametrize(
    "names",
    [
        [],
        {"go": "NavigateTo"},
        {"go": {"name": "NavigateTo"}},
        {"go": {"name": 3, "arguments": {}}},
        {"go": {"name": "Navigate to", "arguments": {}}},
        {"go": {"name": "NavigateTo", "arguments": {"destination": "name"}}},
        {"go": {"name": "NavigateTo", "arguments": {"destination": "x", "thing": "x"}}},
    ],
)
def test_names_that_no_robot_can_have_are_refused(names, tiny_world, annotator):
    store_names(tiny_world, {"go": ActionName("NavigateTo", {})}, annotator, version=0)
    members = members_of(pack(tiny_world))
    row = json.loads(members["rows/action_names.jsonl"])
    members["rows/action_names.jsonl"] = json.dumps({**row, "names": names}).encode() + b"\n"
    with pytest.raises(LanguageError, match=r"\bnames\b") as refused:
        import_world("again", pack_members(members))
    assert (refused.value.source, refused.value.line) == ("rows/action_names.jsonl", 1)


def test_an_archive_from_before_there_were_utterances(tiny_world):
    members = members_of(pack(tiny_world))
    manifest = json.loads(members["world.json"])
    later = ("utterances", "labels", "work_items", "assignments", "work_shares")
    for name in (
        *later,
        "audit_findings",
        "audit_reasons",
        "audit_decisions",
        "action_names",
        "answering",
    ):
        del members[f"rows/{name}.jsonl"], manifest["rows"][name]
    members["world.json"] = json.dumps(manifest).encode()
    import_world("again", pack_members(members))
    assert everything_of(World.objects.get(name="again")) == everything_of(tiny_world)


def test_a_row_of_an_account_that_is_not_here_has_none(tiny_world, annotator):
    tiny_world.grammar.templates.update(author=annotator)
    archive = pack(tiny_world)
    annotator.delete()
    import_world("again", archive)
    assert not SemanticTemplate.objects.filter(grammar__world__name="again", author__isnull=False)


def test_who_imports_is_the_admin_and_nobody_else_has_a_role(tiny_world, annotator, stranger):
    import_world("again", pack(tiny_world), by=stranger)
    again = World.objects.get(name="again")
    assert again.allows(stranger, Duty.MANAGE)
    assert again.memberships.count() == 1


def test_commands_stay_out_of_date(tiny_world):
    assert tiny_world.commands.count() == 0
    assert same_again(tiny_world).commands_are_stale


def test_every_model_below_a_world_is_in_the_archive(tiny_world):
    listed = {table.model for table in tables()}
    below = {model for model in models_below() if model._meta.app_label == "annotations"}
    assert below - listed == {Grammar, Ontology, Membership} | not_of_the_world()


def test_comments_stay_with_what_they_are_about(tiny_world, annotator):
    template = tiny_world.grammar.templates.last()
    entity = tiny_world.ontology.entities.first()
    add_comment(tiny_world, SUBJECTS["template"], template, "@anna why?", annotator)
    add_comment(tiny_world, SUBJECTS["entity"], entity, "gone", annotator)
    entity.delete()
    again = same_again(tiny_world)
    assert [each.subject for each in again.comments.all()] == [
        again.grammar.templates.last().pk,
        None,
    ]


def test_the_history_goes_with_the_archive_for_people_to_read(tiny_world, annotator):
    template = tiny_world.grammar.templates.first()
    change(template, {"pattern": "go"}, annotator, 1)
    delete(template, annotator, 2)
    same_again(tiny_world)
    lines = members_of(pack(tiny_world))["history/templates.jsonl"].decode().splitlines()
    said = [(each["what"], each["by"], each["pattern"]) for each in map(json.loads, lines)]
    assert said == [
        ("First known version", "", template.pattern),
        ("Changed", "anna", "go"),
        ("Deleted", "anna", "go"),
    ]


def models_below():
    pending, below = [World], set()
    while pending:
        for relation in pending.pop()._meta.related_objects:
            if relation.on_delete is models.CASCADE and relation.related_model not in below:
                below.add(relation.related_model)
                pending.append(relation.related_model)
    return below


def not_of_the_world():
    """What goes with a world and is no part of it: not written by people, or for one person alone."""
    names = ("Job", "Proposal", "CommandProposal", "Draft", "Notice", "Invitation", "Upload")
    return {model for model in apps.get_models() if model.__name__ in names}


def test_campaigns_with_all_that_came_in_have_another_link(world, admin):
    campaign = small_campaign(
        world,
        price="1.50",
        currency="EUR",
        completion_code="C0FFEE",
        created_by=admin,
        check_every=1,
    )
    campaign.prompts.create(
        prompt="write “yes”", shown="write “yes”", check_words="yes", position=3
    )
    contributor = begin(campaign, "f00d")
    for place in contributor.submissions.select_related("prompt"):
        answering.save_answer(
            place, place.prompt.shown if place.prompt else "x", 1.5, was_pasted=True
        )
    answering.finish(contributor, had_model_help=True)
    contributor.settings = {"name": "some model", "temperature": 0.7, "seed": None}
    contributor.save()
    accepted = make_paraphrase(
        world, grounded_form="( go )", logical_form="( go )", contributor=contributor
    )
    place = contributor.submissions.filter(kind="rewrite").first()
    place.paraphrase, place.decided_by, place.status = accepted, admin, "accepted"
    place.save()
    again = same_again(world)
    copy = again.campaigns.get()
    assert copy.key not in ("", campaign.key)
    assert copy.completion_code == ""
    (known,) = copy.contributors.all()
    assert known.submissions.exclude(flags=[]).count() > 1
    assert again.paraphrases.get().contributor == known


def test_an_archive_of_an_earlier_release_has_paraphrases_without_contributors(world):
    make_paraphrase(world, grounded_form="( go )", logical_form="( go )")
    members = members_of(pack(world))
    row = json.loads(members["rows/paraphrases.jsonl"])
    del row["contributor"]
    members["rows/paraphrases.jsonl"] = json.dumps(row).encode() + b"\n"
    manifest = json.loads(members["world.json"])
    for name in ("campaigns", "campaign_prompts", "contributors", "submissions"):
        del members[f"rows/{name}.jsonl"], manifest["rows"][name]
    members["world.json"] = json.dumps(manifest).encode()
    import_world("again", pack_members(members))
    assert World.objects.get(name="again").paraphrases.count() == 1


def test_who_does_not_review_gets_what_was_accepted_and_who_of_it_is_a_model(
    world, admin, reviewer, annotator
):
    campaign = small_campaign(world, price="1.50", name="with a model")
    small_campaign(world, name="another one")
    person = begin(campaign, "f00d")
    answering.save_answer(person.submissions.get(position=1), "pending words of a person")
    settings = ModelSettings("some model", "{command}")
    model = model_contributor(campaign, settings)
    store_rewrites(model, campaign.prompts.first(), "raw words", ["rejected words"])
    for contributor in (person, model):
        make_paraphrase(
            world,
            grounded_form="( go )",
            logical_form="( go )",
            contributor=contributor,
            utterance=f"accepted words of a {contributor.kind}",
        )
    archives = {
        each: members_of(io.BytesIO(b"".join(world_archive(world, each))))
        for each in (None, admin, reviewer, annotator)
    }

    def lines(reader, name: str) -> list[dict[str, Any]]:
        return [json.loads(line) for line in archives[reader][f"rows/{name}.jsonl"].splitlines()]

    for reader in (None, admin, reviewer):
        assert len(lines(reader, "campaigns")) == 2
        assert [row["kind"] for row in lines(reader, "contributors")] == ["person", "model"]
        assert len(lines(reader, "submissions")) == 4
        assert [row["contributor"] for row in lines(reader, "paraphrases")] == [0, 1]
    assert [row["kind"] for row in lines(annotator, "contributors")] == ["model"]
    assert [row["contributor"] for row in lines(annotator, "paraphrases")] == [None, 0]
    assert not lines(annotator, "submissions") and not lines(annotator, "campaign_prompts")
    assert [row["name"] for row in lines(annotator, "campaigns")] == ["with a model"]
    everything = b"".join(archives[annotator].values())
    for words in (b"f00d", b"pending words", b"rejected words", b"raw words"):
        assert words not in everything
    import_world("again", pack_members(archives[annotator]))
    again = World.objects.get(name="again")
    assert sorted(row.is_by_model for row in again.paraphrases.all()) == [False, True]


def test_recipes_go_with_the_world(db, world, annotator):
    row = world.recipes.get(left="go(destination)")
    change(row, Recipe.columns_of('go(destination) -> say("no")'), annotator, row.version)
    again = same_again(world)
    assert recipe_book_of(again) == recipe_book_of(world)
    assert again.recipes.get(left=row.left).version == 2
