"""Routes below ``/api/v1/``: view sets of kinds of rows on routers, and single addresses."""

from __future__ import annotations

from django.urls import URLPattern, URLResolver, include, path
from rest_framework.routers import SimpleRouter

from annotations.web.campaigns import campaign_rest, figure_rest, submission_rest
from annotations.web.corpus import (
    command_rest,
    export_rest,
    label_rest,
    paraphrase_rest,
    split_rest,
    upload_rest,
    utterance_rest,
)
from annotations.web.description import (
    category_rest,
    check_rest,
    class_rest,
    coverage_rest,
    entity_rest,
    example_rest,
    guidelines_rest,
    predicate_rest,
    production_rest,
    recipe_rest,
    template_rest,
    vocabulary_rest,
)
from annotations.web.editing import comment_rest, history_rest, notice_rest
from annotations.web.labelling import (
    agreement_rest,
    audit_rest,
    queue_settings_rest,
    sending_rest,
    work_item_rest,
)
from annotations.web.people import account_rest, member_rest, token_rest
from annotations.web.rest.root import ApiRoot
from annotations.web.rest.schema_view import SchemaFile
from annotations.web.worlds import event_rest, import_rest, job_rest
from annotations.web.worlds.world_rest import OneWorld, Worlds

app_name = "api"

of_world = SimpleRouter(use_regex_path=False)
of_world.register("entity-classes", class_rest.EntityClassViewSet, "entity-class")
of_world.register("entities", entity_rest.EntityViewSet, "entity")
of_world.register("predicates", predicate_rest.PredicateViewSet, "predicate")
of_world.register("recipes", recipe_rest.RecipeViewSet, "recipe")
of_world.register("primitives", recipe_rest.PrimitiveViewSet, "primitive")
of_world.register("task-categories", category_rest.TaskCategoryViewSet, "task-category")
of_world.register("productions", production_rest.ProductionViewSet, "production")
of_world.register("templates", template_rest.TemplateViewSet, "template")
of_world.register("commands", command_rest.CommandViewSet, "command")
of_world.register("forms", command_rest.LogicalFormViewSet, "form")
of_world.register("paraphrases", paraphrase_rest.ParaphraseViewSet, "paraphrase")
of_world.register("campaigns", campaign_rest.CampaignViewSet, "campaign")
of_world.register("contributors", campaign_rest.ContributorViewSet, "contributor")
of_world.register("utterances", utterance_rest.UtteranceViewSet, "utterance")
of_world.register("uploads", upload_rest.UploadViewSet, "upload")
of_world.register("labels", label_rest.LabelViewSet, "label")
of_world.register("submissions", submission_rest.SubmissionViewSet, "submission")
of_world.register("splits", split_rest.SplitViewSet, "split")
of_world.register("jobs", job_rest.JobViewSet, "job")
of_world.register("comments", comment_rest.CommentViewSet, "comment")
of_world.register("work-items", work_item_rest.WorkItemViewSet, "work-item")
of_world.register("audit-findings", audit_rest.AuditFindingViewSet, "audit-finding")
of_world.register("audit-decisions", audit_rest.AuditDecisionViewSet, "audit-decision")
of_world.register("members", member_rest.MemberViewSet, "member")
of_world.register("invitations", member_rest.InvitationViewSet, "invitation")

of_site = SimpleRouter(use_regex_path=False)
of_site.register("tokens", token_rest.TokenViewSet, "token")
of_site.register("notices", notice_rest.NoticeViewSet, "notice")
of_site.register("accounts", account_rest.AccountViewSet, "account")
of_site.register("jobs", job_rest.SiteJobViewSet, "site-job")

