"""The sequence-to-sequence parser of Walker et al. 2019."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Self

import torch
from torch import Tensor

from annotations.language.texts import Refusal
from parser_service.neural.device import full_fp32, processor, threads
from parser_service.neural.seq2seq.batches import NumberedPair, contexts, sources
from parser_service.neural.seq2seq.beam import Hypothesis, search
from parser_service.neural.seq2seq.epochs import (
    FILES,
    Training,
    ValidationResult,
    load_training,
    save_training,
    validation_loss,
)
from parser_service.neural.seq2seq.lstm import Seq2SeqModel
from parser_service.neural.seq2seq.vocabulary import Vocabulary
from parser_service.neural.training import resume
from parser_service.neural.weights import WEIGHTS, load_weights, save_weights
from parser_service.neural.word_vectors.scalar_mix import ContextShape
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.hyperparameters.seq2seq import Seq2SeqConfig
from parser_service.parsers.interface import (
    Candidate,
    Check,
    EpochReport,
    Knowledge,
    Observer,
    Pair,
    Parser,
    ScoreKind,
    keep_going,
)
from parser_service.parsers.storage import open_sealed, read_json, seal, write_json
from parser_service.parsers.words import words
from parser_service.parsers.written_forms import canonical_or_same

VOCABULARY = "vocabulary.json"
SAVED = (VOCABULARY, WEIGHTS)
PREDICTION_BATCH = 64
SLACK = 10  # tokens that a form may be longer than the longest one seen


class Seq2Seq(Parser):
    """Reads words and writes the tokens of the form; both vocabularies come from the training pairs.

    Adam on the cross entropy, early stopping on the exact match of the validation pairs under beam
    search; the parser keeps the weights of the best epoch. Candidates are scored by log-probability.
    """

    name = "seq2seq"
    version = 1
    protocols = (Protocol.STRICT,)
    score_kind = ScoreKind.LOG_PROBABILITY
    Config = Seq2SeqConfig

    def __init__(
        self,
        config: Seq2SeqConfig | None = None,
        seed: int = 0,
        knowledge: Knowledge | None = None,
    ):
        super().__init__(config, seed, knowledge)
        self._generator = torch.Generator().manual_seed(seed)
        self._shape: ContextShape | None = None
        self._prepare(Vocabulary(()), Vocabulary(()), longest=0)

    def fit(
        self,
        train: Sequence[Pair],
        validation: Sequence[Pair] = (),
        observe: Observer | None = None,
    ) -> None:
        observe = observe or Observer()
        if not train:
            raise Refusal(
                "There is no training pair, so there is nothing to learn from.", "no_training_pairs"
            )
        self._read_vocabularies(train)
        training = Training(self._model, self.config, self._generator)
        resume(observe, self._check_checkpoint, lambda folder: load_training(folder, training))
        with threads(self.config.threads):
            while not training.is_over():
                self._train_epoch(training, train, validation, observe)
        training.finish()
        observe.log(f"The parser keeps the weights of epoch {training.best_epoch}.")

    def predict(
        self, utterances: Sequence[str], beam_width: int = 1, check: Check = keep_going
    ) -> list[list[Candidate]]:
        """Return the most probable forms by beam search; scores are log-probabilities in nats, whose part
        ``tokens`` counts the tokens that were written.

        The beam is as wide as the configuration says, or as ``beam_width`` where that is more.
        """
        width = max(beam_width, self.config.beam_width)
        self._model.eval()
        answers: list[list[Candidate]] = []
        with threads(self.config.threads), full_fp32():
            for begin in range(0, len(utterances), PREDICTION_BATCH):
                check()
                split = [words(each) for each in utterances[begin : begin + PREDICTION_BATCH]]
                context = contexts([self._context(utterance) for utterance in split])
                numbers = [self._source.numbers(utterance) for utterance in split]
                with torch.no_grad():
                    encoded = self._model.encoder(*sources(numbers), context)
                longest = self._longest + SLACK
                for hypotheses in search(self._model.decoder, encoded, width, longest, check):
                    answers.append(self._candidates(hypotheses)[:beam_width])
        return answers

    def save(self, folder: Path) -> None:
        self._write(folder)
        seal(folder, self, SAVED)

    @classmethod
    def load(cls, folder: Path, knowledge: Knowledge | None = None) -> Self:
        saved = open_sealed(folder, cls, SAVED)
        parser = cls(saved.config, saved.seed, knowledge)
        text = read_json(folder / VOCABULARY)
        parser._restore(folder, text)
        parser._prepare(Vocabulary(text["source"]), Vocabulary(text["target"]), text["longest"])
        load_weights(folder / WEIGHTS, parser._model)
        parser._model.eval()
        return parser

    def parameters(self) -> int:
        return sum(weights.numel() for weights in self._model.parameters())

    def _prepare(self, source: Vocabulary, target: Vocabulary, longest: int) -> None:
        """Make an untrained model for these vocabularies."""
        self._generator.manual_seed(self.seed)
        self._source, self._target, self._longest = source, target, longest
        model = Seq2SeqModel(self.config, len(source), len(target), self._generator, self._shape)
        self._model = model.to(processor())

    def _read_vocabularies(self, train: Sequence[Pair]) -> None:
        source = self._source_vocabulary([words(pair.utterance) for pair in train])
        target = Vocabulary.of([pair.form.split() for pair in train])
        self._prepare(source, target, max(len(pair.form.split()) for pair in train))

    def _source_vocabulary(self, commands: Sequence[tuple[str, ...]]) -> Vocabulary:
        return Vocabulary.of(commands, self.config.minimum_count)

    def _train_epoch(
        self,
        training: Training,
        train: Sequence[Pair],
        validation: Sequence[Pair],
        observe: Observer,
    ) -> None:
        begin = time.monotonic()
        loss = training.run_epoch(self._examples(train), observe.check)
        result = self._validate(validation, observe.check) if validation else None
        is_best = training.record(result)
        observe.epoch(
            EpochReport(
                epoch=training.epoch,
                train_loss=loss,
                validation_loss=result.loss if result else None,
                validation_accuracy=result.accuracy if result else None,
                seconds=time.monotonic() - begin,
            )
        )
        observe.checkpoint(
            training.epoch, is_best, lambda folder: self._checkpoint(folder, training)
        )
        limit = self.config.epochs
        observe.progress(training.epoch / limit, f"epoch {training.epoch} of at most {limit}")

    def _validate(self, pairs: Sequence[Pair], check: Check) -> ValidationResult:
        loss = validation_loss(self._model, self._examples(pairs), check)
        answers = self.predict([pair.utterance for pair in pairs], check=check)
        right = sum(
            bool(candidates) and candidates[0].form == pair.form
            for candidates, pair in zip(answers, pairs, strict=True)
        )
        return ValidationResult(right / len(pairs), loss)

    def _examples(self, pairs: Sequence[Pair]) -> list[NumberedPair]:
        examples = []
        for pair in pairs:
            source, target = words(pair.utterance), pair.form.split()
            numbers = self._source.numbers(source), self._target.numbers(target)
            examples.append(NumberedPair(*numbers, self._context(source)))
        return examples

    def _context(self, utterance: tuple[str, ...]) -> Tensor | None:
        """Return a frozen encoder's vectors of the words [words, layers, width]; this parser has none."""
        return None

    def _describe(self) -> dict[str, Any]:
        """Return what is saved beside the vocabularies."""
        return {}

    def _restore(self, folder: Path, described: dict[str, Any]) -> None:
        """Restore what ``_describe`` returned from ``folder``. Raises Refusal."""

    def _candidates(self, hypotheses: Sequence[Hypothesis]) -> list[Candidate]:
        """Return distinct canonical forms, each with the score of its best spelling."""
        best: dict[str, Hypothesis] = {}
        for hypothesis in hypotheses:
            text = " ".join(self._target.sentence(hypothesis.tokens))
            best.setdefault(canonical_or_same(text), hypothesis)
        return [
            Candidate(
                form,
                hypothesis.score,
                parts={"log_probability": hypothesis.score, "tokens": len(hypothesis.tokens)},
            )
            for form, hypothesis in best.items()
        ]

    def _write(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        vocabularies = {"source": self._source.words, "target": self._target.words}
        write_json(
            folder / VOCABULARY, {**vocabularies, "longest": self._longest, **self._describe()}
        )
        save_weights(folder / WEIGHTS, self._model)

    def _checkpoint(self, folder: Path, training: Training) -> None:
        """Write the parser after this epoch, and the state to resume from."""
        self._write(folder)
        save_training(folder, training)
        seal(folder, self, (*SAVED, *FILES))

    def _check_checkpoint(self, folder: Path) -> None:
        """Raise Refusal where ``folder`` is no checkpoint of this training."""
        open_sealed(folder, type(self), (*SAVED, *FILES))
        self._restore(folder, read_json(folder / VOCABULARY))
