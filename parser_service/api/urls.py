"""Routes below ``/api/v1/`` about runs, what they answer, and what the promoted one says."""

from __future__ import annotations

from django.urls import include, path

from parser_service.api import (
    analyses,
    answers,
    audit,
    dialogues,
    error_categories,
    predictions,
    promotions,
    reviews,
    robots,
    runs,
    slices,
)
from parser_service.api.parsing import ParseRoute

ANSWER = "runs/<int:run>/examples/<int:pk>"
of_runs = [
    path("parse/", ParseRoute.as_view(), name="parse"),
    path("parse/wrong/", answers.ReportWrong.as_view(), name="parse-wrong"),
    path(
        "utterances/<int:pk>/candidates/",
        answers.CandidatesOfUtterance.as_view(),
        name="utterance-candidates",
    ),
    path("suggestions/", answers.SuggestForms.as_view(), name="suggestions"),
    path("audit/", audit.LabelAudit.as_view(), name="audit"),
    path("promotions/", promotions.Promotions.as_view(), name="promotions"),
    path("promotions/roll-back/", promotions.RollBack.as_view(), name="promotion-roll-back"),
    path(
        "promotions/<int:pk>/decline/",
        promotions.DeclinePromotion.as_view(),
        name="promotion-decline",
    ),
    path("runs/", runs.Runs.as_view(), name="runs"),
    path("runs/<int:pk>/", runs.OneRun.as_view(), name="run"),
    path("runs/<int:pk>/cancel/", runs.CancelRun.as_view(), name="run-cancel"),
    path("runs/<int:pk>/retrain/", runs.RetrainRun.as_view(), name="run-retrain"),
    path("runs/<int:pk>/learning-curve/", runs.LearningCurve.as_view(), name="learning-curve"),
    path("runs/<int:pk>/findings/", analyses.RunFindings.as_view(), name="run-findings"),
    path("runs/<int:pk>/probes/", analyses.RunProbes.as_view(), name="run-probes"),
    path("runs/<int:pk>/analysis/", runs.Analyse.as_view(), name="run-analyse"),
    path(
        "runs/<int:pk>/predictions/send/",
        predictions.SendPredictions.as_view(),
        name="predictions-send",
    ),
    path("runs/<int:pk>/log/", runs.RunLog.as_view(), name="run-log"),
    path("runs/<int:pk>/curves/", runs.RunCurves.as_view(), name="run-curves"),
    path("runs/<int:pk>/checkpoints/", runs.RunCheckpoints.as_view(), name="run-checkpoints"),
    path("runs/<int:pk>/predictions/", predictions.Predictions.as_view(), name="predictions"),
    path("runs/<int:pk>/candidates/", predictions.Candidates.as_view(), name="candidates"),
    path("results/", predictions.Results.as_view(), name="results"),
    path("evaluations/", predictions.Evaluations.as_view(), name="evaluations"),
    path("evaluations/<int:pk>/", predictions.OneEvaluation.as_view(), name="evaluation"),
]

of_reviews = [
    path(f"{ANSWER}/review/", reviews.ReviewOfAnswer.as_view(), name="answer-review"),
    path(f"{ANSWER}/doubt/", reviews.DoubtLabel.as_view(), name="answer-doubt"),
    path("reviews/", reviews.Reviews.as_view(), name="reviews"),
    path("reviews/<int:pk>/", reviews.OneReview.as_view(), name="review"),
    path("slices/", slices.Slices.as_view(), name="slices"),
    path("slices/<int:pk>/", slices.OneSlice.as_view(), name="slice"),
    path("error-categories/", error_categories.ErrorCategories.as_view(), name="error-categories"),
    path(
        "error-categories/<int:pk>/",
        error_categories.OneErrorCategory.as_view(),
        name="error-category",
    ),
    path(
        "error-categories/<int:pk>/move/",
        error_categories.MoveErrorCategory.as_view(),
        name="error-category-move",
    ),
]

of_dialogues = [
    path("dialogues/", dialogues.Dialogues.as_view(), name="dialogues"),
    path("dialogues/<int:pk>/", dialogues.OneDialogue.as_view(), name="dialogue"),
    path("dialogues/<int:pk>/answer/", dialogues.AnswerDialogue.as_view(), name="dialogue-answer"),
    path("plan/", robots.PlanRoute.as_view(), name="plan"),
    path("robot/action-names/", robots.ActionNamesRoute.as_view(), name="action-names"),
    path("offered-entities/", robots.OfferedEntities.as_view(), name="offered-entities"),
    path(
        "offered-entities/<int:pk>/decide/",
        robots.DecideOfferedEntity.as_view(),
        name="offered-entity-decide",
    ),
    path("dialogues/<int:pk>/keep/", dialogues.KeepDialogue.as_view(), name="dialogue-keep"),
]

urlpatterns = [path("worlds/<slug:world>/", include([*of_runs, *of_reviews, *of_dialogues]))]