description = [
    path("uncovered/", coverage_rest.Uncovered.as_view(), name="uncovered"),
    path("conflicts/", coverage_rest.Conflicts.as_view(), name="conflicts"),
    path("check/template/", check_rest.CheckTemplate.as_view(), name="check-template"),
    path("check/production/", check_rest.CheckProduction.as_view(), name="check-production"),
    path("check/predicate/", check_rest.CheckPredicate.as_view(), name="check-predicate"),
    path("check/recipe/", recipe_rest.CheckRecipe.as_view(), name="check-recipe"),
    path("check/primitive/", recipe_rest.CheckPrimitive.as_view(), name="check-primitive"),
    path("recipe-book/", recipe_rest.OneRecipeBook.as_view(), name="recipe-book"),
    path("recipe-book/shipped/", recipe_rest.ShippedBooks.as_view(), name="shipped-books"),
    path("recipe-book/proposed/", recipe_rest.ProposedRecipes.as_view(), name="proposed-recipes"),
    path("check/form/", check_rest.CheckForm.as_view(), name="check-form"),
    path("vocabulary/", vocabulary_rest.Vocabulary.as_view(), name="vocabulary"),
    path("proposals/", example_rest.Proposals.as_view(), name="proposals"),
    path("examples/", example_rest.Examples.as_view(), name="examples"),
    path("guidelines/", guidelines_rest.OneGuidelines.as_view(), name="guidelines"),
    path("history/<slug:kind>/<int:pk>/", history_rest.HistoryOfRow.as_view(), name="history"),
    path("deleted/<slug:kind>/", history_rest.Deleted.as_view(), name="deleted"),
    path("rename/<slug:kind>/<int:pk>/", history_rest.Rename.as_view(), name="rename"),
    path("comments/<slug:kind>/<int:pk>/", comment_rest.Comments.as_view(), name="comments"),
]

corpus = [
    path("paraphrase-figures/", figure_rest.FiguresOfWorld.as_view(), name="paraphrase-figures"),
    path("paraphrase-figures/forms/", figure_rest.FormCounts.as_view(), name="paraphrase-forms"),
    path(
        "paraphrase-figures/contributors/",
        figure_rest.ContributorCounts.as_view(),
        name="paraphrase-contributors",
    ),
    path("import/", import_rest.ImportGenerator.as_view(), name="import"),
    path("import/competition/", import_rest.ImportCompetition.as_view(), name="import-competition"),
    path("import/pairs/", import_rest.ImportPairs.as_view(), name="import-pairs"),
    path("generate/", import_rest.Generate.as_view(), name="generate"),
    path("generation/", import_rest.Generation.as_view(), name="generation"),
    path("download/", import_rest.Archive.as_view(), name="download"),
    path("download/<slug:part>/", import_rest.ArchivePart.as_view(), name="download-part"),
    path("events/", event_rest.Events.as_view(), name="events"),
    path("complexity/", command_rest.ComplexityOfWorld.as_view(), name="complexity"),
    path("splits/<int:pk>/examples/", split_rest.ExamplesOfSplit.as_view(), name="split-examples"),
    path("splits/<int:pk>/manifest/", export_rest.SplitManifest.as_view(), name="split-manifest"),
    path("splits/<int:pk>/export/", export_rest.SplitExport.as_view(), name="split-export"),
    path(
        "splits/<int:pk>/near-duplicates/",
        split_rest.NearDuplicatesOfSplit.as_view(),
        name="near-duplicates",
    ),
    path("splits/<int:pk>/changes/", split_rest.ChangesOfSplit.as_view(), name="split-changes"),
    path(
        "splits/<int:split>/examples/<int:pk>/send/",
        sending_rest.SendExample.as_view(),
        name="example-send",
    ),
]

people = [
    path("agreement/", agreement_rest.AgreementOfWorld.as_view(), name="agreement"),
    path("progress/", agreement_rest.ProgressOfWorld.as_view(), name="progress"),
    path("queue-settings/", queue_settings_rest.QueueSettings.as_view(), name="queue-settings"),
    path("audit-log/", account_rest.AuditLogOfWorld.as_view(), name="audit-log"),
]

site = [
    path("", ApiRoot.as_view(), name="root"),
    path("schema/", SchemaFile.as_view(), name="schema"),
    path("worlds/", Worlds.as_view(), name="worlds"),
    path("import-world/", import_rest.ImportWorld.as_view(), name="import-world"),
    path("join/", member_rest.Join.as_view(), name="join"),
    path("sessions/", token_rest.Sessions.as_view(), name="sessions"),
    path("sessions/end/", token_rest.EndSessions.as_view(), name="sessions-end"),
    path("sessions/<slug:handle>/", token_rest.OneSession.as_view(), name="session"),
    path("audit-log/", account_rest.SiteLog.as_view(), name="site-log"),
]

urlpatterns: list[URLPattern | URLResolver] = [
    path("worlds/<slug:world>/", OneWorld.as_view(), name="world"),
    path("worlds/<slug:world>/", include([*of_world.urls, *description, *corpus, *people])),
    *of_site.urls,
    *site,
]
