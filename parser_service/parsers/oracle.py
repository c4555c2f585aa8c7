"""The grammar oracle, a chart parser with the annotated grammar that commands are generated from."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Self

from annotations.language.grammar import (
    CHECK_STEPS,
    Budget,
    Grammar,
    TooManyCombinations,
    print_production,
    read_production,
)
from annotations.language.grounding import HeardLattice, HearingReader
from annotations.language.plans import Islands
from annotations.language.templates import (
    ChartDerivation,
    TaskCategory,
    TemplateChart,
    print_template,
    read_template,
)
from annotations.language.texts import Refusal, normalise_line
from annotations.language.world import Ontology, read_ontology, write_ontology
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.hyperparameters.fields import validate
from parser_service.parsers.interface import (
    Candidate,
    Check,
    Knowledge,
    Observer,
    Pair,
    Parser,
    keep_going,
)
from parser_service.parsers.remembering import remembered
from parser_service.parsers.storage import open_sealed, read_json, seal, write_json

GRAMMAR_FORM = "grammar"  # the origin of all its forms
GRAMMAR, ONTOLOGY = "grammar.json", "ontology.json"
# One that is no command is looked at again at once, to find its commands.
REMEMBERED_UTTERANCES = 32


@dataclass(frozen=True)
class OracleConfig:
    """The oracle has no hyperparameters."""

    def __post_init__(self) -> None:
        validate(self)


class GrammarOracle(Parser):
    """Returns the form of the template that derives the command (Walker et al. 2019, baselines).

    It is right on every generated command by construction and has no answer for what is no command. An
    utterance is read as it is, then with its entities as class tokens, then in every way that
    ``UtteranceReader`` knows, and last through the noise of recognisers and hurried people (``HearingReader``); the
    first of these that the grammar derives counts. It learns nothing from
    pairs: it consists of the annotated grammar and the ontology of ``Knowledge``, and saves a copy of both.
    """

    name = "grammar-oracle"
    version = 6
    reads = (2, 3, 4, 5)
    protocols = (Protocol.GRAMMAR,)
    Config = OracleConfig

    def __init__(
        self,
        config: OracleConfig | None = None,
        seed: int = 0,
        knowledge: Knowledge | None = None,
    ):
        """Raises LanguageError where the grammar has a cycle."""
        super().__init__(config, seed, knowledge)
        self._categories = tuple(self.knowledge.grammar or ())
        self._chart = TemplateChart(self._categories)
        ontology = self.knowledge.ontology or Ontology(())
        self.reader = HearingReader(ontology, self.vocabulary)

    def fit(
        self,
        train: Sequence[Pair] = (),
        validation: Sequence[Pair] = (),
        observe: Observer | None = None,
    ) -> None:
        """Check that there is a template to parse with; nothing is learned. Raises Refusal."""
        if not any(category.templates for category in self._categories):
            raise Refusal(
                "The grammar oracle parses with templates over a grammar, and it was given none. "
                "Import or write templates in this world and run it under the grammar protocol.",
                "no_templates",
            )

    def predict(
        self, utterances: Sequence[str], beam_width: int = 1, check: Check = keep_going
    ) -> list[list[Candidate]]:
        """Return the forms of the best derivations, first the one that generation keeps; none outside the
        grammar.

        The score is 0 for the very command, and less by what is read otherwise than it is written."""
        answers = []
        for utterance in utterances:
            check()
            answers.append(self._candidates(normalise_line(utterance))[:beam_width])
        return answers

    def _candidates(self, utterance: str) -> list[Candidate]:
        return self._look_up(utterance)[0]

    @remembered(REMEMBERED_UTTERANCES)
    def _look_up(self, utterance: str) -> tuple[list[Candidate], list[HeardLattice]]:
        """Return the candidates for an utterance and the lattices that were looked at: all where there is none."""
        looked_at: list[HeardLattice] = []
        for heard in self.reader.lattices(utterance):
            looked_at.append(heard)
            found: dict[tuple[str, tuple[str | None, ...]], Candidate] = {}
            for each in self._parse(heard):
                values = heard.values(each.arcs)
                key = each.form_text, values if any(values) else ()
                if key not in found:
                    found[key] = Candidate(
                        *(each.form_text, 0.0 - each.cost, GRAMMAR_FORM),
                        values=key[1],
                        heard=heard.heard(each.path),
                    )
            if found:
                return list(found.values()), looked_at
        return [], looked_at

    @property
    def vocabulary(self) -> frozenset[str]:
        """The words of all commands."""
        return self._chart.vocabulary

    def understands(self, utterance: str) -> bool:
        """Return whether an utterance is one command."""
        return bool(self._candidates(normalise_line(utterance)))

    def islands(self, utterance: str) -> Iterator[Islands]:
        """Yield the parts of an utterance that may be one command each, for each way to read it, the strictest first.

        A few are none: see ``TemplateChart.spans``.
        """
        candidates, lattices = self._look_up(utterance)
        for heard in self.reader.lattices(utterance) if candidates else lattices:
            if heard.tokens:
                spans = self._chart.spans(heard.lattice, Budget(CHECK_STEPS))
                yield Islands(
                    frozenset(
                        (heard.tokens[start][0], heard.tokens[end - 1][1]) for start, end in spans
                    ),
                    frozenset((each.start, each.end) for each in heard.spans),
                    frozenset(each.casefold() for each in self._chart.beginnings),
                )

    def _parse(self, heard: HeardLattice) -> list[ChartDerivation]:
        """Return the derivations; none where that takes too many steps. A competition's commands take up to 26,000."""
        try:
            return self._chart.parse(heard.lattice, Budget(CHECK_STEPS))
        except TooManyCombinations:
            return []

    def save(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        grammar = [
            {
                "name": category.name,
                "productions": [print_production(each) for each in category.grammar.productions],
                "templates": [print_template(each) for each in category.templates],
            }
            for category in self._categories
        ]
        write_json(folder / GRAMMAR, grammar)
        write_json(folder / ONTOLOGY, write_ontology(self.knowledge.ontology or Ontology(())))
        seal(folder, self, [GRAMMAR, ONTOLOGY])

    @classmethod
    def load(cls, folder: Path, knowledge: Knowledge | None = None) -> Self:
        """Load the saved oracle with its own grammar and ontology, whatever ``knowledge`` is now."""
        saved = open_sealed(folder, cls, [GRAMMAR, ONTOLOGY])
        grammar = tuple(
            TaskCategory(
                category["name"],
                Grammar(tuple(read_production(line) for line in category["productions"])),
                tuple(read_template(line) for line in category["templates"]),
            )
            for category in read_json(folder / GRAMMAR)
        )
        files = {name: text.encode() for name, text in read_json(folder / ONTOLOGY).items()}
        ontology, _ = read_ontology(files)
        return cls(saved.config, saved.seed, Knowledge(ontology=ontology, grammar=grammar))

    def parameters(self) -> int:
        return 0
