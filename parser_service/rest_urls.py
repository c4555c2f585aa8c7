"""Routes below ``/api/v1/`` about runs, what they answer, and what the promoted one says."""

from __future__ import annotations

from django.urls import include, path

from parser_service.web.analyses import analysis_rest
from parser_service.web.dialogues import dialogue_rest
from parser_service.web.labelling import answer_rest, audit_rest
from parser_service.web.promotions import promotion_rest
from parser_service.web.results import result_rest, slice_rest
from parser_service.web.reviews import error_category_rest, prediction_rest, review_rest
from parser_service.web.robots import robot_rest
from parser_service.web.runs import run_rest
from parser_service.web.serving.parsing_rest import ParseJobs, ParseRoute

ANSWER = "runs/<int:run>/examples/<int:pk>"
of_runs = [
    path("parse/", ParseRoute.as_view(), name="parse"),
    path("parse/jobs/", ParseJobs.as_view(), name="parse-jobs"),
    path("parse/wrong/", answer_rest.ReportWrong.as_view(), name="parse-wrong"),
    path(
        "utterances/<int:pk>/candidates/",
        answer_rest.CandidatesOfUtterance.as_view(),
        name="utterance-candidates",
    ),
    path("suggestions/", answer_rest.SuggestForms.as_view(), name="suggestions"),
    path("audit/", audit_rest.LabelAudit.as_view(), name="audit"),
    path("promotions/", promotion_rest.Promotions.as_view(), name="promotions"),
    path("promotions/roll-back/", promotion_rest.RollBack.as_view(), name="promotion-roll-back"),
    path(
        "promotions/<int:pk>/decline/",
        promotion_rest.DeclinePromotion.as_view(),
        name="promotion-decline",
    ),
    path("runs/", run_rest.Runs.as_view(), name="runs"),
    path("runs/<int:pk>/", run_rest.OneRun.as_view(), name="run"),
    path("runs/<int:pk>/cancel/", run_rest.CancelRun.as_view(), name="run-cancel"),
    path("runs/<int:pk>/retrain/", run_rest.RetrainRun.as_view(), name="run-retrain"),
    path(
        "runs/<int:pk>/learning-curve/",
        run_rest.StartLearningCurve.as_view(),
        name="learning-curve",
    ),
    path("runs/<int:pk>/findings/", analysis_rest.RunFindings.as_view(), name="run-findings"),
    path("runs/<int:pk>/probes/", analysis_rest.RunProbes.as_view(), name="run-probes"),
    path("runs/<int:pk>/analysis/", run_rest.Analyse.as_view(), name="run-analyse"),
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
    path("results/", result_rest.Results.as_view(), name="results"),
    path("evaluations/", result_rest.Evaluations.as_view(), name="evaluations"),
    path("evaluations/<int:pk>/", result_rest.OneEvaluation.as_view(), name="evaluation"),
]

of_reviews = [
    path(f"{ANSWER}/review/", review_rest.ReviewOfAnswer.as_view(), name="answer-review"),
    path(f"{ANSWER}/doubt/", review_rest.DoubtLabel.as_view(), name="answer-doubt"),
    path("reviews/", review_rest.Reviews.as_view(), name="reviews"),
    path("reviews/<int:pk>/", review_rest.OneReview.as_view(), name="review"),
    path("slices/", slice_rest.Slices.as_view(), name="slices"),
    path("slices/<int:pk>/", slice_rest.OneSlice.as_view(), name="slice"),
    path(
        "error-categories/", error_category_rest.ErrorCategories.as_view(), name="error-categories"
    ),
    path(
        "error-categories/<int:pk>/",
        error_category_rest.OneErrorCategory.as_view(),
        name="error-category",
    ),
    path(
        "error-categories/<int:pk>/move/",
        error_category_rest.MoveErrorCategory.as_view(),
        name="error-category-move",
    ),
]

of_dialogues = [
    path("dialogues/", dialogue_rest.Dialogues.as_view(), name="dialogues"),
    path("dialogues/<int:pk>/", dialogue_rest.OneDialogue.as_view(), name="dialogue"),
    path(
        "dialogues/<int:pk>/answer/", dialogue_rest.AnswerDialogue.as_view(), name="dialogue-answer"
    ),
    path("plan/", robot_rest.PlanRoute.as_view(), name="plan"),
    path("robot/action-names/", robot_rest.ActionNamesRoute.as_view(), name="action-names"),
    path("offered-entities/", robot_rest.OfferedEntities.as_view(), name="offered-entities"),
    path(
        "offered-entities/<int:pk>/decide/",
        robot_rest.DecideOfferedEntity.as_view(),
        name="offered-entity-decide",
    ),
    path("dialogues/<int:pk>/keep/", dialogue_rest.KeepDialogue.as_view(), name="dialogue-keep"),
]

urlpatterns = [path("worlds/<slug:world>/", include([*of_runs, *of_reviews, *of_dialogues]))]
