"""Load the parser of a run. Loads torch where the parser needs it."""

from __future__ import annotations

from functools import lru_cache

from annotations.models.background import Status
from parser_service.models import TrainingRun
from parser_service.parsers.interface import Parser
from parser_service.parsers.registry import load_class
from parser_service.runs.carrying_out.knowledge import knowledge_of
from parser_service.runs.checkpoints import model_folder

LOADED_PARSERS = 2


def load_parser(run: TrainingRun) -> Parser:
    """Load the saved parser of a succeeded run; the last few stay loaded. Raises ValueError."""
    _require_success(run)
    return _load(run.pk)


def load_anew(run: TrainingRun) -> Parser:
    """Load the saved parser of a succeeded run with what its world says now. Raises ValueError."""
    _require_success(run)
    folder = model_folder(run.pk)
    if not folder.is_dir():
        raise ValueError(
            f"The parser of run {run.pk} is not in {folder}. Bring that folder back, or train again."
        )
    return load_class(run.parser).load(folder, knowledge_of(run.world, run.protocol))


def size_of(run: TrainingRun) -> int:
    """Return the bytes of the saved parser, which are about those that it takes in memory."""
    return sum(path.stat().st_size for path in model_folder(run.pk).rglob("*") if path.is_file())


@lru_cache(maxsize=LOADED_PARSERS)
def _load(run_id: int) -> Parser:
    return load_anew(TrainingRun.objects.select_related("world").get(pk=run_id))


def _require_success(run: TrainingRun) -> None:
    if run.status != Status.SUCCEEDED:
        raise ValueError(f"Run {run.pk} is {run.status}, so there is no parser to ask.")
