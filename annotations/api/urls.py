"""Routes below ``/api/v1/``."""

from __future__ import annotations

from django.urls import include, path
from drf_spectacular.views import SpectacularAPIView
from rest_framework.permissions import AllowAny

from annotations.api.corpus import commands, exports, paraphrases, splits, utterances
from annotations.api.description import entities, history, predicates, productions, templates
from annotations.api.jobs import imports, jobs
from annotations.api.queueing import audit, comments, work_items
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
]

work = [
    path("import/", imports.ImportGenerator.as_view(), name="import"),
    path("import/pairs/", imports.ImportPairs.as_view(), name="import-pairs"),
    path("generate/", imports.Generate.as_view(), name="generate"),
    path("download/", imports.Archive.as_view(), name="download"),
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
    path("splits/", splits.Splits.as_view(), name="splits"),
    path("splits/<int:pk>/", splits.OneSplit.as_view(), name="split"),
    path("splits/<int:pk>/renew/", splits.RenewSplit.as_view(), name="split-renew"),
    path("splits/<int:pk>/examples/", splits.Examples.as_view(), name="split-examples"),
    path("splits/<int:pk>/manifest/", exports.SplitManifest.as_view(), name="split-manifest"),
    path("splits/<int:pk>/export/", exports.SplitExport.as_view(), name="split-export"),
]

queueing = [
    path("comments/<slug:kind>/<int:pk>/", comments.Comments.as_view(), name="comments"),
    path("comments/<int:pk>/", comments.OneComment.as_view(), name="comment"),
    path("comments/<int:pk>/restore/", comments.RestoreComment.as_view(), name="comment-restore"),
    path("audit-findings/", audit.AuditFindings.as_view(), name="audit-findings"),
    path("audit-findings/<int:pk>/", audit.OneAuditFinding.as_view(), name="audit-finding"),
    path("work-items/", work_items.WorkItems.as_view(), name="work-items"),
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
]

urlpatterns = [
    # The schema says what exists and shows no row, so that tools may read it without a token.
    path("schema/", SpectacularAPIView.as_view(permission_classes=[AllowAny]), name="schema"),
    path("worlds/", Worlds.as_view(), name="worlds"),
    path("worlds/<slug:world>/", OneWorld.as_view(), name="world"),
    path("worlds/<slug:world>/", include([*description, *work, *corpus, *queueing])),
]
