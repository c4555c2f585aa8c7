from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING

from django.apps import AppConfig, apps

if TYPE_CHECKING:
    from annotations.models import World


class WorkbenchApp(AppConfig):
    """What the code of ``annotations`` asks of each app. A dotted path is loaded where it is needed alone."""

    default = False

    verbs: Mapping[str, str] = {}  # kind of job → what carries it out: (job, progress) → report
    sweeps: Sequence[str] = ()  # called after each job, clear away what interrupted jobs have left
    archive_tables: Sequence[str] = ()  # further tables in the archive of a world

    def results_of(self, splits: Collection[int]) -> dict[str, int]:
        """Return how many results were made with the splits of these keys, by the noun for them."""
        return {}

    def has_parser(self, world: World) -> bool:
        """Return whether something learned in ``world`` can answer."""
        return False


def workbench_apps() -> list[WorkbenchApp]:
    return [config for config in apps.get_app_configs() if isinstance(config, WorkbenchApp)]


class AnnotationsConfig(WorkbenchApp):
    """What people write: worlds, grammars, templates, commands, paraphrases and splits."""

    default = True
    name = "annotations"
    verbs = {
        "import_generator": "annotations.exchange.import_jobs.import_generator_of",
        "import_competition": "annotations.exchange.import_jobs.import_competition_of",
        "import_pairs": "annotations.exchange.import_jobs.import_pairs_of",
        "import_world": "annotations.exchange.world_import_job.import_world_of",
        "load_world": "annotations.exchange.shipped_worlds.load_world_of",
        "import_results": "annotations.campaigns.crowd_jobs.import_results_of",
        "generate": "annotations.generation.generating.generate_pairs_of",
        "launch": "annotations.campaigns.launching_job.launch_of",
        "freeze": "annotations.generation.freezing_job.freeze_of",
        "delete_world": "annotations.exchange.world_deletion.delete_world_of",
    }
    sweeps = ("annotations.exchange.hidden_worlds.sweep_hidden_worlds",)
