from django.apps import AppConfig
from django.conf import settings

from parser_service.parsers.pretrained_files import keep_encoders_in
from parser_service.parsers.server_address import ModelServer, Patience, use_server


class ParserServiceConfig(AppConfig):
    """What machines learn: runs, evaluations and predictions."""

    name = "parser_service"

    def ready(self) -> None:
        from annotations.background import register
        from annotations.background.job_kinds import register_verb
        from annotations.exchange.parts import register_part
        from annotations.generation.stale import register_results
        from annotations.labelling.proposal_requests import register_parsers
        from annotations.models import JobKind
        from parser_service.models import TrainingRun

        register(TrainingRun, "parser_service.runs.train_run.train")
        register_verb(JobKind.AUDIT, "parser_service.labelling.audit_job.audit_of")
        register_verb(JobKind.PROPOSE, "parser_service.labelling.parser_proposals.propose")
        register_verb(JobKind.ANALYSE, "parser_service.reviews.analysis_job.analyse")
        register_verb(JobKind.ANSWER, "parser_service.reviews.tryout_answers.answer")
        register_verb(JobKind.MEASURE, "parser_service.results.measuring_job.measure")
        register_verb(JobKind.PARSE, "parser_service.serving.batch_job.parse_batch")
        register_verb(
            JobKind.PARAPHRASE, "parser_service.labelling.model_contributor.paraphrase_of"
        )
        register_parsers(lambda world: TrainingRun.objects.succeeded().filter(world=world).exists())
        register_part("parser_service.serving.archived_action_names.ACTION_NAMES")
        register_part("parser_service.serving.archived_answering.ANSWERING")
        register_results("run", lambda keys: TrainingRun.objects.filter(split__in=keys).count())
        keep_encoders_in(
            settings.ENCODERS_DIR, settings.VAR_DIR / "vectors", settings.ENCODER_PACKAGES
        )
        use_server(
            ModelServer(
                settings.LLM_URL,
                settings.LLM_KEY,
                settings.LLM_MAY_BE_REMOTE,
                Patience(answer=settings.LLM_SECONDS),
                settings.VAR_DIR / "llm",
            )
        )
