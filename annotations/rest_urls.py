"""Routes below ``/api/v1/``."""

from __future__ import annotations

from django.urls import URLPattern, URLResolver, include, path

from annotations.web.background import job_rest
from annotations.web.corpus import (
    command_rest,
    label_rest,
    paraphrase_rest,
    upload_rest,
    utterance_rest,
)
from annotations.web.description import (
    check_rest,
    coverage_rest,
    entity_rest,
    guidelines_rest,
    predicate_rest,
    production_rest,
    template_rest,
)
from annotations.web.editing import comment_rest, history_rest, notice_rest
from annotations.web.people import account_rest, member_rest, token_rest
from annotations.web.queueing import agreement_rest as queue_figures
from annotations.web.queueing import assignment_rest, audit_rest, sending_rest, work_item_rest
from annotations.web.rest.schema_view import SchemaFile
from annotations.web.splits import export_rest, split_rest
from annotations.web.worlds import import_rest
from annotations.web.worlds.world_rest import OneWorld, Worlds

app_name = "api"

description = [
    path("entities/", entity_rest.Entities.as_view(), name="entities"),
    path("entities/<int:pk>/", entity_rest.OneEntity.as_view(), name="entity"),
    path("predicates/", predicate_rest.Predicates.as_view(), name="predicates"),
    path("predicates/<int:pk>/", predicate_rest.OnePredicate.as_view(), name="predicate"),
    path("task-categories/", production_rest.TaskCategories.as_view(), name="task-categories"),
    path("productions/", production_rest.Productions.as_view(), name="productions"),
    path("productions/<int:pk>/", production_rest.OneProduction.as_view(), name="production"),
    path("templates/", template_rest.Templates.as_view(), name="templates"),
    path("templates/<int:pk>/", template_rest.OneTemplate.as_view(), name="template"),
    path("history/<slug:kind>/<int:pk>/", history_rest.HistoryOfRow.as_view(), name="history"),
    path("deleted/<slug:kind>/", history_rest.Deleted.as_view(), name="deleted"),
    path("rename/<slug:kind>/<int:pk>/", history_rest.Rename.as_view(), name="rename"),
    path("check/template/", check_rest.CheckTemplate.as_view(), name="check-template"),
    path("check/production/", check_rest.CheckProduction.as_view(), name="check-production"),
    path("check/predicate/", check_rest.CheckPredicate.as_view(), name="check-predicate"),
    path("check/form/", check_rest.CheckForm.as_view(), name="check-form"),
]

work = [
    path("import/", import_rest.ImportGenerator.as_view(), name="import"),
    path("import/pairs/", import_rest.ImportPairs.as_view(), name="import-pairs"),
    path("generate/", import_rest.Generate.as_view(), name="generate"),
    path("download/", import_rest.Archive.as_view(), name="download"),
    path("download/<slug:part>/", import_rest.ArchivePart.as_view(), name="download-part"),
    path("jobs/", job_rest.Jobs.as_view(), name="jobs"),
    path("jobs/<int:pk>/", job_rest.OneJob.as_view(), name="job"),
    path("jobs/<int:pk>/cancel/", job_rest.CancelJob.as_view(), name="job-cancel"),
    path("jobs/<int:pk>/result/", job_rest.ResultOfJob.as_view(), name="job-result"),
    path("jobs/<int:pk>/answer/", job_rest.AnswerJob.as_view(), name="job-answer"),
]

corpus = [
    path("commands/", command_rest.Commands.as_view(), name="commands"),
    path("commands/<int:pk>/", command_rest.OneCommand.as_view(), name="command"),
    path("forms/", command_rest.LogicalForms.as_view(), name="forms"),
    path("forms/<int:pk>/", command_rest.OneLogicalForm.as_view(), name="form"),
    path("paraphrases/", paraphrase_rest.Paraphrases.as_view(), name="paraphrases"),
    path("paraphrases/<int:pk>/", paraphrase_rest.OneParaphrase.as_view(), name="paraphrase"),
    path("utterances/", utterance_rest.Utterances.as_view(), name="utterances"),
    path("utterances/export/", utterance_rest.ExportUtterances.as_view(), name="utterances-export"),
    path("utterances/<int:pk>/", utterance_rest.OneUtterance.as_view(), name="utterance"),
    path("utterances/<int:pk>/label/", label_rest.LabelUtterance.as_view(), name="utterance-label"),
    path("utterances/<int:pk>/spans/", label_rest.MendUtterance.as_view(), name="utterance-spans"),
    path("uploads/", upload_rest.Uploads.as_view(), name="uploads"),
    path("uploads/<int:pk>/", upload_rest.OneUpload.as_view(), name="upload"),
    path("uploads/<int:pk>/undo/", upload_rest.UndoUpload.as_view(), name="upload-undo"),
    path("uploads/<int:pk>/redo/", upload_rest.RedoUpload.as_view(), name="upload-redo"),
    path("labels/", label_rest.OwnLabels.as_view(), name="labels"),
    path("labels/<int:pk>/take-back/", label_rest.TakeLabelBack.as_view(), name="label-take-back"),
    path("splits/", split_rest.Splits.as_view(), name="splits"),
    path("splits/<int:pk>/", split_rest.OneSplit.as_view(), name="split"),
    path("splits/<int:pk>/renew/", split_rest.RenewSplit.as_view(), name="split-renew"),
    path("splits/<int:pk>/examples/", split_rest.ExamplesOfSplit.as_view(), name="split-examples"),
    path("splits/<int:pk>/manifest/", export_rest.SplitManifest.as_view(), name="split-manifest"),
    path("splits/<int:pk>/export/", export_rest.SplitExport.as_view(), name="split-export"),
]

