from django.apps import AppConfig


class AnnotationsConfig(AppConfig):
    """What people write: worlds, grammars, templates, commands, paraphrases and splits."""

    name = "annotations"

    def ready(self) -> None:
        from annotations.background import register
        from annotations.models import Job

        register(Job, "annotations.jobs.carrying_out.carry_out")
