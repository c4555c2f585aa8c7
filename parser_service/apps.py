from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

from django.conf import settings

from annotations.apps import WorkbenchApp
from parser_service.parsers.pretrained_files import keep_encoders_in
from parser_service.parsers.server_address import ModelServer, Patience, use_server

if TYPE_CHECKING:
    from annotations.models import World


class ParserServiceConfig(WorkbenchApp):
    """What machines learn: runs, evaluations and predictions."""

    default = True
    name = "parser_service"
    verbs = {
        "audit": "parser_service.labelling.audit_job.audit_of",
        "propose": "parser_service.labelling.parser_proposals.propose",
        "analyse": "parser_service.reviews.analysis_job.analyse",
        "answer": "parser_service.reviews.tryout_answers.answer",
        "train": "parser_service.runs.training_today.train_of",
        "measure": "parser_service.results.measuring_job.measure",
        "parse": "parser_service.serving.batch_job.parse_batch",
        "paraphrase": "parser_service.labelling.model_contributor.paraphrase_of",
    }
    archive_tables = (
        "parser_service.serving.archived_action_names.ACTION_NAMES",
        "parser_service.serving.archived_answering.ANSWERING",
    )

    def results_of(self, splits: Collection[int]) -> dict[str, int]:
        from parser_service.models import TrainingRun

        return {"run": TrainingRun.objects.filter(split__in=splits).count()}

    def has_parser(self, world: World) -> bool:
        from parser_service.models import TrainingRun

        return TrainingRun.objects.succeeded().filter(world=world).exists()

    def ready(self) -> None:
        keep_encoders_in(
            settings.ENCODERS_DIR, settings.VAR_DIR / "vectors", settings.ENCODER_PACKAGES
        )
        use_server(
            ModelServer(
                settings.LLM_URL,
                settings.LLM_KEY,
                settings.LLM_MAY_BE_REMOTE,
                Patience(answer=settings.LLM_SECONDS),
                settings.LLM_ANSWERS_DIR,
            )
        )
