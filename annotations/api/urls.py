"""Routes below ``/api/v1/``."""

from __future__ import annotations

from django.urls import include, path

from annotations.api.corpus import (
    commands,
    exports,
    figures,
    labels,
    paraphrases,
    splits,
    utterances,
)
from annotations.api.description import (
    checks,
    entities,
    history,
    predicates,
    productions,
    templates,
)
from annotations.api.jobs import imports, jobs
from annotations.api.people import accounts, members, notices, tokens
from annotations.api.queueing import audit, comments, giving, sending, work_items
from annotations.api.queueing import figures as queue_figures
from annotations.api.schema_view import SchemaFile
from annotations.api.worlds import OneWorld, Worlds

app_name = "api"

description = [
    path("entities/", entities.Entities.as_view(), name="entities"),
    path("entities/<int:pk>/", entities.OneEntity.as_view(), name="entity"),
    path("predicates/", predicates.Predicates.as_view(), name="predicates"),
    path("predicates/<int:pk>/", predicates.OnePredicate.as_view(), name="predicate"),
    path("task-categories/", productions.TaskCategories.as_view(), name="task-categories"),
    path("productions/", productions.Productions.as_view(), name="productions"),
    path("productions/<int:pk>/", productions.OneProduction.as_view(), name="production"),
    path("templates/", templates.Templates.as_view(), name="templates"),
    path("templates/<int:pk>/", templates.OneTemplate.as_view(), name="template"),
    path("history/<slug:kind>/<int:pk>/", history.History.as_view(), name="history"),
    path("deleted/<slug:kind>/", history.Deleted.as_view(), name="deleted"),
    path("rename/<slug:kind>/<int:pk>/", history.Rename.as_view(), name="rename"),
    path("check/template/", checks.CheckTemplate.as_view(), name="check-template"),
    path("check/production/", checks.CheckProduction.as_view(), name="check-production"),
    path("check/predicate/", checks.CheckPredicate.as_view(), name="check-predicate"),
    path("check/form/", checks.CheckForm.as_view(), name="check-form"),
]

work = [
    path("import/", imports.ImportGenerator.as_view(), name="import"),
    path("import/pairs/", imports.ImportPairs.as_view(), name="import-pairs"),
    path("generate/", imports.Generate.as_view(), name="generate"),
    path("download/", imports.Archive.as_view(), name="download"),
    path("download/<slug:part>/", imports.ArchivePart.as_view(), name="download-part"),
    path("jobs/", jobs.Jobs.as_view(), name="jobs"),
    path("jobs/<int:pk>/", jobs.OneJob.as_view(), name="job"),
    path("jobs/<int:pk>/cancel/", jobs.CancelJob.as_view(), name="job-cancel"),
    path("jobs/<int:pk>/answer/", jobs.AnswerJob.as_view(), name="job-answer"),
]

corpus = [
    path("commands/", commands.Commands.as_view(), name="commands"),
    path("commands/<int:pk>/", commands.OneCommand.as_view(), name="command"),
    path("forms/", commands.LogicalForms.as_view(), name="forms"),
    path("forms/<int:pk>/", commands.OneLogicalForm.as_view(), name="form"),
    path("paraphrases/", paraphrases.Paraphrases.as_view(), name="paraphrases"),
    path("paraphrases/<int:pk>/", paraphrases.OneParaphrase.as_view(), name="paraphrase"),
    path("utterances/", utterances.Utterances.as_view(), name="utterances"),
    path("utterances/<int:pk>/", utterances.OneUtterance.as_view(), name="utterance"),
    path("utterances/<int:pk>/label/", labels.LabelUtterance.as_view(), name="utterance-label"),
    path("utterances/<int:pk>/spans/", labels.MendUtterance.as_view(), name="utterance-spans"),
    path("labels/", labels.Labels.as_view(), name="labels"),
    path("labels/<int:pk>/take-back/", labels.TakeLabelBack.as_view(), name="label-take-back"),
    path("splits/", splits.Splits.as_view(), name="splits"),
    path("splits/<int:pk>/", splits.OneSplit.as_view(), name="split"),
    path("splits/<int:pk>/renew/", splits.RenewSplit.as_view(), name="split-renew"),
    path("splits/<int:pk>/examples/", splits.Examples.as_view(), name="split-examples"),
    path("splits/<int:pk>/manifest/", exports.SplitManifest.as_view(), name="split-manifest"),
    path("splits/<int:pk>/export/", exports.SplitExport.as_view(), name="split-export"),
]

