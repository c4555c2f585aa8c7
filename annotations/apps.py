from django.apps import AppConfig


class AnnotationsConfig(AppConfig):
    """What people write: worlds, grammars, templates, commands, paraphrases and splits."""

    name = "annotations"

    def ready(self) -> None:
        from annotations.background import register
        from annotations.background.job_kinds import register_sweep, register_verb
        from annotations.models import Job, JobKind

        register(Job, "annotations.background.carrying_out_jobs.carry_out")
        register_verb(
            JobKind.IMPORT_GENERATOR, "annotations.exchange.import_jobs.import_generator_of"
        )
        register_verb(
            JobKind.IMPORT_COMPETITION, "annotations.exchange.import_jobs.import_competition_of"
        )
        register_verb(JobKind.IMPORT_PAIRS, "annotations.exchange.import_jobs.import_pairs_of")
        register_verb(JobKind.IMPORT_WORLD, "annotations.exchange.import_job.import_world_of")
        register_verb(JobKind.LOAD_WORLD, "annotations.exchange.shipped_worlds.load_world_of")
        register_verb(JobKind.IMPORT_RESULTS, "annotations.campaigns.crowd_jobs.import_results_of")
        register_verb(JobKind.GENERATE, "annotations.generation.generating.generate_pairs_of")
        register_verb(JobKind.LAUNCH, "annotations.campaigns.launching_job.launch_of")
        register_verb(JobKind.FREEZE, "annotations.generation.freezing_job.freeze_of")
        register_verb(JobKind.DELETE_WORLD, "annotations.exchange.world_deletion.delete_world_of")
        register_sweep("annotations.exchange.hidden_worlds.sweep_hidden_worlds")
