"""Verb: freeze a split anew from the corpus of today, and show before what that changes.

Examples keep their parts wherever the criterion allows it, so that runs on both splits can be compared.
Pairs of an imported split stay as they were published unless people have decided otherwise here.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import count

from annotations.background.progress import UNWATCHED, Progress
from annotations.generation.freezing import (
    PreparedSplit,
    as_items,
    assign_parts,
    candidates,
    kept_in_training,
    report_of,
)
from annotations.language.corpus import DEFAULT_PROPORTIONS, Criterion, Part, SplitItem, split
from annotations.language.texts import LanguageError
from annotations.models import Example, Paraphrase, Split, User, World
from annotations.models.corpus import ParaphraseStatus, UtteranceStatus
from annotations.models.splits import Source
from annotations.rows.history import DELETED, history_of
from annotations.rows.synchronise import BATCH

LONGEST_NAME = 80

KINDS_OF_CHANGE = ("added", "removed", "relabelled", "moved")

# Whether it was generated, and the utterance: what an example of an old and of a new split have in common. The other
# sources are one here, since splits that were frozen earlier call labelled utterances paraphrased.
Said = tuple[bool, str]


class Unchanged(LanguageError):
    """Freezing a split anew would give the same split."""


@dataclass(frozen=True, slots=True)
class RelabelledExample:
    """An utterance with its label in the split and that of today."""

    utterance: str
    part: str
    before: str
    now: str


@dataclass(frozen=True, slots=True)
class PartChanges:
    """Examples of one part: ``moved`` ones come from another part."""

    part: str
    added: int
    removed: int
    relabelled: int
    moved: int


@dataclass(frozen=True, slots=True)
class SplitChanges:
    """How a split that is frozen anew differs from the one before."""

    parts: tuple[PartChanges, ...]
    relabelled: tuple[RelabelledExample, ...]

    @property
    def is_none(self) -> bool:
        return not any(
            each.added or each.removed or each.relabelled or each.moved for each in self.parts
        )


def freeze_anew(old: Split, by: User | None = None, progress: Progress = UNWATCHED) -> Split:
    """Freeze the corpus of today with the criterion, shares and seed of ``old``, which stays as it is.

    Raises Unchanged where nothing has changed since, and LanguageError where ``old`` was frozen anew already.
    """
    require_last(old)
    progress.report(0, "parting the pairs")
    examples = plan_anew(old)
    progress.report(0.4, "comparing them with those of the split")
    if changes_between(old, examples).is_none:
        raise Unchanged(f"nothing has changed since {old} was frozen")
    progress.report(0.6, "writing the split")
    prepared = PreparedSplit(
        name_after(old),
        old.criterion,
        examples,
        old.seed or 0,
        proportions_of(old),
        old,
        old.tests_on_models,
    )
    with prepared, progress.writing():
        World.objects.hold().get(pk=old.world_id)
        require_last(old)  # nobody has done the same meanwhile
        frozen, _ = prepared.store(old.world, by)
        progress.conclude(report_of(frozen))
    return frozen


def require_last(old: Split) -> None:
    """Raise LanguageError where ``old`` was frozen anew already."""
    later = last_of(old)
    if later != old:
        raise LanguageError(f"{old} was frozen anew as {later}", hint="freeze that one anew")


def changes_since(old: Split) -> SplitChanges:
    """Return what ``freeze_anew`` would change. Raises LanguageError where nothing is left to freeze."""
    return changes_between(old, plan_anew(old))


def plan_anew(old: Split) -> list[Example]:
    """Return the examples of the split that ``freeze_anew`` would make, each with its part and position."""
    criterion = Criterion(old.criterion)
    examples = _examples_of_today(old)
    items = as_items(examples)
    kept = {**kept_in_training(items, criterion), **_parts_to_keep(old, items, criterion)}
    parts = split(items, criterion, proportions_of(old), old.seed or 0, kept)
    # A published part may share something with another one; it stays as it was published.
    as_published = (Part(each.part) if each.part else None for each in examples)
    parts_now = [was or part for was, part in zip(as_published, parts, strict=True)]
    return assign_parts(examples, parts_now, old.tests_on_models)


def last_of(old: Split) -> Split:
    """Return the newest split that was frozen anew from ``old``; ``old`` itself if none was."""
    seen = {old.pk}
    newest = old
    while later := newest.followed_by.exclude(pk__in=seen).order_by("-pk").first():
        seen.add(later.pk)
        newest = later
    return newest


def is_from_import(old: Split) -> bool:
    """Return whether the pairs of ``old``, or of a split that it follows, were imported."""
    seen: set[int] = set()
    while old.follows is not None and old.pk not in seen:
        seen.add(old.pk)
        old = old.follows
    return old.seed is None


def proportions_of(old: Split) -> tuple[float, ...]:
    """Return the shares that were asked for. If nobody noted them, return those of its parts."""
    if old.proportions:
        return tuple(old.proportions)
    sizes = [old.examples.filter(part=part).count() for part in Part]
    total = sum(sizes)
    return tuple(size / total for size in sizes) if total else DEFAULT_PROPORTIONS


def name_after(old: Split) -> str:
    """Return the name of the first split of the series with the next free number, from 2."""
    first = old
    seen = {old.pk}
    while first.follows is not None and first.follows_id not in seen:
        first = first.follows
        seen.add(first.pk)
    taken = set(old.world.splits.values_list("name", flat=True))
    endings = (f"-{number}" for number in count(2))
    names = (first.name[: LONGEST_NAME - len(ending)] + ending for ending in endings)
    return next(name for name in names if name not in taken)


def changes_between(old: Split, examples: Iterable[Example]) -> SplitChanges:
    """Compare the examples of ``old`` with planned ones, utterance by utterance."""
    columns = ("source", "utterance", "logical_form", "part")
    before = _labels(old.examples.order_by().values_list(*columns).iterator(chunk_size=BATCH))
    now = _labels((each.source, each.utterance, each.logical_form, each.part) for each in examples)
    counts: dict[str, Counter[str]] = {part: Counter() for part in Part}
    relabelled: list[RelabelledExample] = []
    for said in before.keys() | now.keys():
        was, is_now = before.get(said, ()), now.get(said, ())
        if was != is_now:
            relabelled += _count_changes(said, list(was), list(is_now), counts)
    parts = (PartChanges(part, *(counts[part][what] for what in KINDS_OF_CHANGE)) for part in Part)
    return SplitChanges(tuple(parts), tuple(sorted(relabelled, key=lambda each: each.utterance)))


# Form and part of each example that says one thing, in order.
Labels = tuple[tuple[str, str], ...]


def _labels(rows: Iterable[tuple[str, str, str, str]]) -> dict[Said, Labels]:
    labels: dict[Said, Labels] = {}
    for source, utterance, form, part in rows:
        said = source == Source.GENERATED, utterance
        labels[said] = (*labels.get(said, ()), (form, part))
    return {said: tuple(sorted(each)) for said, each in labels.items()}


def _count_changes(
    said: Said,
    was: list[tuple[str, str]],
    is_now: list[tuple[str, str]],
    counts: Mapping[str, Counter[str]],
) -> list[RelabelledExample]:
    """Count what became of the examples with one utterance; return those with another label."""
    for example in list(was):
        if example in is_now:
            was.remove(example)
            is_now.remove(example)
    for form, part in list(was):  # the same label in another part
        if same := next((each for each in is_now if each[0] == form), None):
            was.remove((form, part))
            is_now.remove(same)
            counts[same[1]]["moved"] += 1
    relabelled = []
    for (before, part), (now, part_now) in zip(was, is_now, strict=False):
        counts[part_now]["relabelled"] += 1
        counts[part_now]["moved"] += part != part_now
        relabelled.append(RelabelledExample(said[1], part_now, before, now))
    for _, part in was[len(relabelled) :]:
        counts[part]["removed"] += 1
    for _, part in is_now[len(relabelled) :]:
        counts[part]["added"] += 1
    return relabelled


def _examples_of_today(old: Split) -> list[Example]:
    """Return what is to be split: the rows of the world, without parts.

    For an import, its pairs as they were published, with their parts, but where people have decided otherwise here;
    new are the utterances and paraphrases that people have labelled here. Generated commands that it lacks
    are not: they may be those of a part that was not published.
    """
    if not is_from_import(old):
        return list(candidates(old.world))
    today = candidates(old.world, only_edited=True)
    by_said: dict[Said, list[Example]] = defaultdict(list)
    for example in today:
        by_said[example.source == Source.GENERATED, example.utterance].append(example)
    frozen: dict[Said, list[Example]] = defaultdict(list)
    for row in old.examples.order_by("pk").iterator(chunk_size=BATCH):
        frozen[row.source == Source.GENERATED, row.utterance].append(row)
    # What people have deleted, do not accept, or have found to have no form stays out.
    rejected = old.world.paraphrases.exclude(status=ParaphraseStatus.ACCEPTED)
    deleted = history_of(Paraphrase).filter(world=old.world, history_type=DELETED)
    without_form = old.world.utterances.filter(
        status__in=(UtteranceStatus.UNKNOWN, UtteranceStatus.EXCLUDED)
    )
    texts = {
        *rejected.values_list("utterance", flat=True),
        *deleted.values_list("utterance", flat=True),
        *without_form.values_list("text", flat=True),
    }
    withdrawn = {(False, text) for text in texts}
    examples: list[Example] = []
    for said, rows in frozen.items():
        now = by_said.pop(said, None)
        if now is None:
            examples += [] if said in withdrawn else map(_copy, rows)
        elif {each.logical_form for each in rows} == {each.logical_form for each in now}:
            examples += map(_copy, rows)
        else:
            examples += now
    left = (each for rows in by_said.values() for each in rows)
    return [*examples, *(each for each in left if each.source != Source.GENERATED)]


def _copy(example: Example) -> Example:
    columns = (name for name in PreparedSplit.COLUMNS if name != "position")
    return Example(**{name: getattr(example, name) for name in columns})


def _parts_to_keep(old: Split, items: Sequence[SplitItem], criterion: Criterion) -> dict[str, Part]:
    """Return key → part for what ``old`` has already.

    A key goes where most of its examples are, and to the later part of two. A key that is new, since
    a label has changed, goes where its utterances were.
    """
    of_key: dict[str, Counter[str]] = defaultdict(Counter)
    of_said: dict[Said, str] = {}
    columns = ("part", "source", "utterance", "source_command", "logical_form")
    rows = old.examples.order_by("pk").values_list(*columns)
    for part, *texts in rows.iterator(chunk_size=BATCH):
        item = SplitItem(*texts)
        of_key[item.key(criterion)][part] += 1
        of_said.setdefault((item.source == Source.GENERATED, item.utterance), part)
    wanted: dict[str, Counter[str]] = defaultdict(Counter)
    for item in items:
        key = item.key(criterion)
        if key in of_key:
            wanted[key] = of_key[key]
        elif part_before := of_said.get((item.source == Source.GENERATED, item.utterance)):
            wanted[key][part_before] += 1
    order = list(Part)
    return {
        key: max(order, key=lambda part: (parts[part], order.index(part)))
        for key, parts in wanted.items()
    }
