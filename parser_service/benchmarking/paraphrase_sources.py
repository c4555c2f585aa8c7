"""The generated commands behind the paraphrases of a folder."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from annotations.exchange.prompt_sources import SourceFinder
from annotations.generation.kept_expansions import generate_at_once
from annotations.language.corpus import TRIPLES_FILE
from annotations.language.texts import LanguageError, Refusal
from annotations.models import World
from annotations.rows.from_rows import task_categories
from parser_service.benchmarking.corpus import read_corpus, source_commands


@dataclass(frozen=True)
class Sources:
    """``source_of`` is paraphrase → the command behind it; ``unresolved`` are the paraphrases whose prompt is no
    generated command."""

    source_of: Mapping[str, str] = field(default_factory=dict)
    unresolved: frozenset[str] = frozenset()

    @property
    def sentence(self) -> str:
        """What could not be resolved; empty where all was."""
        if not self.unresolved:
            return ""
        texts = sorted({self.source_of[each] for each in self.unresolved})
        return (
            f"{len(self.unresolved)} of {len(self.source_of)} paraphrases have a prompt that is no "
            "generated command; by source command they go to the training part: "
            f"{'; '.join(texts)}."
        )


def find_sources(folder: Path, world: World | None) -> Sources:
    """Find the generated command behind each paraphrase of ``paraphrasings.txt``; none without that file.

    Generated commands are those of ``world``, or those that its templates make where none are stored, and
    those of the folder. Without a world, prompts stand for themselves, and none counts as unresolved.
    Raises LanguageError at the first fault of a file.
    """
    if not (folder / TRIPLES_FILE).is_file():
        return Sources()
    if world is None:
        return Sources(source_commands(folder, str))
    expansions = (
        () if world.commands.exists() else generate_at_once(task_categories(world)).expansions
    )
    finder = SourceFinder(world, [*_of_folder(folder), *(each.command for each in expansions)])
    source_of = source_commands(folder, finder.text)
    unresolved = (said for said, command in source_of.items() if not finder.is_command(command))
    return Sources(source_of, frozenset(unresolved))


def _of_folder(folder: Path) -> Iterator[str]:
    for criterion in ("command", "logical_form"):
        try:
            parts = read_corpus(folder, criterion).parts
        except LanguageError:
            raise
        except Refusal:  # the folder has no such split
            continue
        for (_, source), pairs in parts.items():
            if source == "generated":
                yield from (pair.utterance for pair in pairs)