figures_of_corpus = [
    path("complexity/", figures.ComplexityOfWorld.as_view(), name="complexity"),
    path("uncovered/", figures.Uncovered.as_view(), name="uncovered"),
    path("conflicts/", figures.Conflicts.as_view(), name="conflicts"),
    path(
        "splits/<int:pk>/near-duplicates/",
        figures.NearDuplicatesOfSplit.as_view(),
        name="near-duplicates",
    ),
    path("splits/<int:pk>/changes/", figures.ChangesOfSplit.as_view(), name="split-changes"),
    path("agreement/", queue_figures.AgreementOfWorld.as_view(), name="agreement"),
    path("progress/", queue_figures.ProgressOfWorld.as_view(), name="progress"),
]

queueing = [
    path("comments/<slug:kind>/<int:pk>/", comments.Comments.as_view(), name="comments"),
    path("comments/<int:pk>/", comments.OneComment.as_view(), name="comment"),
    path("comments/<int:pk>/restore/", comments.RestoreComment.as_view(), name="comment-restore"),
    path("audit-findings/", audit.AuditFindings.as_view(), name="audit-findings"),
    path("audit-findings/<int:pk>/", audit.OneAuditFinding.as_view(), name="audit-finding"),
    path(
        "audit-findings/<int:pk>/decide/", audit.DecideAuditFinding.as_view(), name="audit-decide"
    ),
    path(
        "audit-decisions/<int:pk>/take-back/",
        audit.TakeBackDecision.as_view(),
        name="audit-take-back",
    ),
    path("queue-settings/", giving.QueueSettings.as_view(), name="queue-settings"),
    path("work-items/", work_items.WorkItems.as_view(), name="work-items"),
    path("work-items/assign/", giving.AssignWorkItems.as_view(), name="work-items-assign"),
    path("work-items/next/", work_items.NextWorkItem.as_view(), name="work-item-next"),
    path("work-items/<int:pk>/", work_items.OneWorkItem.as_view(), name="work-item"),
    path(
        "work-items/<int:pk>/finish/", work_items.FinishWorkItem.as_view(), name="work-item-finish"
    ),
    path(
        "work-items/<int:pk>/give-back/",
        work_items.GiveBackWorkItem.as_view(),
        name="work-item-give-back",
    ),
    path("work-items/<int:pk>/take/", giving.TakeWorkItem.as_view(), name="work-item-take"),
    path("work-items/<int:pk>/skip/", work_items.SkipWorkItem.as_view(), name="work-item-skip"),
    path("work-items/<int:pk>/assign/", giving.AssignWorkItem.as_view(), name="work-item-assign"),
    path(
        "work-items/<int:pk>/withdraw/",
        giving.WithdrawWorkItem.as_view(),
        name="work-item-withdraw",
    ),
    path(
        "splits/<int:split>/examples/<int:pk>/send/",
        sending.SendExample.as_view(),
        name="example-send",
    ),
]

people = [
    path("members/", members.Members.as_view(), name="members"),
    path("members/<int:pk>/", members.OneMember.as_view(), name="member"),
    path("invitations/", members.Invitations.as_view(), name="invitations"),
    path("invitations/<int:pk>/", members.OneInvitation.as_view(), name="invitation"),
    path("audit-log/", accounts.AuditLog.as_view(), name="audit-log"),
]

account = [
    path("join/", members.Join.as_view(), name="join"),
    path("tokens/", tokens.Tokens.as_view(), name="tokens"),
    path("tokens/<int:pk>/", tokens.OneToken.as_view(), name="token"),
    path("sessions/", tokens.Sessions.as_view(), name="sessions"),
    path("sessions/end/", tokens.EndSessions.as_view(), name="sessions-end"),
    path("sessions/<slug:handle>/", tokens.OneSession.as_view(), name="session"),
    path("notices/", notices.Notices.as_view(), name="notices"),
    path("notices/read/", notices.ReadNotices.as_view(), name="notices-read"),
    path("notices/<int:pk>/read/", notices.ReadNotice.as_view(), name="notice-read"),
]

site = [
    path("accounts/", accounts.Accounts.as_view(), name="accounts"),
    path("accounts/<int:pk>/", accounts.OneAccount.as_view(), name="account"),
    path("accounts/<int:pk>/link/", accounts.AccountLink.as_view(), name="account-link"),
    path("audit-log/", accounts.SiteLog.as_view(), name="site-log"),
    path("import-world/", imports.ImportWorld.as_view(), name="import-world"),
    path("jobs/<int:pk>/", jobs.OneSiteJob.as_view(), name="site-job"),
    path("jobs/<int:pk>/cancel/", jobs.CancelSiteJob.as_view(), name="site-job-cancel"),
]

urlpatterns = [
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
