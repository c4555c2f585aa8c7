from django.apps import AppConfig


class AnnotationsConfig(AppConfig):
    """What people write: worlds, grammars, templates, commands, paraphrases and splits."""

    name = "annotations"
