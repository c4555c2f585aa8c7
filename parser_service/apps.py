from django.apps import AppConfig


class ParserServiceConfig(AppConfig):
    """What machines learn: runs, evaluations and predictions."""

    name = "parser_service"
