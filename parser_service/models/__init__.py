from parser_service.models.analyses import Expectation, Probe, ProbeAnswer, RunAnalysis
from parser_service.models.columns import AnswerColumns, ExampleColumns
from parser_service.models.folders import RunFolder
from parser_service.models.predictions import Evaluation, Prediction
from parser_service.models.promotions import Promotion, PromotionState
from parser_service.models.reviews import ErrorCategory, Review, Slice
from parser_service.models.runs import Checkpoint, EpochMetric, RunEvent, TrainingRun
from parser_service.models.tryouts import Tryout
from parser_service.models.workers import Worker

__all__ = [
    "AnswerColumns",
    "Checkpoint",
    "EpochMetric",
    "ErrorCategory",
    "Evaluation",
    "ExampleColumns",
    "Expectation",
    "Prediction",
    "Probe",
    "ProbeAnswer",
    "Promotion",
    "PromotionState",
    "Review",
    "RunAnalysis",
    "RunEvent",
    "RunFolder",
    "Slice",
    "TrainingRun",
    "Tryout",
    "Worker",
]
