"""Load the parser of a run, or make one that needs no run. Loads torch where the parser needs it."""

from __future__ import annotations

from functools import lru_cache
from http import HTTPStatus

from annotations.language.texts import Refusal
from annotations.models import World
from annotations.models.background import Status
from parser_service.models import TrainingRun
from parser_service.parsers.interface import Parser
from parser_service.parsers.registry import entry, load_class, untrained
from parser_service.runs.checkpoints import model_folder
from parser_service.runs.knowledge import knowledge_of

LOADED_PARSERS = 2


def load_parser(run: TrainingRun) -> Parser:
    """Load the saved parser of a succeeded run; the last few stay loaded. Raises Refusal."""
    _require_success(run)
    return _load(run.pk, run.content_key)


def load_anew(run: TrainingRun) -> Parser:
    """Load the saved parser of a succeeded run with what its world says now. Raises Refusal."""
    _require_success(run)
    folder = model_folder(run.pk)
    if not folder.is_dir():
        raise Refusal(
            f"The parser of run {run.pk} is not in {folder}. Bring that folder back, or train again.",
            "saved_parser_missing",
            HTTPStatus.CONFLICT,
        )
    return load_class(run.parser).load(folder, knowledge_of(run.world, run.protocol))


def make_untrained(name: str, world: World) -> Parser:
    """Return the parser ``name``, made of what ``world`` says now. Raises Refusal where it has to be trained."""
    if name not in untrained():
        raise Refusal(
            f"{name} cannot answer without a run; these can: {', '.join(untrained())}.",
            "needs_training",
        )
    parser = load_class(name)(knowledge=knowledge_of(world, entry(name).protocols[-1]))
    parser.fit(())
    return parser


def size_of(run: TrainingRun) -> int:
    """Return the bytes of the saved parser, which are about those that it takes in memory."""
    return sum(path.stat().st_size for path in model_folder(run.pk).rglob("*") if path.is_file())


@lru_cache(maxsize=LOADED_PARSERS)
def _load(run_id: int, content_key: str) -> Parser:
    # The number alone does not tell: a restored database gives it to another run.
    return load_anew(TrainingRun.objects.select_related("world").get(pk=run_id))


def _require_success(run: TrainingRun) -> None:
    if run.status != Status.SUCCEEDED:
        raise Refusal(
            f"Run {run.pk} is {run.status}, so there is no parser to ask.",
            "run_not_succeeded",
            HTTPStatus.CONFLICT,
        )
