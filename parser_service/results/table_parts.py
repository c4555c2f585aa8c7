"""What an accuracy table is made of: columns, rows and the words for them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby
from typing import Any, TypeAlias

from django.utils.http import urlencode

from annotations.language.corpus import Criterion
from annotations.models import Split
from parser_service.models import TrainingRun
from parser_service.parsers.conditions import Protocol, in_short, in_words
from parser_service.parsers.registry import parsers, title_of
from parser_service.results.accuracy_cells import Cell
from parser_service.results.measures import Measure

# What distinguishes the splits of one corpus, in a word.
SHORT_CRITERIA = {
    Criterion.COMMAND: "command",
    Criterion.SOURCE_COMMAND: "source",
    Criterion.LOGICAL_FORM: "form",
}
APART = {
    Criterion.COMMAND: "a command",
    Criterion.SOURCE_COMMAND: "a source command",
    Criterion.LOGICAL_FORM: "a logical form",
}
WHAT_IT_KNOWS = {
    Protocol.STRICT: "Training pairs only.",
    Protocol.DOMAIN: "The declared predicates and the ontology are known too, as on a robot.",
    Protocol.GRAMMAR: "The annotated grammar and all its forms are known too: also the prompts and the forms of "
    "the paraphrases that a split by form holds out.",
}

# A sign behind the names of parsers whose figures it qualifies, and what it says.
MARK = "†"
MAY_KNOW_CORPORA = (
    "Answers of a language model, which may have read a public corpus, its test part too, before it was asked "
    "here."
)

Changes: TypeAlias = "tuple[tuple[str, Any], ...]"


@dataclass(frozen=True, slots=True)
class TableColumn:
    """One setting on one split; ``starts_group`` at the first split of a setting.

    ``label`` names the split: by its criterion where that tells the splits of the table apart, which
    ``explanation`` spells out.
    """

    train_sources: str
    test_source: str
    split: Split
    label: str
    starts_group: bool = False

    @property
    def setting(self) -> tuple[str, str]:
        return self.train_sources, self.test_source

    @property
    def explanation(self) -> str:
        apart = APART[Criterion(self.split.criterion)]
        return f"Split {self.split.name}: no two parts share {apart}"

    @property
    def query(self) -> str:
        """The address of its learning curves, without part and protocol."""
        return urlencode({"split": self.split.name, "setting": "-".join(self.setting)})

    def shows(self, run: TrainingRun) -> bool:
        """Tell whether a score of ``run`` belongs here."""
        return run.split_id == self.split.pk and run.train_sources == self.train_sources


@dataclass(frozen=True, slots=True)
class TableRow:
    """A parser with one configuration; ``changes`` are the hyperparameters that are not the default.

    ``cells`` stand in the order of the table's columns, None where nobody has trained.
    """

    parser: str
    changes: Changes
    cells: tuple[Cell | None, ...]

    @property
    def title(self) -> str:
        return title_of(self.parser)


@dataclass(frozen=True, slots=True)
class SettingHead:
    """The head over the ``width`` columns of one setting."""

    train_sources: str
    test_source: str
    width: int

    @property
    def notation(self) -> str:
        return f"{self.train_sources} → {self.test_source}"

    @property
    def trained(self) -> str:
        return f"trained on {in_short(self.train_sources)},"

    @property
    def tested(self) -> str:
        return f"tested on {in_short(self.test_source)}"

    @property
    def explanation(self) -> str:
        """In full words, with the notation."""
        trained, tested = in_words(self.train_sources), in_words(self.test_source)
        return f"Trained on {trained}, tested on {tested}: {self.notation}"


@dataclass(frozen=True, slots=True)
class AccuracyTable:
    """All rows of one protocol, by one or more measures. The best of a column is the best among them."""

    protocol: str
    columns: tuple[TableColumn, ...]
    rows: tuple[TableRow, ...]
    measures: tuple[Measure, ...] = (Measure.EXACT,)

    @property
    def sentence(self) -> str:
        return WHAT_IT_KNOWS[Protocol(self.protocol)]

    @property
    def settings(self) -> list[SettingHead]:
        """The heads over the columns, one for each setting."""
        grouped = groupby(self.columns, key=lambda column: column.setting)
        return [SettingHead(train, test, len(list(columns))) for (train, test), columns in grouped]

    @property
    def is_active(self) -> bool:
        return any(cell and cell.active for row in self.rows for cell in row.cells)

    @property
    def is_scored(self) -> bool:
        return any(cell and cell.score for row in self.rows for cell in row.cells)

    @property
    def is_by_criterion(self) -> bool:
        """Whether the columns are named after the criteria of their splits."""
        return any(column.label in SHORT_CRITERIA.values() for column in self.columns)

    @property
    def is_published(self) -> bool:
        """Whether the paper has a figure for one of the cells."""
        cells = (cell for row in self.rows for cell in row.cells)
        return any(cell and cell.published is not None for cell in cells)

    @property
    def filled(self) -> list[tuple[TableRow, list[tuple[TableColumn, Cell | None]]]]:
        """Each row with its cells beside their columns."""
        return [(row, list(zip(self.columns, row.cells, strict=True))) for row in self.rows]


def marked(title: str, parser: str) -> str:
    """Return what a parser is called with the sign that a footnote explains, if it bears one."""
    return f"{title} {MARK}" if may_know_corpora(parser) else title


def may_know_corpora(parser: str) -> bool:
    """Return whether a parser may have read a public corpus before anybody trained it here."""
    return parser in parsers() and parsers()[parser].may_know_corpora
