"""The forms that a parser learns to write, and those that it may write."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import Any, Self

from annotations.language.forms import Form, read_form
from annotations.language.texts import Refusal
from parser_service.neural.t5.automaton import Automaton
from parser_service.neural.t5.network import EncoderDecoder
from parser_service.neural.t5.rules import Rules
from parser_service.neural.t5.spelling import spell, try_to_spell
from parser_service.parsers.generation import generate_candidates
from parser_service.parsers.interface import TRAINING, Check, Knowledge, Pair

SHORTEST_ATOM = 2  # bytes of an atom in corpus notation, on average over any form


class Trie:
    """Sequences of tokens by their beginnings. Each ends with the token that ends a form."""

    def __init__(self, sequences: Iterable[Sequence[int]]):
        self._root: dict[int, dict] = {}  # type: ignore[type-arg]
        for sequence in sequences:
            node = self._root
            for token in sequence:
                node = node.setdefault(token, {})

    def continuations(self, tokens: Sequence[int]) -> list[int]:
        """Return what follows ``tokens`` in a sequence; nothing where no sequence begins so."""
        node = self._root
        for token in tokens:
            node = node.get(token, {})
        return list(node)


@dataclass(frozen=True, slots=True)
class Targets:
    """What may be written.

    ``origins`` are those of the training pairs' forms and of listed ones, by form; ``longest`` is the
    number of atoms of the longest of them; ``rules`` tell what else is a form of this domain.
    """

    origins: Mapping[str, str]
    longest: int
    rules: Rules

    @classmethod
    def of(cls, train: Sequence[Pair], knowledge: Knowledge, is_listed: bool, check: Check) -> Self:
        """Return the targets of training pairs; under *domain* those that are listed are more than theirs.
        Raises Refusal where no pair has a form."""
        forms = _readable({pair.form for pair in train})
        if not forms:
            raise Refusal(
                "No training pair has a form that can be read, so there is nothing to learn.",
                "no_training_pairs",
            )
        origins = dict.fromkeys(forms, TRAINING)
        rules = Rules.of(list(forms.values()), knowledge.predicates)
        if is_listed and knowledge.predicates is not None:
            new = generate_candidates(train, knowledge, check=check).new
            origins |= {each.form: each.main_step for each in new if each.form not in forms}
            forms |= _readable(origins)
        longest = max(len(spell(form)) for form in forms.values())
        return cls({text: origins[text] for text in forms}, longest, rules)

    def atoms(self) -> list[str]:
        """Return the atoms that all of it is spelled with."""
        spelled = (spell(read_form(text)) for text in self.origins)
        return sorted({*chain.from_iterable(spelled), *Automaton(self.rules).atoms})

    def fitted_to(self, network: EncoderDecoder) -> Self:
        """Return what of it ``network`` can write. Raises Refusal where a form of the
        training pairs is too long."""
        most = network.most_written - 1  # and the end of the form
        kept = {
            text: origin
            for text, origin in self.origins.items()
            if self.longest <= most or len(spell(read_form(text))) <= most
        }
        for text in self.origins.keys() - kept.keys():
            if self.origins[text] == TRAINING:
                raise Refusal(
                    f"This network writes at most {most} tokens, but a form of the training pairs "
                    f"has more: {text[:100]}… Use another network.",
                    "form_too_long_for_network",
                )
        rules = replace(self.rules, longest=min(self.rules.longest, most * SHORTEST_ATOM))
        return replace(self, origins=kept, longest=min(self.longest, most), rules=rules)

    def limits(self, decoding: str, network: EncoderDecoder) -> Automaton | Trie | None:
        """Return what ``decoding`` allows; None for anything."""
        if decoding == "typed":
            return Automaton(self.rules)
        if decoding == "listed":
            return Trie(network.write(spell(read_form(text))) for text in self.origins)
        return None

    def to_json(self) -> dict[str, Any]:
        return {
            "origins": dict(self.origins),
            "longest": self.longest,
            "rules": self.rules.to_json(),
        }

    @classmethod
    def read(cls, values: Mapping[str, Any]) -> Self:
        """Return what ``to_json`` wrote."""
        return cls(values["origins"], values["longest"], Rules.read(values["rules"]))


def _readable(texts: Iterable[str]) -> dict[str, Form]:
    """Return the forms by their texts, sorted; texts that are not whole forms are left out."""
    return {text: read_form(text) for text in sorted(texts) if try_to_spell(text) is not None}
