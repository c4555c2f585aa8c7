"""The pages of what people write. All lie under ``/w/<world>/``."""

from django.urls import path

from annotations.web.background import job_pages
from annotations.web.campaigns import submission_pages
from annotations.web.corpus import command_pages, paraphrase_pages, upload_pages, utterance_pages
from annotations.web.description import (
    coverage_pages,
    entity_pages,
    guidelines_pages,
    predicate_pages,
    production_pages,
    template_pages,
    template_repair_pages,
)
from annotations.web.editing import (
    comment_pages,
    deletion_pages,
    draft_pages,
    history_pages,
    rename_pages,
)
from annotations.web.people import audit_log_pages, member_pages
from annotations.web.queueing import agreement_pages, sending_pages, work_item_pages
from annotations.web.splits import split_pages
from annotations.web.worlds import import_pages, world_pages

urlpatterns = [
    path("people/", member_pages.people, name="people"),
    path("people/<int:pk>/", member_pages.member, name="member"),
    path("log/", audit_log_pages.audit_log, name="audit_log"),
    path("people/invite/", member_pages.invite, name="invite"),
    path(
        "people/invitations/<int:pk>/withdraw/", member_pages.withdraw, name="invitation_withdraw"
    ),
    path("delete/", world_pages.world_delete, name="world_delete"),
    path("import/", import_pages.import_files, name="import"),
    path("import/pairs/", import_pages.import_pair_files, name="import_pairs"),
    path("history/<slug:kind>/<int:pk>/", history_pages.history, name="history"),
    path("history/<slug:kind>/<int:pk>/delete/", deletion_pages.delete_row, name="delete_row"),
    path("history/<slug:kind>/deleted/", history_pages.deleted, name="deleted"),
    path("rename/<slug:kind>/<int:pk>/", rename_pages.rename_row, name="rename"),
    path("comments/<slug:kind>/<int:pk>/", comment_pages.comments, name="comments"),
    path("comments/<int:pk>/", comment_pages.comment, name="comment"),
    path("comments/<int:pk>/delete/", comment_pages.comment_delete, name="comment_delete"),
    path("comments/<int:pk>/restore/", comment_pages.comment_restore, name="comment_restore"),
    path("drafts/<slug:kind>/<slug:subject>/", draft_pages.draft, name="draft"),
    path("jobs/", job_pages.jobs, name="jobs"),
    path("download/", world_pages.download, name="download"),
    path("download/<slug:part>/", world_pages.download_part, name="download_part"),
    path("generate/", import_pages.generate, name="generate"),
    path("ontology/", entity_pages.ontology, name="ontology"),
    path("ontology/new/", entity_pages.entity_new, name="entity_new"),
    path("ontology/paste/", entity_pages.entities_new, name="entities_new"),
    path("ontology/<int:pk>/", entity_pages.entity, name="entity"),
    path("predicates/new/", predicate_pages.predicate_new, name="predicate_new"),
    path("predicates/preview/", predicate_pages.predicate_preview, name="predicate_preview"),
    path("predicates/<int:pk>/", predicate_pages.predicate, name="predicate"),
    path("predicates/", predicate_pages.predicates, name="predicates"),
    path("grammar/", production_pages.grammar, name="grammar"),
    path("grammar/new/", production_pages.production_new, name="production_new"),
    path("grammar/check/", production_pages.production_check, name="production_check"),
    path("grammar/preview/", production_pages.production_preview, name="production_preview"),
    path("grammar/<int:pk>/", production_pages.production, name="production"),
    path("grammar/coverage/", coverage_pages.coverage, name="coverage"),
    path("coverage/", coverage_pages.uncovered, name="uncovered"),
    path("coverage/unmatched/", template_repair_pages.unmatched, name="unmatched"),
    path("coverage/conflicts/", template_repair_pages.conflicts, name="conflicts"),
    path("coverage/outside/", template_repair_pages.outside_grammar, name="outside_grammar"),
    path(
        "coverage/repair/<int:pk>/", template_repair_pages.template_repair, name="template_repair"
    ),
    path("templates/", template_pages.templates, name="templates"),
    path("templates/new/", template_pages.template_new, name="template_new"),
    path("templates/check/", template_pages.template_check, name="template_check"),
    path(
        "templates/completion/<int:pk>/",
        template_pages.template_completion,
        name="template_completion",
    ),
    path("templates/preview/", template_pages.template_preview, name="template_preview"),
    path(
        "templates/consequences/",
        template_pages.template_consequences,
        name="template_consequences",
    ),
    path("templates/<int:pk>/", template_pages.template, name="template"),
    path(
        "templates/<int:pk>/duplicate/",
        template_pages.template_duplicate,
        name="template_duplicate",
    ),
    path("commands/", command_pages.commands, name="commands"),
    path("commands/<int:pk>/", command_pages.command, name="command"),
    path("commands/complexity/", command_pages.complexity, name="complexity"),
    path("forms/", command_pages.logical_forms, name="logical_forms"),
    path("forms/<int:pk>/", command_pages.logical_form, name="logical_form"),
    path("paraphrases/", paraphrase_pages.paraphrases, name="paraphrases"),
    path("paraphrases/<int:pk>/", paraphrase_pages.paraphrase, name="paraphrase"),
    path("paraphrases/<int:pk>/label/", paraphrase_pages.paraphrase_label, name="paraphrase_label"),
    path("paraphrases/<int:pk>/check/", paraphrase_pages.paraphrase_check, name="paraphrase_check"),
    path("utterances/", utterance_pages.utterances, name="utterances"),
    path("utterances/new/", utterance_pages.utterances_new, name="utterances_new"),
    path("utterances/delete/", utterance_pages.utterances_delete, name="utterances_delete"),
    path("utterances/restore/", utterance_pages.utterances_restore, name="utterances_restore"),
    path("utterances/uploads/", upload_pages.uploads, name="uploads"),
    path("utterances/uploads/<int:pk>/", upload_pages.upload, name="upload"),
    path("utterances/uploads/<int:pk>/undo/", upload_pages.upload_undo, name="upload_undo"),
    path("utterances/uploads/<int:pk>/redo/", upload_pages.upload_redo, name="upload_redo"),
    path("utterances/<int:pk>/", utterance_pages.utterance, name="utterance"),
    path("queue/", work_item_pages.queue, name="queue"),
    path("queue/next/", work_item_pages.queue_next, name="queue_next"),
    path("queue/assign/", work_item_pages.queue_assign, name="queue_assign"),
    path("queue/agreement/", agreement_pages.agreement, name="agreement"),
    path("queue/progress/", agreement_pages.progress, name="progress"),
    path("guidelines/", guidelines_pages.guidelines, name="guidelines"),
    path("guidelines/preview/", guidelines_pages.guidelines_preview, name="guidelines_preview"),
    path("queue/settings/", work_item_pages.queue_settings, name="queue_settings"),
    path("queue/ask/<slug:kind>/<int:pk>/", work_item_pages.queue_ask, name="queue_ask"),
    path("queue/<int:pk>/", work_item_pages.queue_item, name="queue_item"),
    path("queue/<int:pk>/act/", work_item_pages.queue_act, name="queue_act"),
    path("queue/<int:pk>/settle/", work_item_pages.queue_settle, name="queue_settle"),
    path("splits/", split_pages.splits, name="splits"),
    path("splits/new/", split_pages.split_new, name="split_new"),
    path("splits/<int:pk>/", split_pages.split, name="split"),
    path("splits/<int:split>/examples/<int:pk>/", split_pages.example, name="example"),
    path(
        "splits/<int:split>/examples/<int:pk>/send/",
        sending_pages.example_send,
        name="example_send",
    ),
    path("splits/<int:pk>/changes/", split_pages.split_changes, name="split_changes"),
    path("splits/<int:pk>/renew/", split_pages.split_renew, name="split_renew"),
    path("splits/<int:pk>/near/", split_pages.near_duplicates, name="near_duplicates"),
    path("submissions/", submission_pages.submissions, name="submissions"),
    path("submissions/decide/", submission_pages.submissions_decide, name="submissions_decide"),
    path(
        "submissions/take-back/",
        submission_pages.submissions_take_back,
        name="submissions_take_back",
    ),
    path("submissions/<int:pk>/", submission_pages.submission, name="submission"),
    path(
        "submissions/<int:pk>/decide/", submission_pages.submission_decide, name="submission_decide"
    ),
]
