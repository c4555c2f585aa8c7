from parser_service.models.action_names import ActionNames
from parser_service.models.analyses import Expectation, Probe, ProbeAnswer, RunAnalysis
from parser_service.models.answering import AnswererEvaluation, Answering, AnsweringOrder
from parser_service.models.columns import AnswerColumns, ExampleColumns
from parser_service.models.dialogues import Dialogue, OfferedEntity, OfferState
from parser_service.models.evaluations import Evaluation
from parser_service.models.folders import RunFolder
from parser_service.models.predictions import Prediction
from parser_service.models.promotions import Promotion, PromotionState
from parser_service.models.reviews import ErrorCategory, Review, Slice
from parser_service.models.runs import Checkpoint, EpochMetric, RunEvent, TrainingRun
from parser_service.models.tryouts import Tryout
from parser_service.models.workers import Worker
