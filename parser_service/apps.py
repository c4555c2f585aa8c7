from django.apps import AppConfig
from django.conf import settings

from parser_service.parsers.encoder_places import keep_encoders_in


class ParserServiceConfig(AppConfig):
    """What machines learn: runs, evaluations and predictions."""

    name = "parser_service"

    def ready(self) -> None:
        keep_encoders_in(settings.ENCODERS_DIR, settings.VAR_DIR / "vectors")
