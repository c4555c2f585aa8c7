"""Verb: freeze a split, a copy of texts in which two parts share nothing of a kind."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import count
from typing import Any, Self

from django.core.exceptions import ValidationError

from annotations.background.progress import UNWATCHED, Progress
from annotations.generation.split_statistics import figures_of_planned
from annotations.language.corpus import (
    DEFAULT_PROPORTIONS,
    Criterion,
    FrozenExample,
    Part,
    SplitItem,
    content_hash,
    split,
)
from annotations.language.texts import LanguageError
from annotations.models import Example, Split, User, World
from annotations.models.splits import Source
from annotations.rows.staging import Staging
from annotations.rows.synchronise import BATCH


def freeze_split(
    world: World,
    name: str,
    criterion: str = Criterion.COMMAND,
    seed: int = 0,
    proportions: Sequence[float] = DEFAULT_PROPORTIONS,
    by: User | None = None,
    must_be_new: bool = False,
    tests_on_models: bool = False,
    progress: Progress = UNWATCHED,
) -> Split:
    """Freeze the commands, accepted paraphrases and labelled utterances of ``world`` as the split ``name``.

    Args:
        criterion: what two parts never share: a ``command``, ``source_command`` or
            ``logical_form``, over the examples of all sources together.
        seed: the same world, criterion, proportions and seed give the same split.
        proportions: shares of train, validation and test that sum to 1.
        must_be_new: refuse a name that is taken, whatever the split of that name holds.
        tests_on_models: put what language models wrote into validation and test too.

    Returns:
        The split; the one that is there already where it holds just the same.

    Raises:
        LanguageError: there is nothing to split, the proportions are no shares of a whole, or the name is taken by
            a split with other examples.
    """
    if must_be_new:
        require_free(world, name)
    progress.report(0, "parting the pairs")
    examples = plan_split(world, criterion, seed, proportions, tests_on_models)
    progress.report(0.6, "writing the split")
    prepared = PreparedSplit(
        name, criterion, examples, seed, proportions, tests_on_models=tests_on_models
    )
    with prepared, progress.writing():
        World.objects.hold().get(pk=world.pk)
        if must_be_new:
            require_free(world, name)  # nobody has taken it meanwhile
        frozen, _ = prepared.store(world, by)
        progress.conclude(report_of(frozen))
    return frozen


def require_free(world: World, name: str) -> None:
    """Raise LanguageError where ``world`` has a split called ``name``."""
    if world.splits.filter(name=name).exists():
        raise LanguageError(f"there is a split {name} already", hint="choose another name")


def free_name(world: World) -> str:
    """Return a name that no split of ``world`` has: that of the world and a number."""
    taken = set(world.splits.values_list("name", flat=True))
    return next(name for n in count(len(taken) + 1) if (name := f"{world.name}-{n}") not in taken)


def report_of(frozen: Split) -> dict[str, Any]:
    """Return what the job that froze a split reports."""
    return {"split": frozen.pk, "name": frozen.name, "examples": frozen.examples.count()}


def plan_split(
    world: World,
    criterion: str = Criterion.COMMAND,
    seed: int = 0,
    proportions: Sequence[float] = DEFAULT_PROPORTIONS,
    tests_on_models: bool = False,
) -> list[Example]:
    """Return the examples that ``freeze_split`` would store, each with its part and position. Raises likewise."""
    examples = list(candidates(world))
    items = as_items(examples)
    kept = kept_in_training(items, criterion)
    parts = split(items, Criterion(criterion), proportions, seed, kept)
    return assign_parts(examples, parts, tests_on_models)


def unresolved_prompts(items: Iterable[SplitItem]) -> dict[str, str]:
    """Return key → text of the source commands that are no generated command, of paraphrases that say one
    at all; none where nothing is generated."""
    generated: set[str] = set()
    said: dict[str, str] = {}
    for item in items:
        key = item.key(Criterion.SOURCE_COMMAND)
        if item.source == Source.GENERATED:
            generated.add(key)
        elif item.source_command not in ("", item.utterance):
            said[key] = item.source_command
    return {key: text for key, text in said.items() if generated and key not in generated}


def kept_in_training(items: Sequence[SplitItem], criterion: str) -> dict[str, Part]:
    """Return key → training part for what has to go there: by source command, paraphrases of prompts that are no
    generated command, since nobody can tell what else they share."""
    if criterion != Criterion.SOURCE_COMMAND:
        return {}
    return dict.fromkeys(unresolved_prompts(items), Part.TRAIN)


def as_items(examples: Iterable[Example]) -> list[SplitItem]:
    return [
        SplitItem(each.source, each.utterance, each.source_command, each.logical_form)
        for each in examples
    ]


def assign_parts(
    examples: Sequence[Example], parts: Iterable[Part], tests_on_models: bool = False
) -> list[Example]:
    """Give unsaved examples their parts and their positions in these, and return those that stay.

    Unless the split ``tests_on_models``, what a language model wrote is for training alone: where its part is
    another one, it is left out.
    """
    for example, part in zip(examples, parts, strict=True):
        example.part = str(part)
    staying = [
        each
        for each in examples
        if tests_on_models or each.part == Part.TRAIN or each.source != Source.MODEL
    ]
    # As in pair files: by the number of characters of the utterance.
    following: dict[tuple[str, str], int] = {}
    for example in sorted(staying, key=lambda each: len(each.utterance)):
        place = (example.source, example.part)
        example.position = following.get(place, 0)
        following[place] = example.position + 1
    return staying


class PreparedSplit:
    """Examples (without a split so far) that ``store`` makes a split of.

    Entering it collects them, so that storing, inside a transaction, is quick.
    """

    COLUMNS = (
        *("position", "part", "source", "utterance", "source_command", "task_category"),
        *("logical_form", "written_form", "grounded_form"),
        *("head_predicate", "depth", "word_count"),
    )

    def __init__(
        self,
        name: str,
        criterion: str,
        examples: Sequence[Example],
        seed: int | None = None,
        proportions: Sequence[float] = (),
        follows: Split | None = None,
        tests_on_models: bool = False,
    ) -> None:
        """Raises LanguageError where no split can have the name."""
        try:
            Split(name=name).clean_fields(exclude={"world", "criterion", "content_hash"})
        except ValidationError as error:
            sentences = " ".join(error.messages)
            raise LanguageError(f"“{name}” cannot be the name of a split: {sentences}") from error
        self.name = name
        self.criterion = criterion
        self.seed = seed
        self.proportions = list(proportions)
        self.follows = follows
        self.tests_on_models = tests_on_models
        self.examples = sorted(examples, key=lambda each: (each.source, each.part, each.position))
        self.content_hash = content_hash(map(_freeze, self.examples))
        self._figures = figures_of_planned(self.examples).as_json()
        self._staging = Staging(Example, self.COLUMNS)

    def __enter__(self) -> Self:
        self._staging.__enter__().add_new(self.examples)
        return self

    def __exit__(self, *raised: Any) -> None:
        self._staging.__exit__(*raised)

    def _sample_of(self, world: World) -> dict[str, Any]:
        """Return the note about the sample that the commands are, where the split has any of them."""
        is_of_world = self.seed is not None  # an imported split has commands of its own
        if not is_of_world or not any(each.source == Source.GENERATED for each in self.examples):
            return {}
        now = World.objects.get(pk=world.pk)
        return now.sample if now.sample_note else {}

    def store(self, world: World, by: User | None = None) -> tuple[Split, bool]:
        """Store the split; inside a transaction.

        Returns:
            The split and whether it is new; one of that name with the same texts is left alone.

        Raises:
            LanguageError: there is one of that name with other texts.
        """
        existing = world.splits.filter(name=self.name).first()
        if existing is not None:
            is_same = existing.criterion == self.criterion
            if not is_same or _texts(existing.examples.all()) != _texts(self.examples):
                raise LanguageError(
                    f"there is a split {self.name} already, and it holds something else",
                    hint="a frozen split never changes: choose another name",
                )
            return existing, False
        created = Split.objects.create(
            world=world,
            name=self.name,
            criterion=self.criterion,
            seed=self.seed,
            proportions=self.proportions,
            follows=self.follows,
            tests_on_models=self.tests_on_models,
            sample=self._sample_of(world),
            content_hash=self.content_hash,
            figures=self._figures,
            created_by=by,
        )
        self._staging.insert(split_id=str(int(created.pk)))
        return created, True


def content_hash_of(split: Split) -> str:
    """Return the hash of the examples that ``split`` has now; equal to its ``content_hash`` as long as nobody
    changes them."""
    return content_hash(map(_freeze, split.examples.all().iterator(chunk_size=BATCH)))


def candidates(world: World, only_edited: bool = False) -> Iterator[Example]:
    """Yield every command, accepted paraphrase and labelled utterance; a pair that occurs twice is taken once.

    With ``only_edited`` those paraphrases alone that people have changed since their import.
    """
    for command in world.commands.select_related("logical_form"):
        yield Example(
            source=Source.GENERATED,
            utterance=command.anonymized_text,
            source_command=command.anonymized_text,
            task_category=command.task_category,
            logical_form=command.logical_form.text,
        )
    seen: set[tuple[str, str]] = set()
    paraphrases = world.paraphrases.accepted().select_related("command", "contributor")
    for said in paraphrases.filter(version__gt=1) if only_edited else paraphrases:
        if (said.utterance, said.logical_form) in seen:
            continue
        seen.add((said.utterance, said.logical_form))
        yield Example(
            source=Source.MODEL if said.is_by_model else Source.PARAPHRASED,
            utterance=said.utterance,
            source_command=said.command.anonymized_text if said.command else said.prompt,
            task_category=said.command.task_category if said.command else "",
            logical_form=said.logical_form,
            grounded_form=said.grounded_form,
        )
    for labelled in world.utterances.labelled():
        if (labelled.text, labelled.logical_form) not in seen:
            yield Example(
                source=Source.SAID,
                utterance=labelled.text,
                source_command=labelled.text,  # no command is behind it
                logical_form=labelled.logical_form,
            )


def _texts(examples: Iterable[Example]) -> list[tuple[object, ...]]:
    """Return what a pair file holds of each example, and where."""
    return [
        (
            example.source,
            example.part,
            example.position,
            example.utterance,
            example.logical_form,
            example.written_form,
        )
        for example in examples
    ]


def _freeze(example: Example) -> FrozenExample:
    return FrozenExample(
        example.part,
        example.source,
        example.utterance,
        example.source_command,
        example.task_category,
        example.logical_form,
        example.grounded_form,
    )
