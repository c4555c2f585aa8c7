"""Routes below ``/api/v1/`` about runs, what they answer, and what the promoted one says."""

from __future__ import annotations

from django.urls import include, path
from rest_framework.routers import SimpleRouter

from parser_service.web.labelling import against_rest, answer_rest, audit_rest, model_rest
from parser_service.web.results import analysis_rest, result_rest
from parser_service.web.results.slice_rest import SliceViewSet
from parser_service.web.reviews import prediction_rest, review_rest
from parser_service.web.reviews.error_category_rest import ErrorCategoryViewSet
from parser_service.web.runs import run_rest
from parser_service.web.serving import joint_rest, robot_rest
from parser_service.web.serving.answerer_rest import OneAnswerer
from parser_service.web.serving.dialogue_rest import DialogueViewSet
from parser_service.web.serving.parsing_rest import ParseJobs, ParseRoute
from parser_service.web.serving.promotion_rest import PromotionViewSet

router = SimpleRouter(use_regex_path=False)
router.register("runs", run_rest.RunViewSet, "run")
router.register("promotions", PromotionViewSet, "promotion")
router.register("evaluations", result_rest.EvaluationViewSet, "evaluation")
router.register("reviews", review_rest.ReviewViewSet, "review")
router.register("slices", SliceViewSet, "slice")
router.register("error-categories", ErrorCategoryViewSet, "error-category")
router.register("dialogues", DialogueViewSet, "dialogue")
router.register("offered-entities", robot_rest.OfferedEntityViewSet, "offered-entity")

ANSWER = "runs/<int:run>/examples/<int:pk>"
of_world = [
    *router.urls,
    path("parse/", ParseRoute.as_view(), name="parse"),
    path("parse/jobs/", ParseJobs.as_view(), name="parse-jobs"),
    path("parse/wrong/", answer_rest.ReportWrong.as_view(), name="parse-wrong"),
    path(
        "utterances/<int:pk>/candidates/",
        answer_rest.CandidatesOfUtterance.as_view(),
        name="utterance-candidates",
    ),
    path("suggestions/", answer_rest.SuggestForms.as_view(), name="suggestions"),
    path("campaigns/<int:pk>/model/", model_rest.ModelRewrites.as_view(), name="campaign-model"),
    path("paraphrase-figures/runs/", against_rest.ParaphraseRuns.as_view(), name="paraphrase-runs"),
    path("audit/", audit_rest.LabelAudit.as_view(), name="audit"),
    path("runs/<int:pk>/findings/", analysis_rest.RunFindings.as_view(), name="run-findings"),
    path("runs/<int:pk>/probes/", analysis_rest.RunProbes.as_view(), name="run-probes"),
    path(
        "runs/<int:pk>/predictions/send/",
        prediction_rest.SendPredictions.as_view(),
        name="predictions-send",
    ),
    path("runs/<int:pk>/log/", run_rest.RunLog.as_view(), name="run-log"),
    path("runs/<int:pk>/curves/", run_rest.RunCurves.as_view(), name="run-curves"),
    path("runs/<int:pk>/checkpoints/", run_rest.RunCheckpoints.as_view(), name="run-checkpoints"),
    path("runs/<int:pk>/predictions/", prediction_rest.Predictions.as_view(), name="predictions"),
    path("runs/<int:pk>/candidates/", prediction_rest.Candidates.as_view(), name="candidates"),
    path(f"{ANSWER}/review/", review_rest.ReviewOfAnswer.as_view(), name="answer-review"),
    path(f"{ANSWER}/doubt/", review_rest.DoubtLabel.as_view(), name="answer-doubt"),
    path("results/measure/", result_rest.Measurement.as_view(), name="results-measure"),
    path("results/", result_rest.Results.as_view(), name="results"),
    path("answerer/", OneAnswerer.as_view(), name="answerer"),
    path("plan/", robot_rest.PlanRoute.as_view(), name="plan"),
    path("joint-plan/", joint_rest.JointPlanRoute.as_view(), name="joint-plan"),
    path("task-plan/", robot_rest.TaskPlanRoute.as_view(), name="task-plan"),
    path("robot/action-names/", robot_rest.ActionNamesRoute.as_view(), name="action-names"),
]

urlpatterns = [path("worlds/<slug:world>/", include(of_world))]