figures_of_corpus = [
    path("complexity/", command_rest.ComplexityOfWorld.as_view(), name="complexity"),
    path("uncovered/", coverage_rest.Uncovered.as_view(), name="uncovered"),
    path("conflicts/", coverage_rest.Conflicts.as_view(), name="conflicts"),
    path(
        "splits/<int:pk>/near-duplicates/",
        split_rest.NearDuplicatesOfSplit.as_view(),
        name="near-duplicates",
    ),
    path("splits/<int:pk>/changes/", split_rest.ChangesOfSplit.as_view(), name="split-changes"),
    path("agreement/", queue_figures.AgreementOfWorld.as_view(), name="agreement"),
    path("progress/", queue_figures.ProgressOfWorld.as_view(), name="progress"),
]

queueing = [
    path("comments/<slug:kind>/<int:pk>/", comment_rest.Comments.as_view(), name="comments"),
    path("comments/<int:pk>/", comment_rest.OneComment.as_view(), name="comment"),
    path(
        "comments/<int:pk>/restore/", comment_rest.RestoreComment.as_view(), name="comment-restore"
    ),
    path("audit-findings/", audit_rest.AuditFindings.as_view(), name="audit-findings"),
    path("audit-findings/<int:pk>/", audit_rest.OneAuditFinding.as_view(), name="audit-finding"),
    path(
        "audit-findings/<int:pk>/decide/",
        audit_rest.DecideAuditFinding.as_view(),
        name="audit-decide",
    ),
    path(
        "audit-decisions/<int:pk>/take-back/",
        audit_rest.TakeBackDecision.as_view(),
        name="audit-take-back",
    ),
    path("guidelines/", guidelines_rest.OneGuidelines.as_view(), name="guidelines"),
    path("queue-settings/", assignment_rest.QueueSettings.as_view(), name="queue-settings"),
    path("work-items/", work_item_rest.WorkItems.as_view(), name="work-items"),
    path("work-items/assign/", assignment_rest.AssignWorkItems.as_view(), name="work-items-assign"),
    path("work-items/next/", work_item_rest.NextWorkItem.as_view(), name="work-item-next"),
    path("work-items/<int:pk>/", work_item_rest.OneWorkItem.as_view(), name="work-item"),
    path(
        "work-items/<int:pk>/finish/",
        work_item_rest.FinishWorkItem.as_view(),
        name="work-item-finish",
    ),
    path(
        "work-items/<int:pk>/give-back/",
        work_item_rest.GiveBackWorkItem.as_view(),
        name="work-item-give-back",
    ),
    path(
        "work-items/<int:pk>/take/", assignment_rest.TakeWorkItem.as_view(), name="work-item-take"
    ),
    path("work-items/<int:pk>/skip/", work_item_rest.SkipWorkItem.as_view(), name="work-item-skip"),
    path(
        "work-items/<int:pk>/assign/",
        assignment_rest.AssignWorkItem.as_view(),
        name="work-item-assign",
    ),
    path(
        "work-items/<int:pk>/withdraw/",
        assignment_rest.WithdrawWorkItem.as_view(),
        name="work-item-withdraw",
    ),
    path(
        "splits/<int:split>/examples/<int:pk>/send/",
        sending_rest.SendExample.as_view(),
        name="example-send",
    ),
]

people = [
    path("members/", member_rest.Members.as_view(), name="members"),
    path("members/<int:pk>/", member_rest.OneMember.as_view(), name="member"),
    path("invitations/", member_rest.Invitations.as_view(), name="invitations"),
    path("invitations/<int:pk>/", member_rest.OneInvitation.as_view(), name="invitation"),
    path("audit-log/", account_rest.AuditLogOfWorld.as_view(), name="audit-log"),
]

account = [
    path("join/", member_rest.Join.as_view(), name="join"),
    path("tokens/", token_rest.Tokens.as_view(), name="tokens"),
    path("tokens/<int:pk>/", token_rest.OneToken.as_view(), name="token"),
    path("sessions/", token_rest.Sessions.as_view(), name="sessions"),
    path("sessions/end/", token_rest.EndSessions.as_view(), name="sessions-end"),
    path("sessions/<slug:handle>/", token_rest.OneSession.as_view(), name="session"),
    path("notices/", notice_rest.Notices.as_view(), name="notices"),
    path("notices/read/", notice_rest.ReadNotices.as_view(), name="notices-read"),
    path("notices/<int:pk>/read/", notice_rest.ReadNotice.as_view(), name="notice-read"),
]

site = [
    path("accounts/", account_rest.Accounts.as_view(), name="accounts"),
    path("accounts/<int:pk>/", account_rest.OneAccount.as_view(), name="account"),
    path("accounts/<int:pk>/link/", account_rest.AccountLink.as_view(), name="account-link"),
    path("audit-log/", account_rest.SiteLog.as_view(), name="site-log"),
    path("import-world/", import_rest.ImportWorld.as_view(), name="import-world"),
    path("jobs/<int:pk>/", job_rest.OneSiteJob.as_view(), name="site-job"),
    path("jobs/<int:pk>/cancel/", job_rest.CancelSiteJob.as_view(), name="site-job-cancel"),
]

urlpatterns: list[URLPattern | URLResolver] = [
    path("schema/", SchemaFile.as_view(), name="schema"),
    path("worlds/", Worlds.as_view(), name="worlds"),
    path("worlds/<slug:world>/", OneWorld.as_view(), name="world"),
    path(
        "worlds/<slug:world>/",
        include([*description, *work, *corpus, *figures_of_corpus, *queueing, *people]),
    ),
    *account,
    *site,
]
