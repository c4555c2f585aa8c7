"""The form ranker: chooses the form that an utterance means from many."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from math import log
from pathlib import Path
from typing import Self

import torch

from parser_service.neural.device import processor, threads
from parser_service.neural.pretrained import load_encoder
from parser_service.neural.ranker.calibration import TERMS, Decision, Scores, calibrate
from parser_service.neural.ranker.checkpoints import FILES, load_training, save_training
from parser_service.neural.ranker.model import RankerModel
from parser_service.neural.ranker.ranked_forms import RankedExample, RankedForms, collect
from parser_service.neural.ranker.slot_term import SlotTerm
from parser_service.neural.ranker.training import RankerTraining, reduced_precision
from parser_service.neural.sentence_encoder import ENCODER, TOKENIZER, SentenceEncoder
from parser_service.neural.training import resume
from parser_service.neural.weights import WEIGHTS, load_weights, save_weights
from parser_service.parsers.candidates.slot_filling import SlotFiller
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.encoder_places import encoders_folder
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
from parser_service.parsers.ranker_config import RankerConfig
from parser_service.parsers.storage import open_sealed, read_json, seal, write_json

FORMS = "forms.json"
SAVED = (FORMS, ENCODER, TOKENIZER, WEIGHTS)
UNKNOWN = "UNKNOWN"
REFUSAL = "refusal"  # the origin of UNKNOWN where no form is probable enough
PREDICTION_BATCH = 64
VALIDATIONS = 4  # in a training; each re-encodes all examples, which takes a while


class FormRanker(Parser):
    """Chooses from whole forms by one fine-tuned sentence encoder.

    A form with examples is scored by the nearest of them and by its English gloss, a new one by its
    gloss alone; where the ontology is known, slots that no entity of the utterance fills lower the
    score. New forms are made from those of the training pairs (``candidates``) or taken from the
    grammar. Scores are log-probabilities. They are calibrated on the validation pairs, which also
    decide by how much a new form has to fit better.
    """

    name = "ranker"
    version = 7
    protocols = (Protocol.STRICT, Protocol.DOMAIN, Protocol.GRAMMAR)
    score_kind = ScoreKind.LOG_PROBABILITY
    Config = RankerConfig

    def __init__(
        self,
        config: RankerConfig | None = None,
        seed: int = 0,
        knowledge: Knowledge | None = None,
    ):
        super().__init__(config, seed, knowledge)
        self._decision = Decision()
        self._ranked = RankedForms((), (), 0, (), ())
        self._model: RankerModel | None = None

    def fit(
        self,
        train: Sequence[Pair],
        validation: Sequence[Pair] = (),
        observe: Observer | None = None,
    ) -> None:
        observe = observe or Observer()
        if not train:
            raise ValueError("There is no training pair, so there is nothing to learn from.")
        is_open = self.config.forms == "open"
        self._ranked, examples, line = collect(train, self.knowledge, is_open)
        observe.log(line)
        with threads(self.config.threads):
            training = self._prepare(examples, observe.check)
            resume(
                observe,
                check=lambda folder: open_sealed(folder, type(self), (*SAVED, *FILES)),
                load=lambda folder: load_training(folder, training),
            )
            was_over = training.is_over()
            while not training.is_over():
                self._train_epoch(training, validation, observe)
            training.average.keep()
            if was_over:  # else the last epoch has done this
                self._validate(training, validation, observe.check)

    def predict(
        self, utterances: Sequence[str], beam_width: int = 1, check: Check = keep_going
    ) -> list[list[Candidate]]:
        """Return the most probable forms; scores are log-probabilities in nats.

        Their parts are the ``TERMS`` that are not 0. Where the best is below ``unknown_below``, the
        first answer is UNKNOWN, scored with that bound.
        """
        answers: list[list[Candidate]] = []
        for begin in range(0, len(utterances), PREDICTION_BATCH):
            asked = utterances[begin : begin + PREDICTION_BATCH]
            scores = self._model_or_refuse().scores(asked, check)
            for ranked in self._rank(scores, beam_width):
                answers.append(self._refuse_improbable(ranked)[:beam_width])
        return answers

    def _rank(self, scores: Scores, beam_width: int) -> Iterator[list[Candidate]]:
        """Yield the most probable forms of each utterance."""
        logs = self._decision.log_probabilities(scores)
        best = logs.topk(min(beam_width, logs.shape[1]), dim=-1)
        terms = self._decision.terms(scores, best.indices).permute(1, 2, 0)
        rows = zip(best.indices.tolist(), best.values.tolist(), terms.tolist(), strict=True)
        for numbers, probabilities, parts in rows:
            yield [
                Candidate(
                    self._ranked.forms[number],
                    score,
                    self._ranked.origin(number),
                    {name: value for name, value in zip(TERMS, part, strict=True) if value},
                )
                for number, score, part in zip(numbers, probabilities, parts, strict=True)
            ]

    def save(self, folder: Path) -> None:
        self._write(folder)
        seal(folder, self, SAVED)

    @classmethod
    def load(cls, folder: Path, knowledge: Knowledge | None = None) -> Self:
        """Load the parser that ``save`` wrote; under *domain* it finds entities in the current ontology.

        Raises ValueError as every parser does, and where that ontology is not given.
        """
        saved = open_sealed(folder, cls, SAVED)
        parser = cls(saved.config, saved.seed, knowledge)
        about = read_json(folder / FORMS)
        if about["has_slots"] and parser.knowledge.ontology is None:
            raise ValueError(
                f"{folder} holds a parser that knows an ontology. Load it with the ontology of its "
                "world, under the protocol that it was trained with."
            )
        parser._ranked = RankedForms.read(about["ranked"])
        parser._decision = Decision.read(about["decision"])
        parser._model = parser._make_model(SentenceEncoder.described_in(folder))
        load_weights(folder / WEIGHTS, parser._model)
        parser._model.eval()
        return parser

    def parameters(self) -> int:
        return sum(weights.numel() for weights in self._model.parameters()) if self._model else 0

    def _prepare(self, examples: Sequence[RankedExample], check: Check) -> RankerTraining:
        """Make a model with the pretrained encoder, and its prototypes from the encoded examples."""
        pretrained = load_encoder(self.config.encoder, encoders_folder())
        model = self._make_model(SentenceEncoder.of(pretrained, self.config.dropout))
        with reduced_precision(model, self.config.precision):
            vectors = model.encoder.vectors([each.utterance for each in examples], check)
        model.prototypes.start_from(vectors, [each.form for each in examples])
        self._model = model
        ontology = self.knowledge.ontology
        fill = SlotFiller(ontology).fill if ontology is not None else None
        is_strict = self.knowledge.predicates is None
        config = self.config
        share = config.pretrained_share if is_strict else config.pretrained_share_domain
        return RankerTraining(model, config, self.seed, examples, share, fill)

    def _make_model(self, encoder: SentenceEncoder) -> RankerModel:
        ranked, ontology = self._ranked, self.knowledge.ontology
        slots = SlotTerm(ranked.forms, ontology) if ontology is not None else None
        return RankerModel(encoder, ranked, slots).to(processor())

    def _train_epoch(
        self, training: RankerTraining, validation: Sequence[Pair], observe: Observer
    ) -> None:
        begin = time.monotonic()
        loss = training.run_epoch(observe.check)
        result: tuple[float | None, float | None] = None, None
        with training.average.in_force():
            if is_due(training.epoch, training.epochs):
                precision = "fp32" if training.is_over() else self.config.precision
                with reduced_precision(training.model, precision):
                    result = self._validate(training, validation, observe.check)
            observe.epoch(EpochReport(training.epoch, loss, *result, time.monotonic() - begin))
            # The newest average counts as the best: the last one becomes the parser, whatever a
            # small validation part says.
            observe.checkpoint(
                training.epoch, True, lambda folder: self._checkpoint(folder, training)
            )
        message = f"epoch {training.epoch} of {training.epochs}"
        observe.progress(training.epoch / training.epochs, message)

    def _validate(
        self, training: RankerTraining, validation: Sequence[Pair], check: Check
    ) -> tuple[float | None, float | None]:
        """Encode examples and glosses and calibrate; return loss and accuracy on the validation pairs."""
        model = self._model_or_refuse()
        model.encode([example.utterance for example in training.examples], check)
        if not validation:
            self._decision = Decision()
            return None, None
        number = {form: at for at, form in enumerate(self._ranked.forms)}
        targets = torch.tensor([number.get(pair.form, -1) for pair in validation])
        scores = model.scores([pair.utterance for pair in validation], check)
        self._decision = calibrate(scores, targets)
        logs = self._decision.log_probabilities(scores)
        of_targets = logs[targets >= 0].gather(1, targets[targets >= 0, None])
        loss = -float(of_targets.mean()) if len(of_targets) else None
        return loss, float((logs.argmax(-1) == targets).float().mean())

    def _refuse_improbable(self, ranked: list[Candidate]) -> list[Candidate]:
        bound = self.config.unknown_below
        if not bound or ranked[0].score >= log(bound):
            return ranked
        others = [each for each in ranked if each.form != UNKNOWN]
        return [Candidate(UNKNOWN, log(bound), REFUSAL), *others]

    def _model_or_refuse(self) -> RankerModel:
        if self._model is None:
            raise ValueError("This parser has learned nothing yet: fit it, or load a fitted one.")
        return self._model

    def _write(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        model = self._model_or_refuse()
        about = {
            "ranked": self._ranked.to_json(),
            "decision": asdict(self._decision),
            "has_slots": model.slots is not None,
        }
        write_json(folder / FORMS, about)
        model.encoder.describe(folder)
        save_weights(folder / WEIGHTS, model)

    def _checkpoint(self, folder: Path, training: RankerTraining) -> None:
        """Write the averaged weights and the state to resume from.

        The vectors of examples and glosses and the calibration are older than the weights, except
        after an epoch that was validated, as the last one is. Resuming needs none of them.
        """
        self._write(folder)
        save_training(folder, training)
        seal(folder, self, (*SAVED, *FILES))


def is_due(epoch: int, epochs: int) -> bool:
    """Return whether ``epoch`` is validated; the last one always is."""
    return epoch * VALIDATIONS // epochs > (epoch - 1) * VALIDATIONS // epochs
