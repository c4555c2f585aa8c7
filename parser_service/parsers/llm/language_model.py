"""The parser that asks a language model, with the nearest training pairs as examples."""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np

from annotations.language.errors import Refusal
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
from parser_service.parsers.llm.asker import Asker
from parser_service.parsers.llm.chat_messages import FORM, UNKNOWN, form_in, messages_for, schema_of
from parser_service.parsers.llm.config import LISTED, LanguageModelConfig
from parser_service.parsers.llm.protocol import MOST_NAME, Question
from parser_service.parsers.llm.server_address import problem_of, server
from parser_service.parsers.nearest_pairs import PairKeeper, WordOverlap
from parser_service.parsers.written_forms import canonical

WRITTEN = "written"  # the origin of a form that no training pair has


class LanguageModel(PairKeeper):
    """Few-shot parsing: the nearest training pairs are shown to a language model as turns of a conversation
    (examples by similarity after Liu et al. 2022, "What Makes Good In-Context Examples for GPT-3?").

    *listed*: the model chooses among the forms of the nearest pairs and UNKNOWN. The server is given them as
    a JSON schema, and what it answers is looked up in the list; an answer outside is no answer.
    *free*: the model writes a form, which is read as any other.

    There is one candidate. Its score, 0, means nothing. A server may answer the same question otherwise
    another time, also at temperature 0 and with a seed; answers that came are kept, so that one run is
    the same whenever it is repeated.
    """

    name = "llm"
    version = 1
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
            self._read(answer.text, question)
            for answer, question in zip(answers, questions, strict=True)
        ]

    def keep(self, pairs: list[tuple[str, str]]) -> None:
        """Keep the utterances and forms that examples are taken from; nothing is asked."""
        # In alphabetical order, so that the order of the training pairs has no effect.
        self._pairs = sorted(set(pairs))
        self._forms = {form for _, form in self._pairs}
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
            choices = forms if is_listed else None
            questions.append(
                Question(
                    self.config.model,
                    messages_for(utterance, examples, choices, self.knowledge.predicates),
                    schema_of(forms) if is_listed else None,
                    self.seed,
                    self.config.max_tokens,
                )
            )
        return questions

    def _read(self, text: str, question: Question) -> list[Candidate]:
        """Return the form that the model means."""
        written = form_in(text)
        form = canonical(written)
        if question.schema is not None:
            listed = question.schema["properties"][FORM]["enum"]
            by_form = {canonical(each) or each: each for each in listed}
            chosen = by_form.get(form or written)
            return [] if chosen is None else [self._candidate(chosen)]
        return [self._candidate(form or written)] if written else []

    def _candidate(self, form: str) -> Candidate:
        if form in self._forms:
            return Candidate(form, 0.0, TRAINING)
        return Candidate(form, 0.0, "" if form == UNKNOWN else WRITTEN)
