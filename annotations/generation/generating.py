"""Verb: make the commands of a world, each with its logical form, from its templates and grammar."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from annotations import models
from annotations.background.progress import UNWATCHED, Progress
from annotations.background.requesting import start_work
from annotations.background.watching import JobProgress
from annotations.generation.complexity import Complexity, complexity
from annotations.generation.generated_world import GeneratedWorld, counters_of
from annotations.generation.language_size import is_large, make_commands
from annotations.language.templates import (
    DEFAULT_LIMIT,
    Balance,
    Generated,
    SampleNote,
    SampleRequest,
)
from annotations.language.texts import LanguageError
from annotations.rows.from_rows import AnnotatedCategory, annotated_categories
from annotations.rows.synchronise import Changes

MOST_ATTEMPTS = 3


@dataclass(frozen=True)
class GenerationReport:
    """What a generation gave. ``columns`` are those of the complexity table, all of them last.

    ``sample`` says what sample the commands are, if any.
    """

    generated: Generated
    columns: tuple[Complexity, ...]
    categories: tuple[AnnotatedCategory, ...]
    changes: Changes
    sample: SampleNote | None = None

    def as_json(self) -> dict[str, Any]:
        """Return figures by task category; under ``all`` those of all together."""
        names = [column.task_category or "all" for column in self.columns]

        def by_category(figure: str) -> dict[str, Any]:
            values = (getattr(column, figure) for column in self.columns)
            rounded = (round(each, 4) if isinstance(each, float) else each for each in values)
            return dict(zip(names, rounded, strict=True))

        return {
            "commands": by_category("commands"),
            "forms": by_category("forms"),
            "conflicts": [
                {
                    "task_category": each.task_category,
                    "command": each.command,
                    "kept": each.kept,
                    "candidates": [
                        {"template": str(self._place(each.task_category, index)), "form": form}
                        for index, form in each.candidates
                    ],
                }
                for each in self.generated.conflicts
            ],
            "outside_grammar": len(self.generated.outside_grammar),
            "left_out": [
                {
                    "template": str(self._place(each.task_category, each.template_index)),
                    "reason": each.problem.message,
                }
                for each in self.generated.left_out
            ],
            "unmatched_templates": [str(self._place(*each)) for each in self.generated.unmatched],
            "mean_command_length": by_category("mean_command_length"),
            "mean_form_length": by_category("mean_form_length"),
            "commands_per_form": by_category("commands_per_form"),
            "changes": self.changes.as_json(),
            "sample": self.sample.as_json() if self.sample else None,
        }

    def _place(self, task_category: str, index: int) -> object:
        values = (category.value for category in self.categories)
        return next(each.templates for each in values if each.name == task_category)[index].position


def start_generation(
    world: models.World, by: models.User, request: SampleRequest | None = None
) -> models.Job | GenerationReport:
    """Generate now, or return a job: one that is about to do the same already, or a new one. What was asked for the
    last time, without a ``request``.

    Raises LanguageError where the templates cannot be expanded.
    """
    asked = is_large(world), models.JobKind.GENERATE, world, by, _arguments(request)
    return start_work(*asked, lambda: generate_pairs(world, request=request))


def _arguments(request: SampleRequest | None) -> dict[str, Any]:
    if request is None:
        return {}
    return {
        "sample": request.size,
        "seed": request.seed,
        "balanced": str(request.balance),
    }


def generate_pairs_of(job: models.Job, progress: JobProgress) -> dict[str, Any]:
    if job.world is None:
        raise LanguageError(f"there is no world “{job.world_name}” any more")
    arguments = job.arguments
    limits = {"limit": arguments["limit"]} if "limit" in arguments else {}
    request = None
    if "sample" in arguments:
        balance = Balance(arguments["balanced"])
        request = SampleRequest(arguments["sample"], arguments["seed"], balance)
    return generate_pairs(job.world, progress=progress, request=request, **limits).as_json()


def generate_pairs(
    world: models.World,
    limit: int = DEFAULT_LIMIT,
    progress: Progress = UNWATCHED,
    request: SampleRequest | None = None,
) -> GenerationReport:
    """Store the commands and logical forms of ``world`` and say what they are.

    Rows that are right already are not touched; a command that no template makes any more goes,
    and its paraphrases stay. Conflicts are stored as warnings. All is computed before anything is
    written, so that others wait for the writing alone.

    Args:
        limit: of commands, where all are made.
        request: the sample to draw, or ``EVERYTHING``; what was asked for the last time, without one.

    Raises:
        LanguageError: the templates make more than ``limit`` commands (nothing is changed then), a
            stored text cannot be read, somebody else keeps changing the world meanwhile, or as
            ``Language.sample``.
    """
    for _ in range(MOST_ATTEMPTS):
        report = _generate_once(world, limit, progress, request)
        if report is not None:
            return report
    raise LanguageError(
        "the templates were changed while their commands were made", hint="generate once more"
    )


def _generate_once(
    world: models.World, limit: int, progress: Progress, request: SampleRequest | None
) -> GenerationReport | None:
    """Generate once. Return None where others have changed templates or commands meanwhile."""
    progress.report(0, "expanding the templates")
    before = models.World.objects.get(pk=world.pk)
    counters = counters_of(before)
    categories = annotated_categories(world)
    generated, sample = make_commands(
        [category.value for category in categories],
        request or before.sample_request,
        limit,
        lambda share: progress.report(share / 2, "drawing commands"),
    )
    progress.report(0.5, "comparing with the stored commands")
    with GeneratedWorld(world, categories, generated, progress, sample) as rows:
        progress.report(0.9, "writing")
        with progress.writing():
            if counters_of(models.World.objects.hold().get(pk=world.pk)) != counters:
                return None
            changes = rows.write(counters)
            columns = tuple(complexity(world))
            report = GenerationReport(generated, columns, categories, changes, sample)
            progress.conclude(report.as_json())
    return report
