"""The parser that asks a language model, with the nearest training pairs as examples."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import chain
from typing import Self

import numpy as np

from annotations.language.forms import UNKNOWN as UNKNOWN_FORM
from annotations.language.forms import Form, Unknown, canonical_text, read_or_none
from annotations.language.texts import Refusal
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.interface import (
    TRAINING,
    Candidate,
    Check,
    Knowledge,
    Observer,
    Pair,
    keep_going,
)
from parser_service.parsers.llm.chat_messages import (
    UNKNOWN,
    Choices,
    first_form,
    form_in,
    listed_in,
    messages_for,
    texts_in,
)
from parser_service.parsers.llm.config import LISTED, LanguageModelConfig
from parser_service.parsers.llm.mending import Mended, Mender, tokens_in, without_loose
from parser_service.parsers.model_server.asker import Asker
from parser_service.parsers.model_server.protocol import MOST_NAME, Question
from parser_service.parsers.nearest_pairs import PairKeeper, WordOverlap
from parser_service.parsers.server_address import problem_of, server
from parser_service.parsers.written_forms import canonical, in_order, written_actions

# The origins of a form that no training pair has: its actions have been seen, or it is the model's own.
COMPOSED, WRITTEN = "composed", "written"


class LanguageModel(PairKeeper):
    """Few-shot parsing: the nearest training pairs are shown to a language model as turns of a conversation
    (examples by similarity after Liu et al. 2022, "What Makes Good In-Context Examples for GPT-3?").

    *listed*: the model chooses among the forms of the nearest pairs and UNKNOWN. Where forms of training are
    sequences, it chooses their actions, one after the other. The server is given the list as a JSON schema, and what
    it answers is looked up in the list; an answer outside is no answer.
    *free*: the model writes a form, which is read as any other.

    Where the world may be known, what a model wrote is held to it (``mending``): what it does not have stays open.

    There is one candidate. Its score, 0, means nothing. A server may answer the same question otherwise
    another time, also at temperature 0 and with a seed; answers that came are kept, so that one run is
    the same whenever it is repeated.
    """

    name = "llm"
    version = 2
    protocols = (Protocol.STRICT, Protocol.DOMAIN)
    asks_a_server = True
    Config = LanguageModelConfig

    def __init__(
        self,
        config: LanguageModelConfig | None = None,
        seed: int = 0,
        knowledge: Knowledge | None = None,
    ):
        super().__init__(config, seed, knowledge)
        self._asker = Asker(server(), self.config.at_once)
        self._names: dict[str, None] = {}  # of models, as their server reports them, in order
        self.keep([])

    @property
    def answered_by(self) -> str:
        return ", ".join(self._names)[:MOST_NAME]

    def fit(
        self,
        train: Sequence[Pair],
        validation: Sequence[Pair] = (),
        observe: Observer | None = None,
    ) -> None:
        """Keep ``train`` and put one question to the server, so that what is wrong with it is known early.

        Raises Refusal where there is no pair, no server or no answer.
        """
        observe = observe or Observer()
        if not train:
            raise Refusal(
                "There is no training pair, so there is no example to show.", "no_training_pairs"
            )
        if problem := problem_of(self._asker.server):
            raise Refusal(problem, "no_language_model_server")
        if not self.config.model:
            raise Refusal(
                "model is empty. Name a model that the server has.", "hyperparameter_missing"
            )
        self.keep([(pair.utterance, pair.form) for pair in train])
        began = time.monotonic()
        self.predict([(validation or train)[0].utterance], 1, observe.check)
        for sentence in self._asker.dialect.learned:
            observe.log(sentence)
        observe.log(
            f"The server at {self._asker.server.name} answers with {self.answered_by}, the first time "
            f"in {time.monotonic() - began:.1f} s."
        )

    def once(self) -> Self:
        """Return this parser, which asks no question again that its server did not answer."""
        patience = replace(self._asker.server.patience, tries=1)
        self._asker = Asker(replace(self._asker.server, patience=patience), self.config.at_once)
        return self

    def predict(
        self, utterances: Sequence[str], beam_width: int = 1, check: Check = keep_going
    ) -> list[list[Candidate]]:
        """Return one candidate for each utterance, or none where the model chose none of the forms.

        Raises Refusal where the server does not answer each of them.
        """
        questions = self.questions(utterances)
        answers = self._asker.ask(questions, check)
        self._names |= dict.fromkeys(answer.model for answer in answers)
        return [
            self._read(answer.text, question, utterance)
            for answer, question, utterance in zip(answers, questions, utterances, strict=True)
        ]

    def keep(self, pairs: list[tuple[str, str]]) -> None:
        """Keep the utterances and forms that examples are taken from; nothing is asked."""
        # In alphabetical order, so that the order of the training pairs has no effect.
        self._pairs = sorted(set(pairs))
        self._forms = {form for _, form in self._pairs}
        actions = [written_actions(form) for form in self._forms]
        self._actions = {each for of_form in actions for each in of_form}
        self._most_actions = max(map(len, actions), default=1)
        self._mender = None
        if (predicates := self.knowledge.predicates) is not None:
            read = map(read_or_none, self._forms)
            forms = [form for form in read if form is not None]
            self._mender = Mender(forms, predicates, self.knowledge.ontology)
        self._overlap = WordOverlap(utterance for utterance, _ in self._pairs)

    def questions(self, utterances: Sequence[str]) -> list[Question]:
        """Return what the model is asked for each utterance: the nearest example comes last, next to it."""
        questions = []
        for utterance in utterances:
            overlap = self._overlap.with_all(utterance)  # [pairs]
            near = [self._pairs[place] for place in np.argsort(-overlap, kind="stable")]
            is_listed = self.config.decoding == LISTED
            forms = list(dict.fromkeys(form for _, form in near))[: self.config.forms]
            examples = near[: self.config.examples][::-1]
            if is_listed:
                examples = [pair for pair in examples if pair[1] in forms]
            choices = Choices.among(forms, self._most_actions) if is_listed else None
            messages = messages_for(
                utterance, examples, choices, self.knowledge.predicates, self._most_actions > 1
            )
            questions.append(
                Question(
                    self.config.model,
                    messages,
                    choices.schema if choices is not None else None,
                    self.seed,
                    self.config.max_tokens,
                )
            )
        return questions

    def _read(self, text: str, question: Question, utterance: str) -> list[Candidate]:
        """Return the form that the model means."""
        if question.schema is not None:
            return self._read_listed(texts_in(text), listed_in(question.schema), utterance)
        written = form_in(text)
        form = first_form(written)
        if form is None:
            return [self._candidate(canonical(written) or written)] if written else []
        return [self._candidate_of(self._mend(form, utterance))]

    def _read_listed(
        self, texts: Sequence[str], listed: Sequence[str], utterance: str
    ) -> list[Candidate]:
        """Return the form of the listed ``texts``, several where they are actions. An action that is none of the
        list stays open; there is no answer where none is, or where there are more than any form has."""
        by_form = {canonical(each) or each: each for each in listed}
        chosen = [self._choose(each, by_form, utterance) for each in texts]
        if not 1 <= len(chosen) <= self._most_actions or not any(chosen):
            return []
        parts = [each or Mended(UNKNOWN_FORM, ()) for each in chosen]
        if all(isinstance(each.form, Unknown) for each in parts):
            return [self._candidate(UNKNOWN)]
        form = without_loose(in_order([each.form for each in parts]))
        return [
            self._candidate_of(
                Mended(form, tuple(chain.from_iterable(each.values for each in parts)))
            )
        ]

    def _choose(self, text: str, listed: Mapping[str, str], utterance: str) -> Mended | None:
        """Return the listed form that ``text`` is, or that it is once mended; None where there is none."""
        chosen = listed.get(canonical(text) or text)
        if chosen is not None:
            form = read_or_none(chosen)
            return None if form is None else Mended(form, (None,) * tokens_in(form))
        form = read_or_none(text)
        mended = None if form is None else self._mend(form, utterance)
        return mended if mended is not None and canonical_text(mended.form) in listed else None

    def _mend(self, form: Form, utterance: str) -> Mended:
        if self._mender is None:
            return Mended(form, ())
        return self._mender.mend(form, utterance)

    def _candidate_of(self, mended: Mended) -> Candidate:
        """Return the candidate of a form; it has values where the model named entities that the utterance has."""
        candidate = self._candidate(canonical_text(mended.form))
        return replace(candidate, values=mended.values) if any(mended.values) else candidate

    def _candidate(self, form: str) -> Candidate:
        if form in self._forms:
            return Candidate(form, 0.0, TRAINING)
        if form == UNKNOWN:
            return Candidate(form, 0.0)
        is_composed = self._actions.issuperset(written_actions(form))
        return Candidate(form, 0.0, COMPOSED if is_composed else WRITTEN)
