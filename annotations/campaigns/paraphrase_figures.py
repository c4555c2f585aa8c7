"""Figures of the accepted paraphrases of a world: how many, how far from their prompts, how many words.

People and language models are told apart. Everything is counted in one pass over the paraphrases.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from django.db.models import Count

from annotations.language.corpus import expected_vocabulary, vocabulary_growth
from annotations.language.texts import folded_words
from annotations.models import Campaign, World
from annotations.models.campaigns import ContributorKind
from annotations.rows.kept import keep

TARGET_PER_FORM, MOST_WANTED = 10, 1_000
SAMPLE = 100  # paraphrases whose vocabulary is compared
MOST_POINTS = 40  # of a curve


@dataclass(frozen=True, slots=True)
class Bins:
    """Bins of equal ``width`` from 0; the last one is open."""

    width: float
    count: int

    @property
    def starts(self) -> list[float]:
        return [round(number * self.width, 6) for number in range(self.count)]

    def counts(self, values: Iterable[float]) -> tuple[int, ...]:
        """Return how many values each bin has."""
        # 0.3 / 0.1 is a little less than 3.
        of_bin = Counter(min(int(each / self.width + 1e-9), self.count - 1) for each in values)
        return tuple(of_bin[number] for number in range(self.count))


EDIT_BINS, JACCARD_BINS = Bins(5, 17), Bins(0.1, 10)


@dataclass(frozen=True, slots=True)
class PublishedMeans:
    """Means of the corpus of the paper (docs/reference/formats.md, Triples)."""

    count: int = 1_923
    edits: float = 28.02
    jaccard: float = 0.59


@dataclass(frozen=True, slots=True)
class ParaphrasesBy:
    """The paraphrases of people, or of models. Means are None without any.

    Attributes:
        edits: mean Levenshtein distance to the prompt, in characters; ``edit_counts`` go with ``EDIT_BINS``.
        jaccard: mean Jaccard distance of the words, in 0–1; ``jaccard_counts`` go with ``JACCARD_BINS``.
        words: different ones in all.
        sample_words: different ones that ``ParaphraseFigures.sample`` paraphrases have on average.
        growth: different words after each paraphrase, in order of arrival.
    """

    count: int
    edits: float | None
    jaccard: float | None
    edit_counts: tuple[int, ...]
    jaccard_counts: tuple[int, ...]
    words: int
    sample_words: float | None
    growth: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class CategoryCount:
    """Paraphrases of the forms of a task category, whose name may be empty; ``short`` forms lack some."""

    name: str
    forms: int
    short: int
    people: int
    models: int


@dataclass(frozen=True, slots=True)
class ParaphraseFigures:
    """``sample`` is the number of paraphrases whose vocabulary is compared; 0 where one side has none. ``age`` is the
    seconds since they were counted."""

    people: ParaphrasesBy
    models: ParaphrasesBy
    categories: tuple[CategoryCount, ...]
    target: int
    sample: int
    published: PublishedMeans = PublishedMeans()
    age: float = 0

    @property
    def minutes_old(self) -> int:
        return int(self.age / 60)

    @property
    def count(self) -> int:
        return self.people.count + self.models.count

    @property
    def forms(self) -> int:
        return sum(each.forms for each in self.categories)

    @property
    def short(self) -> int:
        return sum(each.short for each in self.categories)

    @property
    def growth_at(self) -> list[int]:
        """The numbers of paraphrases at which the growth of vocabulary is drawn, evenly up to the largest."""
        longest = max(self.people.count, self.models.count)
        step = max(1, -(-longest // MOST_POINTS))
        return sorted({*range(step, longest + 1, step), self.people.count, self.models.count} - {0})


@dataclass(frozen=True, slots=True)
class FormCount:
    """The accepted paraphrases of a form, and how many it still ``lacks``."""

    form: str
    task_category: str
    people: int
    models: int
    lacks: int

    @property
    def count(self) -> int:
        return self.people + self.models


def figures_of(world: World, campaign: Campaign | None = None) -> ParaphraseFigures:
    """Return the figures of the accepted paraphrases of ``world``, or of those that came by ``campaign``.

    A form is short where it has fewer than the target of the campaign, or ``TARGET_PER_FORM``, counting
    the paraphrases of the world. Figures of very many paraphrases are kept for a while.
    """
    key = ("paraphrase figures", world.pk, campaign and campaign.pk, target_of(campaign))
    found = keep(key, partial(_count, world, campaign), lambda figures: figures.count)
    return replace(found.value, age=found.age)


def _count(world: World, campaign: Campaign | None) -> ParaphraseFigures:
    import pandas

    accepted = world.paraphrases.accepted().order_by("position")
    chosen = accepted if campaign is None else accepted.filter(contributor__campaign=campaign)
    columns = ("utterance", "edit_distance", "jaccard_distance", "logical_form")
    rows = chosen.values_list(*columns, "contributor__kind")
    said = pandas.DataFrame(rows, columns=[*columns, "kind"])
    said["models"] = said.kind == ContributorKind.MODEL
    said["people"] = ~said.models
    people, models = said[said.people], said[said.models]
    sample = min(SAMPLE, len(people), len(models))
    counted = form_counts(world, campaign)
    category_of = {each.form: each.task_category for each in counted}
    forms = pandas.DataFrame(
        [(each.task_category, 1, each.lacks > 0) for each in counted],
        columns=["task_category", "forms", "short"],
    )
    said["task_category"] = [category_of.get(form, "") for form in said.logical_form]
    categories = pandas.concat([forms, said]).groupby("task_category")
    counts = categories[["forms", "short", "people", "models"]].sum().astype(int)
    return ParaphraseFigures(
        people=_summary(people, sample),
        models=_summary(models, sample),
        categories=tuple(CategoryCount(*row) for row in counts.itertuples()),
        target=target_of(campaign),
        sample=sample,
    )


def target_of(campaign: Campaign | None) -> int:
    return TARGET_PER_FORM if campaign is None else campaign.target_per_form


def form_counts(
    world: World, campaign: Campaign | None = None, target: int | None = None
) -> list[FormCount]:
    """Return the forms of ``world``, or those that ``campaign`` asks for, those that lack most first.

    Forms that only paraphrases have are among them. All accepted paraphrases of the world count.
    """
    target = target_of(campaign) if target is None else target
    accepted = world.paraphrases.accepted().order_by()
    counts: dict[str, Counter[bool]] = defaultdict(Counter)
    grouped = accepted.values_list("logical_form", "contributor__kind").annotate(Count("pk"))
    for form, kind, count in grouped:
        counts[form][kind == ContributorKind.MODEL] += count
    if campaign is None:
        category_of = dict.fromkeys(counts, "")
        category_of |= dict(world.logical_forms.order_by().values_list("text", "task_category"))
    else:
        prompts = campaign.prompts.filter(check_words="").order_by()
        category_of = dict(prompts.values_list("logical_form", "task_category"))
    rows = (
        FormCount(
            form,
            category,
            counts[form][False],
            counts[form][True],
            max(0, target - counts[form].total()),
        )
        for form, category in category_of.items()
    )
    return sorted(rows, key=lambda row: (-row.lacks, row.task_category, row.form))


def _summary(rows: Any, sample: int) -> ParaphrasesBy:
    words = [folded_words(said) for said in rows.utterance]
    growth = vocabulary_growth(words)
    return ParaphrasesBy(
        count=len(rows),
        edits=rows.edit_distance.mean() if len(rows) else None,
        jaccard=rows.jaccard_distance.mean() if len(rows) else None,
        edit_counts=EDIT_BINS.counts(rows.edit_distance),
        jaccard_counts=JACCARD_BINS.counts(rows.jaccard_distance),
        words=growth[-1] if growth else 0,
        sample_words=expected_vocabulary(words, sample) if sample else None,
        growth=tuple(growth),
    )
