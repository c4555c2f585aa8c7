from django.apps import AppConfig


class AnnotationsConfig(AppConfig):
    """What people write: worlds, grammars, templates, commands, paraphrases and splits."""

    name = "annotations"

    def ready(self) -> None:
        from annotations.background import register
        from annotations.jobs.kinds import register_sweep, register_verb
        from annotations.models import Job, JobKind

        register(Job, "annotations.jobs.carrying_out.carry_out")
        register_verb(
            JobKind.IMPORT_GENERATOR, "annotations.importing.import_jobs.import_generator_of"
        )
        register_verb(
            JobKind.IMPORT_COMPETITION, "annotations.importing.import_jobs.import_competition_of"
        )
        register_verb(JobKind.IMPORT_PAIRS, "annotations.importing.import_jobs.import_pairs_of")
        register_verb(JobKind.IMPORT_WORLD, "annotations.world_archive.import_job.import_world_of")
        register_verb(JobKind.LOAD_WORLD, "annotations.worlds.shipped_worlds.load_world_of")
        register_verb(JobKind.IMPORT_RESULTS, "annotations.campaigns.crowd_jobs.import_results_of")
        register_verb(JobKind.GENERATE, "annotations.generation.generating.generate_pairs_of")
        register_verb(JobKind.DELETE_WORLD, "annotations.worlds.world_deletion.delete_world_of")
        register_sweep("annotations.worlds.hidden_worlds.sweep_hidden_worlds")
