from parser_service.models.folders import RunFolder
from parser_service.models.predictions import Evaluation, Prediction
from parser_service.models.runs import Checkpoint, EpochMetric, RunEvent, TrainingRun
from parser_service.models.workers import Worker

__all__ = [
    "Checkpoint",
    "EpochMetric",
    "Evaluation",
    "Prediction",
    "RunEvent",
    "RunFolder",
    "TrainingRun",
    "Worker",
]
