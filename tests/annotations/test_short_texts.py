"""Each text fits its column: what the program makes is cut there, and everything else has who bounds it."""

from __future__ import annotations

import pytest
from django.apps import apps
from django.db import models

from annotations.models.short_texts import ShortTextField
from gpsr_site.backup.backup_tables import tables
from tests.gpsr_site.backup.limits import fill_every_column

# Who bounds a text that is not cut by its column, by the end of the column's name.
TYPED = "people type it, and the form or the route refuses what is too long"
NAMED = "a name of the world, bounded where files and people bring it (annotations/language/texts/limits.py)"
FIXED = "a word, a key or a hash of a fixed length that the program makes"
BOUNDED = {
    **dict.fromkeys(
        (
            *("User.username", "User.first_name", "User.last_name", "User.email", "ApiToken.name"),
            *("Invitation.note", "Campaign.name", "Campaign.currency", "Campaign.completion_code"),
            *("Campaign.run_by", "Campaign.contact", "Campaign.frame_origins"),
            *("Campaign.worker_parameter", "Campaign.assignment_parameter"),
            *("Campaign.screening_question", "Campaign.screened_out_code"),
            *(
                "Campaign.screened_out_url",
                "Campaign.return_url",
                "Primitive.text",
                "Recipe.text",
                "Label.reason",
                "Slice.name",
            ),
            *("AuditDecision.reason", "Split.name", "Utterance.text", "Dialogue.utterance"),
            *("OfferedEntity.text", "OfferedEntity.alias", "OfferedEntity.said_in"),
            *("ErrorCategory.code", "ErrorCategory.name", "ErrorCategory.description"),
            *("Draft.device", "Draft.page", "EntityClass.singular", "EntityClass.plural"),
            *("EntityClass.said", "World.name", "Predicate.gloss", "Upload.file_name"),
        ),
        TYPED,
    ),
    **dict.fromkeys(
        (
            *("EntityClass.token", "Primitive.name", "Recipe.action", "Recipe.left"),
            *(
                "Predicate.name",
                "TaskCategory.name",
                "Production.nonterminal",
                "CommandProposal.command",
            ),
            *("AuditEntry.world_name", "AuditEntry.who_name", "Job.world_name"),
            *(f"{name}.task_category" for name in ("CampaignPrompt", "Production", "Command")),
            *(f"{name}.task_category" for name in ("SemanticTemplate", "LogicalForm", "Example")),
            *(f"{name}.head_predicate" for name in ("LogicalForm", "Example")),
            *(
                f"{name}.source"
                for name in ("Entity", "Production", "SemanticTemplate", "StoredProblem")
            ),
            *(f"{name}.entity_class" for name in ("Entity", "OfferedEntity")),
        ),
        NAMED,
    ),
    **dict.fromkeys(
        (
            *("User.password", "ApiToken.digest", "LogInSession.session_key", "Invitation.digest"),
            *("Campaign.key", "CampaignPrompt.check_words", "Contributor.pseudonym", "Draft.kind"),
            *("Draft.subject", "Comment.kind", "StoredProblem.severity", "Upload.format"),
            *("Proposal.source", "CommandProposal.source", "Split.content_hash", "Probe.kind"),
            *("TrainingRun.parser", "TrainingRun.train_sources", "TrainingRun.content_key"),
            *("Checkpoint.folder", "Checkpoint.sha256", "AnswererEvaluation.test_source"),
            "Submission.browser",
            *("Dialogue.phase", "Evaluation.test_source", "Evaluation.part", "Prediction.origin"),
            "Worker.queue",
        ),
        FIXED,
    ),
}
TEXTS = {
    f"{model.__name__}.{field.name}": field
    for app in ("annotations", "parser_service")
    for model in apps.get_app_config(app).get_models()
    for field in model._meta.concrete_fields
    if isinstance(field, models.CharField) and not field.choices
    if not hasattr(model, "history_object")  # a history copies its rows
}


def test_each_text_is_cut_by_its_column_or_has_who_bounds_it():
    cut = {name for name, field in TEXTS.items() if isinstance(field, ShortTextField)}
    assert cut.isdisjoint(BOUNDED) and len(cut) > 10
    assert TEXTS.keys() - cut == BOUNDED.keys()


@pytest.mark.services
def test_what_the_program_writes_is_cut_however_it_is_written(db):
    fill_every_column()
    in_backups = {table.model for table in tables()}
    for name, field in TEXTS.items():
        if field.model not in in_backups or not isinstance(field, ShortTextField):
            continue
        long = f"{name} ä" * 1_000
        rows = field.model._base_manager
        row = rows.get(pk=3)
        rows.filter(pk=1).update(**{field.name: long + "1"})
        assert rows.filter(**{f"{field.name}": long + "1"}).exists(), name
        rows.filter(pk=1).update(**{field.name: "1"})
        setattr(row, field.name, long)
        rows.bulk_update([row], [field.name])
        assert rows.values_list(field.name, flat=True).get(pk=3) == long[: field.max_length], name
        row.save()
