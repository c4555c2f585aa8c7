"""How a ranker learns: at first without some forms, then from all pairs."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from pathlib import Path

import torch

from parser_service.neural.device import processor
from parser_service.neural.pretrained import load_encoder
from parser_service.neural.ranker.averaging import Average
from parser_service.neural.ranker.calibration import (
    USUAL_NOVELTY,
    DecisionRule,
    best_novelty,
)
from parser_service.neural.ranker.holding_out import HeldOut, hold_out
from parser_service.neural.ranker.model import RankerModel
from parser_service.neural.ranker.ranked_forms import RankedForms, collect
from parser_service.neural.ranker.slots import SlotFiller, SlotTerm
from parser_service.neural.ranker.steps import (
    RankerTraining,
    StepSpan,
    cut,
    load_training,
    plan,
    reduced_precision,
    save_training,
)
from parser_service.neural.ranker.unlisted_names import UnlistedNames
from parser_service.neural.ranker.weighing import Report, weigh_by
from parser_service.neural.sentence_encoder import SentenceEncoder
from parser_service.neural.training import TRAINING, Clock, resume
from parser_service.parsers.hyperparameters.ranker import RankerConfig
from parser_service.parsers.interface import Check, EpochReport, Knowledge, Observer, Pair
from parser_service.parsers.pretrained_files import encoders_folder
from parser_service.parsers.storage import read_json

VALIDATIONS = 4  # in a training; each re-encodes all examples, which takes a while
FIRST_SHARE = 0.3  # of the steps, before the forms that were held out are learned as well
TOLERANCE = 1.05  # fewer steps than this share too many are no reason to change the schedule


class Fitting:
    """The training of a ranker.

    Where there are forms enough, some are held out of its first part, which then tells when a form is
    new (``holding_out``, ``calibration.best_novelty``); the second part continues with all. Afterwards
    ``ranked``, ``model`` and ``decision`` are the parser.
    """

    def __init__(
        self,
        config: RankerConfig,
        seed: int,
        knowledge: Knowledge,
        validation: Sequence[Pair],
        observe: Observer,
    ):
        self.config, self.seed, self.knowledge = config, seed, knowledge
        self.validation, self.observe = validation, observe
        self.decision = DecisionRule()
        self._clock = Clock(config.minutes, config.threads or torch.get_num_threads())
        self._seconds_to_encode = 0.0  # all examples and glosses
        self._done = 0.0

    @property
    def ranked(self) -> RankedForms:
        return self._sets[-1]

    @property
    def model(self) -> RankerModel:
        return self._trainings[-1].model

    def run(
        self,
        train: Sequence[Pair],
        check_sealed: Callable[[Path], object],
        seal: Callable[[Path], None],
    ) -> None:
        """Learn from ``train``. Checkpoints are sealed by ``seal`` and checked by ``check_sealed``."""
        is_open = self.config.forms == "open"
        held = hold_out(train, self.seed) if is_open else None
        self._seal, self._at, self._is_started = seal, 0, False
        self._prepare([held.train, train] if held else [train], is_open)
        resume(self.observe, check_sealed, self._load, "step")
        while True:
            training = self._trainings[self._at]
            if not self._is_started and not training.is_over():
                self._encode(training.start)
            was_over = training.is_over()
            while not training.is_over():
                self._run_pass(training)
            if self._at == len(self._trainings) - 1:
                break
            assert held is not None
            self.decision = DecisionRule(self._learn_novelty(held))
            self._at, self._is_started = self._at + 1, False
            self._trainings[self._at].continue_from(training)
        self._average.keep()
        if was_over:  # else the last pass has done this
            self._validate(self.observe.check)

    def _prepare(self, sets: Sequence[Sequence[Pair]], is_open: bool) -> None:
        """Make the trainings, one on each of ``sets``, with one encoder and its average."""
        check = self.observe.check
        collected = [
            collect(pairs, self.knowledge, is_open, check, self.config.rewordings, self.seed)
            for pairs in sets
        ]
        self._sets = [ranked for ranked, _, _ in collected]
        examples = [of_set for _, of_set, _ in collected]
        self.observe.log(collected[-1][2])
        config = self.config
        pretrained = load_encoder(config.encoder, encoders_folder())
        encoder = SentenceEncoder.of(pretrained, config.dropout, config.frozen_layers)
        models = [make_model(encoder, ranked, self.knowledge) for ranked in self._sets]
        is_strict = self.knowledge.predicates is None
        share = config.pretrained_share if is_strict else config.pretrained_share_domain
        kept = {name: share for name, _ in models[-1].trained()}
        self._average = Average(models[-1].trained(), config.averaging, kept)
        shares = (FIRST_SHARE, 1 - FIRST_SHARE) if len(sets) > 1 else (1.0,)
        spans = plan(shares, list(map(len, examples)), config)
        last = spans[-1]
        if (seen := last.a_pass * config.batch_size) < len(examples[-1]):
            self.observe.log(
                f"A pass over {len(examples[-1]):,} pairs would take longer than the {config.steps:,} steps "
                f"allow; the last {last.end - last.first:,} steps see {seen:,} of them. More steps "
                "see more."
            )
        ontology = self.knowledge.ontology
        fill = SlotFiller(ontology).fill if ontology is not None else None
        self._trainings = [
            RankerTraining(model, config, self.seed, of_set, self._average, span, fill, self._clock)
            for model, of_set, span in zip(models, examples, spans, strict=True)
        ]
        self._set_spans(spans)

    def _run_pass(self, training: RankerTraining) -> None:
        begin = time.monotonic()
        observe = self.observe
        loss = training.run_pass(observe.check, self._after_step)
        epoch = self._epoch()
        result: Report = None, None
        is_last = self._at == len(self._trainings) - 1 and training.is_over()
        with self._average.in_force():
            if is_due(epoch, self._passes):
                precision = "fp32" if is_last else self.config.precision
                with reduced_precision(training.model, precision):
                    result = self._validate(observe.check)
        observe.epoch(EpochReport(epoch, loss, *result, time.monotonic() - begin))
        self._after_step()

    def _keep_to_time(self) -> None:
        """Take fewer steps where those that are left would last too long, and say so."""
        training = self._trainings[self._at]
        left = training.span.total - training.step
        steps = self._clock.steps_left(self._seconds_beside_steps())
        if left <= TOLERANCE * steps:
            return
        self._set_spans(cut([each.span for each in self._trainings], training.step, steps))
        self.observe.log(
            f"A step takes {self._clock.a_step:.1f} s, so {self.config.minutes:g} minutes are not enough for "
            f"{training.step + left:,} of them: the training ends after {training.span.total:,}."
        )

    def _seconds_beside_steps(self) -> float:
        """Estimate the seconds that validating and encoding will still take."""
        validations = VALIDATIONS - self._epoch() * VALIDATIONS // self._passes
        others = 2 * (len(self._trainings) - 1 - self._at)  # novelty, and the start of the next one
        return (validations + others) * self._seconds_to_encode

    def _progress(self) -> float:
        """Return how much of the work is done, from 0 to 1.

        It is by time once steps were timed: preparing takes time too, and the time left is to be that of the steps
        that will be taken. Before, it is by steps. It never goes back.
        """
        step, total = self._trainings[self._at].step, self._trainings[-1].span.end
        done = step / total
        if self._clock.a_step and step < total:
            left = (total - step) * self._clock.a_step + self._seconds_beside_steps()
            done = self._clock.spent / (self._clock.spent + left)
        self._done = max(self._done, done)
        return self._done

    def _set_spans(self, spans: Sequence[StepSpan]) -> None:
        for training, span in zip(self._trainings, spans, strict=True):
            training.span = span
        for later in self._trainings[self._at + 1 :]:
            later.step = later.span.first
        self._passes = sum(span.passes for span in spans)

    def _epoch(self) -> int:
        """Return how many passes are over."""
        return sum(each.passes for each in self._trainings[: self._at + 1])

    def _after_step(self) -> None:
        self._keep_to_time()
        epoch = min(self._epoch() + 1, self._passes)
        self.observe.progress(self._progress(), f"epoch {epoch} of {self._passes}")
        if self.observe.is_checkpoint_due():
            # The newest average counts as the best: the last one becomes the parser, whatever a small
            # validation part says.
            self.observe.checkpoint(self._epoch(), True, self._save)

    def _save(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        about = {
            "training": self._at,
            "novelty": self.decision.novelty,
            "seconds": self._clock.spent,
            "seconds_to_encode": self._seconds_to_encode,
            "spans": [each.span for each in self._trainings],
        }
        save_training(folder, self._trainings[self._at], about)
        self._seal(folder)

    def _load(self, folder: Path) -> int:
        state = read_json(folder / TRAINING)
        self._at, self._is_started = state["training"], True
        self.decision = DecisionRule(state["novelty"])
        self._clock.before = state["seconds"]
        self._seconds_to_encode = state["seconds_to_encode"]
        self._set_spans([StepSpan(*span) for span in state["spans"]])
        for earlier in self._trainings[: self._at]:
            earlier.step = earlier.span.end
        training = self._trainings[self._at]
        load_training(folder, training)
        return training.step

    def _learn_novelty(self, held: HeldOut) -> float:
        """Return when a form is new, from the pairs that the first training did not see."""
        model, check = self._trainings[self._at].model, self.observe.check
        with self._average.in_force(), reduced_precision(model, self.config.precision):
            self._encode(self._encode_examples)
            of_new, of_known = (
                model.scores([pair.utterance for pair in pairs], check).evidence
                for pairs in (held.new, held.known)
            )
        forms = [[pair.form for pair in pairs] for pairs in (held.new, held.known)]
        novelty = best_novelty(of_new, forms[0], of_known, forms[1])
        self.observe.log(
            f"{len(set(forms[0]))} forms were held out of the first part of the training, and "
            f"utterances of {len(set(forms[1]))} others; by them, a new form is answered where it fits "
            f"better by {USUAL_NOVELTY - novelty:.2f} nats than usual."
        )
        return novelty

    def _encode_examples(self, check: Check) -> int:
        training = self._trainings[self._at]
        training.model.encode([each.utterance for each in training.examples], check)
        return len(training.examples) + len(training.model.glosses.glosses)

    def _encode(self, work: Callable[[Check], int]) -> None:
        """Do ``work``, which returns how many texts it encodes, and keep how long all of them take."""
        begin = self._clock.now()
        texts = work(self.observe.check)
        every = len(self._trainings[-1].examples) + len(self.ranked.glosses)
        self._seconds_to_encode = (self._clock.now() - begin) * every / texts

    def _validate(self, check: Check) -> Report:
        """Encode examples and glosses and weigh the experts; return loss and accuracy on the validation
        pairs."""
        self._encode(self._encode_examples)
        self.decision, report = weigh_by(
            self.validation,
            self.decision.novelty,
            self._sets[self._at],
            self._trainings[self._at].model,
            check,
        )
        return report


def make_model(encoder: SentenceEncoder, ranked: RankedForms, knowledge: Knowledge) -> RankerModel:
    """Make a model that chooses from ``ranked`` with ``encoder``."""
    ontology = knowledge.ontology
    if ontology is None:
        return RankerModel(encoder, ranked).to(processor())
    slots, unlisted = SlotTerm(ranked.forms, ontology), UnlistedNames(ontology)
    return RankerModel(encoder, ranked, slots, unlisted).to(processor())


def is_due(epoch: int, epochs: int) -> bool:
    """Return whether ``epoch`` is validated; the last one always is."""
    return epoch * VALIDATIONS // epochs > (epoch - 1) * VALIDATIONS // epochs
