"""The grammar oracle: chart-parses a command with the annotated grammar it was generated from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from annotations.language.anonymizer import Anonymizer
from annotations.language.expansion import TaskCategory
from annotations.language.grammar import Grammar, print_production, read_production
from annotations.language.ontology import Ontology, read_ontology, write_ontology
from annotations.language.template_chart import TemplateChart
from annotations.language.templates import print_template, read_template
from parser_service.parsers.config_fields import validate
from parser_service.parsers.interface import (
    Candidate,
    Check,
    Knowledge,
    Observer,
    Pair,
    Parser,
    keep_going,
)
from parser_service.parsers.storage import open_sealed, read_json, seal, write_json

GRAMMAR, ONTOLOGY = "grammar.json", "ontology.json"


@dataclass(frozen=True)
class OracleConfig:
    """There is nothing to choose."""

    def __post_init__(self) -> None:
        validate(self)


class GrammarOracle(Parser):
    """Returns the form of the template that derives the command (Walker et al. 2019, baselines).

    Right on every generated command by construction, without an answer for any other. A command
    with entities in it is read once more with their class tokens. Learns nothing from pairs: it is
    the annotated grammar and the ontology of ``Knowledge``, and a saved one carries a copy of both.
    """

    name = "grammar-oracle"
    version = 2
    protocols = ("grammar",)
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
        self._anonymizer = Anonymizer(self.knowledge.ontology or Ontology(()))

    def fit(
        self,
        train: Sequence[Pair] = (),
        validation: Sequence[Pair] = (),
        observe: Observer | None = None,
    ) -> None:
        """Learns nothing. Raises ValueError where there is no template to parse with."""
        if not any(category.templates for category in self._categories):
            raise ValueError(
                "The grammar oracle parses with templates over a grammar, and it was given none. "
                "Import or write templates in this world and run it under the grammar protocol."
            )

    def predict(
        self, utterances: Sequence[str], beam_width: int = 1, check: Check = keep_going
    ) -> list[list[Candidate]]:
        """The forms of all derivations, the one that generation keeps first; none outside the
        grammar. The score is minus the rank, from 0."""
        answers = []
        for utterance in utterances:
            check()
            forms = self._forms(utterance) or self._forms(
                self._anonymizer.anonymize(utterance).text
            )
            answers.append([Candidate(form, -rank) for rank, form in enumerate(forms[:beam_width])])
        return answers

    def _forms(self, text: str) -> list[str]:
        derivations = self._chart.parse(" ".join(text.replace(",", " , ").split()))
        return list(dict.fromkeys(derivation.form_text for derivation in derivations))

    def save(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        write_json(folder / GRAMMAR, [_printed(category) for category in self._categories])
        write_json(folder / ONTOLOGY, write_ontology(self.knowledge.ontology or Ontology(())))
        seal(folder, self, [GRAMMAR, ONTOLOGY])

    @classmethod
    def load(cls, folder: Path, knowledge: Knowledge | None = None) -> Self:
        """The saved oracle with its own copies, whatever ``knowledge`` says today."""
        saved = open_sealed(folder, cls, [GRAMMAR, ONTOLOGY])
        grammar = tuple(_read(category) for category in read_json(folder / GRAMMAR))
        files = {name: text.encode() for name, text in read_json(folder / ONTOLOGY).items()}
        ontology, _ = read_ontology(files)
        return cls(saved.config, saved.seed, Knowledge(ontology=ontology, grammar=grammar))

    def parameters(self) -> int:
        return 0


def _printed(category: TaskCategory) -> dict[str, Any]:
    return {
        "name": category.name,
        "productions": [print_production(each) for each in category.grammar.productions],
        "templates": [print_template(each) for each in category.templates],
    }


def _read(category: Mapping[str, Any]) -> TaskCategory:
    return TaskCategory(
        category["name"],
        Grammar(tuple(read_production(line) for line in category["productions"])),
        tuple(read_template(line) for line in category["templates"]),
    )
