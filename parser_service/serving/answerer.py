"""What a world answers: its grammar oracle first, then its learned parser, then a language model where the world asks
one, then a question or UNKNOWN.

An utterance that the oracle understands as it is written needs no other part. Where the oracle is silent, hears
something else than what is written, or reads it in several ways, the learned part is asked too. Every answer gets a
probability, and from that a decision (``parser_service.analysis.sureness``).
"""

from __future__ import annotations

import json
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from http import HTTPStatus
from math import log, prod
from typing import TYPE_CHECKING, Any, cast

from annotations.language.forms import (
    SEQUENCE,
    Application,
    Form,
    actions_of,
    canonical_text,
    equivalent,
)
from annotations.language.grounding import (
    Anonymized,
    HeardChange,
    HeardText,
    HearingReader,
    Slot,
    words_of,
)
from annotations.language.plans import (
    MOST_COMMANDS,
    Fit,
    Left,
    LeftOut,
    Objection,
    StoppingWords,
    best_alternative,
    best_fitting,
    exchange,
    fit,
    join,
    last_clause,
    objections,
    shall_i,
    with_entities,
    without_clause,
)
from annotations.language.texts import Refusal
from parser_service.analysis.sureness import (
    AnsweredForm,
    AnsweringPart,
    Decision,
    Evidence,
    in_words,
)
from parser_service.parsers.interface import UNKNOWN, Candidate, Parser, ScoreKind
from parser_service.parsers.several import pieces_of
from parser_service.serving.answer_writing import AnswerWriter
from parser_service.serving.batching import Batcher
from parser_service.serving.calibrating import Calibrated
from parser_service.serving.joint_answers import understand
from parser_service.serving.parse_answers import (
    ParsedUtterance,
    Reading,
    as_json,
    form_of,
    is_cut_in,
    unknown_tokens,
)
from parser_service.serving.remote import RemoteAsker, Unanswered

if TYPE_CHECKING:
    from parser_service.parsers.oracle import GrammarOracle

USUAL_BEAM = 5
LINES_TOGETHER = 32  # of a request of many lines
NOT_UNDERSTOOD = "I did not understand that."
_NOT_SAID, _LEFT_OUT, _ROLES = _OF_FIT = ("not_said", "left_out", "roles")
# Kinds of changes that make other words of what was said; the others only leave noise out.
_DOUBTFUL = frozenset(("sound", "spelling", "inflection", "alias", "repair", "split", "number"))
_COURTESY = "courtesy"  # makes nobody less sure
_TOO_MANY = "too_many_commands"
_CAREFUL = (Decision.REFUSE, Decision.ASK, Decision.CONFIRM, Decision.ACT)
LEAST_LOG = -700.0  # of a probability that is 0


class NotServed(Refusal):
    """A request that cannot be answered, with its HTTP status and a sentence."""

    code = "not_served"

    def __init__(self, status: int, sentence: str, code: str = code) -> None:
        super().__init__(sentence, code, status)


@dataclass(frozen=True, slots=True)
class LoadedParser:
    """A parser in memory. ``knowledge`` is what of its world it was loaded with; ``lines_together`` is how many
    lines of a longer request it is given at once. ``run`` is None for a parser that needs none."""

    run: int | None
    name: str
    score_kind: str
    knowledge: tuple[object, ...]
    size: int
    batcher: Batcher | RemoteAsker
    lines_together: int = LINES_TOGETHER
    parser: Parser | None = None

    def ask(self, texts: Sequence[str], beam: int) -> list[list[Candidate]]:
        """Return the candidates of each text. Raises NotServed where it asks a server that does not answer in time."""
        try:
            return self.batcher.ask(texts, beam)
        except Unanswered as error:
            raise NotServed(HTTPStatus.SERVICE_UNAVAILABLE, error.message, error.code) from error


@dataclass(frozen=True, slots=True)
class PartAnswer:
    """What one part answered to an utterance: ``text`` is what it was given, which is what the utterance says from
    ``start`` on, without noise. ``agrees`` says whether the other part
    gives the same form; None where that was not asked or is silent. ``pieces`` are the answers to the commands of an
    utterance that holds several. ``unread`` is a clause of ``text`` without which the part answers the same.
    ``missing`` says why the last part did not answer."""

    utterance: str
    text: str
    part: LoadedParser | None = None
    candidates: Sequence[Candidate] = ()
    agrees: bool | None = None
    pieces: tuple[PartAnswer, ...] = ()
    changes: tuple[HeardChange, ...] = ()
    unread: tuple[LeftOut, ...] = ()
    missing: str = ""
    start: int = 0

    def said_in(self, utterance: str, start: int) -> PartAnswer:
        """Return the same as the answer to an utterance that has this one inside, from ``start`` on."""
        return replace(self, utterance=utterance, start=start)


@dataclass(frozen=True, slots=True)
class Answer:
    """One answer of a world: the readings of its candidates, best first, how sure it is, and what to do with it.

    ``several`` are the answers to the commands of an utterance that holds more than one.
    """

    given: PartAnswer
    several: tuple[Answer, ...]
    heard: Anonymized
    readings: Sequence[Reading[str]]
    about: AnsweredForm
    probability: float | None
    decision: Decision
    reasons: tuple[Objection, ...]

    @property
    def is_unknown(self) -> bool:
        """Whether there is nothing to act on: no form, or one that is not trusted or that nobody asked for."""
        return self.about.evidence is None or self.decision is Decision.REFUSE

    @property
    def changes(self) -> tuple[HeardChange, ...]:
        """What was heard otherwise than it was said, with its places in the utterance."""
        best = next(iter(self.readings), None)
        start = self.given.start
        return tuple(
            replace(each, start=start + each.start, end=start + each.end)
            for each in (*self.given.changes, *(best.candidate.heard if best else ()))
        )


@dataclass(frozen=True, slots=True)
class Answerer:
    """The parts of a world and the writer of its answers. They answer a request and do not change meanwhile.

    ``oracle`` answers first, ``learned`` where it is silent; at least one is there. ``last`` is a language model, which
    is asked where nothing else was understood. ``problem`` and ``last_problem`` say why the learned part and the last
    one are missing, where they should be there.
    """

    world: str
    writer: AnswerWriter
    reader: HearingReader
    stopping: StoppingWords
    oracle: LoadedParser | None = None
    learned: LoadedParser | None = None
    last: LoadedParser | None = None
    calibrated: Calibrated = field(default_factory=Calibrated)
    problem: str = ""
    last_problem: str = ""
    wanted: Any = None  # what of the database it was made of (``shelf.WantedAnswerer``)

    @property
    def names(self) -> str:
        """The names of the parts, in the order in which they answer."""
        return ", ".join(part.name for part in (self.oracle, self.learned, self.last) if part)

    @property
    def run(self) -> int | None:
        """The run of the learned part."""
        return self.learned.run if self.learned else None

    @property
    def size(self) -> int:
        """Bytes that the parts take that were loaded."""
        return sum(part.size for part in (self.learned, self.last) if part)

    @property
    def lines_together(self) -> int:
        # The oracle looks at each line alone, so that several together would only come later.
        loaded = [part.lines_together for part in (self.learned, self.last) if part]
        return min(loaded, default=1)

    def parse(self, utterances: Sequence[str], beam: int) -> list[str]:
        """Return the answer to each utterance, as JSON. Raises as ``ask``."""
        return [self.write(each) for each in self.ask(utterances, beam)]

    def ask(self, utterances: Sequence[str], beam: int) -> list[Answer]:
        """Return the answer to each utterance. Raises NotServed where the learned part asks a server that does not
        answer in time."""
        return self._ask_last(self._ask_own(utterances, beam), beam)

    def _ask_own(self, utterances: Sequence[str], beam: int) -> list[Answer]:
        """Return the answers without the last part."""
        given = [self._cut(each, beam) for each in self._ask_oracle(utterances, beam)]
        answers = map(self.judge, self._ask_learned(given, beam))
        return [self._cut_again(self._mark_unread(each), beam) for each in answers]

    def _ask_last(self, answers: Sequence[Answer], beam: int) -> list[Answer]:
        """Return the answers with what the last part says where nothing was understood and nothing speaks against it.

        Where it does not answer once, the others are not asked: whoever waits gets the question instead.
        """
        missing, asked = self.last_problem, []
        for answer in answers:
            if answer.several:
                several = self._ask_last(answer.several, beam)
                if several != list(answer.several):
                    given = replace(answer.given, pieces=tuple(each.given for each in several))
                    answer = self.judge(given)
            elif _is_lost(answer) and (missing or self.last):
                answer = self._ask_last_alone(answer, beam, missing)
            missing = missing or next(_missing(answer.given), "")
            asked.append(answer)
        return asked

    def _ask_last_alone(self, answer: Answer, beam: int, missing: str) -> Answer:
        """Return what the last part answers instead, or ``answer`` where it gives nothing, with why."""
        given = answer.given
        if not missing and self.last:
            cleaned = self.reader.clean(given.utterance)
            try:
                [candidates] = self.last.ask([cleaned.text], beam)
            except NotServed as error:
                missing = error.message
            else:
                better = self.judge(
                    PartAnswer(
                        given.utterance,
                        cleaned.text,
                        self.last,
                        candidates,
                        changes=cleaned.changes,
                    )
                )
                return answer if _is_lost(better) else better
        return replace(answer, given=replace(given, missing=missing))

    def ask_best(self, alternatives: Sequence[tuple[str, float]], beam: int) -> Answer:
        """Return the answer to the best of a recogniser's alternatives that is understood, or to the first; each has a
        text and a score. Raises as ``ask``."""
        texts = [text for text, _ in alternatives]
        answers = dict(zip(texts, self._ask_own(texts, beam), strict=True))
        best = (
            0
            if len(texts) == 1
            else best_alternative(alternatives, lambda text: self._rate(answers[text]))
        )
        [answer] = self._ask_last([answers[texts[best or 0]]], beam)
        return answer

    def _rate(self, answer: Answer) -> float | None:
        """Return how well an utterance was understood, higher is better; None where it was not."""
        given = answer.given
        if answer.is_unknown or answer.probability is None:
            return None
        return log(answer.probability) - sum(
            -each.score for each in given.candidates[:1] if given.part is self.oracle
        )

    def _ask_oracle(self, utterances: Sequence[str], beam: int) -> list[PartAnswer]:
        if self.oracle is None:
            return [PartAnswer(each, each, self.learned) for each in utterances]
        # Each alone: one takes milliseconds, and others may ask in between.
        return [
            PartAnswer(each, each, self.oracle, self.oracle.ask([each], beam)[0])
            for each in utterances
        ]

    def _ask_learned(self, answers: list[PartAnswer], beam: int) -> list[PartAnswer]:
        """Return the answers with what the learned part says where the oracle leaves a doubt."""
        unsure = [at for at, each in enumerate(answers) if not _is_settled(each)]
        if self.learned is None or not unsure:
            return answers
        # A learned parser is given the text without its noise.
        cleaned = {at: self.reader.clean(answers[at].text) for at in unsure}
        found = dict(
            zip(
                unsure,
                self.learned.ask([each.text for each in cleaned.values()], beam),
                strict=True,
            )
        )
        return [
            self._join(each, found[at], cleaned[at]) if at in found else each
            for at, each in enumerate(answers)
        ]

    def _cut(self, given: PartAnswer, beam: int) -> PartAnswer:
        """Return the answer with one for each command, where the oracle understands each and not all together."""
        if given.candidates or not given.utterance.strip():
            return given
        pieces = pieces_of(given.utterance, self._grammar)
        texts = [each.text for each in pieces]
        # Without a grammar, where sentences end is all that tells.
        is_cut = (
            len(texts) > 1 if self.oracle is None else all(each.is_understood for each in pieces)
        )
        if self.learned is None and not is_cut:  # no other part understands the rest
            is_cut = len(texts) > 1 and any(each.is_understood for each in pieces)
            is_cut = is_cut and not objections(self._anonymize(given.utterance))
        if not is_cut:
            return given
        alone = self._ask_oracle(texts, beam)
        if len(texts) == 1:  # an announcement was taken off
            return alone[0].said_in(given.utterance, pieces[0].start)
        if self.oracle is None:
            judged = map(self.judge, self._ask_learned(alone, beam))
            alone = [self._cut_again(each, beam).given for each in judged]
        return replace(given, pieces=tuple(alone))

    def _mark_unread(self, answer: Answer) -> Answer:
        """Return the answer with the clause that the learned part has not read: without it, it answers the same."""
        given = answer.given
        if given.pieces or self.learned is None or given.part is not self.learned:
            return answer
        spans = answer.heard.spans
        clause = last_clause(given.text, {(each.start, each.end) for each in spans})
        # Words that commands have were learned, and entities are looked after one by one (``fit``).
        if (
            clause is None
            or answer.is_unknown
            or words_of(clause.text)[0] in self.writer.language.use.vocabulary
            or any(each.start >= clause.start for each in spans)
        ):
            return answer
        before = without_clause(given.text, clause)
        [candidates] = self.learned.ask([before], USUAL_BEAM)
        alone = self.judge(PartAnswer(before, before, self.learned, candidates))
        if alone.is_unknown or not _is_same(
            alone.readings[0].candidate, answer.readings[0].candidate
        ):
            return answer
        unread = LeftOut(Left.ACTION, clause.text, clause.start, clause.end)
        return self.judge(replace(given, unread=(unread,)))

    def _cut_again(self, answer: Answer, beam: int) -> Answer:
        """Return the answer with one for each command, where both parts together understand some of them and neither
        is sure of all together, or the learned part leaves something out."""
        given, evidence = answer.given, answer.about.evidence
        if given.pieces or self.learned is None or given.part is not self.learned:
            return answer
        if evidence is not None and not (evidence.left_out or evidence.unknown_words):
            return answer
        if answer.about.objections:
            return answer
        pieces = pieces_of(given.utterance, self._grammar, self._judge)
        is_better = any if answer.is_unknown else all
        if len(pieces) < 2 or not is_better(each.is_understood for each in pieces):
            return answer
        alone = self._ask_oracle([each.text for each in pieces], beam)
        return self.judge(replace(given, pieces=tuple(self._ask_learned(alone, beam))))

    @property
    def _grammar(self) -> GrammarOracle | None:
        return cast("GrammarOracle | None", self.oracle.parser if self.oracle else None)

    def _judge(self, texts: Sequence[str]) -> list[float | None]:
        """Return how well the learned part understands each text as one command; None for one that it does not, of
        which it leaves something out, or that asks for nothing by itself, such as "Axel is in the kitchen"."""
        assert self.learned is not None
        answers = [
            self.judge(PartAnswer(text, text, self.learned, candidates))
            for text, candidates in zip(texts, self.learned.ask(texts, USUAL_BEAM), strict=True)
        ]
        return [
            None
            if each.about.objections
            or (of := each.about.evidence) is None
            or of.left_out
            or of.unknown_words
            else each.readings[0].candidate.score
            for each in answers
        ]

    def _anonymize(self, text: str) -> Anonymized:
        return self.writer.language.anonymizer.anonymize(text)

    def heard_nothing(self) -> Answer:
        """Return what there is to write where nothing was said: no candidate, without asking any part."""
        return self.judge(PartAnswer("", "", self.oracle or self.learned))

    def measure(self, utterances: Sequence[str]) -> list[AnsweredForm]:
        """Return what is known of the answer to each utterance, with its share of the processor time.

        Raises NotServed where a part asks a server that does not answer: a missing answer is none that is wrong.
        """
        began = time.process_time()
        answers = self.ask(utterances, USUAL_BEAM)
        if missing := next((why for each in answers for why in _missing(each.given)), ""):
            raise NotServed(HTTPStatus.SERVICE_UNAVAILABLE, missing)
        seconds = (time.process_time() - began) / max(len(answers), 1)
        return [replace(each.about, seconds=seconds) for each in answers]

    def judge(self, given: PartAnswer) -> Answer:
        """Return an answer with how sure it is."""
        if given.pieces:
            return self._judge_several(given)
        heard = self._anonymize(given.text)
        score_kind = given.part.score_kind if given.part else ""
        readings = self.writer.readings(heard, given.candidates, score_kind, given.utterance)
        # What is no form is not shown.
        readings = [each for each in readings if each.slots is not None]
        fits = Fit()
        reasons: tuple[Objection, ...] = ()
        has_learned = given.part is not None and given.part is not self.oracle
        if has_learned or not readings:
            reasons = objections(heard)
        if has_learned:
            readings, fits = self._fit(readings, heard, given)
            fits = replace(fits, left_out=(*fits.left_out, *given.unread))
        about = replace(self._about(given, heard, readings, fits), objections=bool(reasons))
        probability = None
        if about.evidence is not None:
            probability = self.calibrated.calibration.probability(about.evidence)
        calibrated = self.calibrated
        decision = about.decision(probability, calibrated.point, calibrated.calibration)
        if decision is Decision.REFUSE:
            reasons = (*reasons, *self.stopping.in_(heard))
        if not about.objections:
            reasons = (*reasons, *_misfits(fits))
        return Answer(given, (), heard, readings, about, probability, decision, reasons)

    def _fit(
        self, readings: Sequence[Reading[str]], heard: Anonymized, given: PartAnswer
    ) -> tuple[list[Reading[str]], Fit]:
        """Return the readings of a learned parser in the order of how well they fit what was said, and the fit of the
        first.

        Where the words between say two slots the other way round and no reading has them so, the first is exchanged.
        """
        if not readings or readings[0].candidate.form == UNKNOWN:
            return list(readings), Fit()
        known = [each for each in readings if each.candidate.form != UNKNOWN]
        others = [each for each in readings if each.candidate.form == UNKNOWN]
        fits = [self._fit_of(each, heard) for each in known]
        scores = [_log_probability(each.candidate.score, given.part) for each in known]
        scored = [(0.0 if of is None else of, fit) for of, fit in zip(scores, fits, strict=True)]
        order = best_fitting(scored) if None not in scores else list(range(len(known)))
        ordered, best = [known[at] for at in order] + others, fits[order[0]]
        pair = next((each for each in best.exchanged if each.is_possible), None)
        if pair is not None:
            first = ordered[0]
            form, values = exchange(_form(first), first.slots or (), pair)
            turned = replace(first.candidate, form=canonical_text(form), values=values)
            [reading] = self.writer.readings(heard, [turned], None, given.utterance)
            fit = self._fit_of(reading, heard)
            if not fit.exchanged:
                return [reading, *ordered], replace(fit, exchanged=(pair,))
        return ordered, best

    def _fit_of(self, reading: Reading[str], heard: Anonymized) -> Fit:
        language = self.writer.language
        slots = reading.slots or ()
        return fit(_form(reading), slots, heard, language.use, language.ontology)

    def _unknown_words(self, heard: Anonymized, slots: Sequence[Slot]) -> int:
        """Return how many words nobody knows, besides those that may name what a slot asks for."""
        phrases = [each for slot in slots if slot.value is None for each in slot.phrases]
        asked = {word for phrase in phrases for word in phrase.split()}
        found = self.stopping.in_(heard)
        texts = (heard.original[each.start : each.end].split() for each in found)
        return sum(not asked.issuperset(words) for words in texts)

    def _judge_several(self, given: PartAnswer) -> Answer:
        """Return the answer to several commands: as sure as all of them together, and as the least sure one decides.

        Where all are understood, the one candidate does one after the other.
        """
        several = tuple(map(self.judge, _flat(given.pieces)))
        heard = self._anonymize(given.utterance)
        probabilities = [each.probability or 0.0 for each in several]
        probability, readings, about = None, [], AnsweredForm()
        if not any(each.is_unknown for each in several):
            candidate = _sequence([each.readings[0] for each in several])
            readings = self.writer.readings(heard, [candidate], "")
            probability = prod(probabilities)
            least = min(several, key=lambda each: each.probability or 0.0).about
            about = replace(
                least,
                form=candidate.form,
                open_slots=any(each.about.open_slots for each in several),
                ambiguous=any(each.about.ambiguous for each in several),
            )
        decisions = {each.decision for each in several}
        decision = next(each for each in _CAREFUL if each in decisions)
        reasons: tuple[Objection, ...] = ()
        if len(several) > MOST_COMMANDS:
            message = (
                f"These are {len(several)} commands, and I take at most {MOST_COMMANDS} at once."
            )
            reasons = (Objection(_TOO_MANY, message, 0, len(given.utterance)),)
        if decision is Decision.REFUSE or reasons:
            decision = Decision.ASK  # others can be done
        if decision is Decision.ACT and self.stopping.in_(heard):
            decision = Decision.CONFIRM  # of what was passed over between them
        return Answer(given, several, heard, readings, about, probability, decision, reasons)

    def write(self, answer: Answer) -> str:
        """Return an answer as JSON, with who gave it (docs/reference/parse-server.md)."""
        given, language = answer.given, self.writer.language
        said = self._anonymize(given.utterance)
        warnings = unknown_tokens(given.utterance, language.ontology)
        missing = next(_missing(given), "")
        warnings = (*warnings, *filter(None, (self.problem, missing)))
        parse = ParsedUtterance(said, given.text, (), warnings, is_cut_in(given.candidates))
        part = given.part
        first = json.loads(answer.readings[0].answer) if answer.readings else {}
        said_by = self._spoken(answer, first)
        head: dict[str, Any] = {
            "world": self.world,
            "run": part.run if part else None,
            "parser": part.name if part else "",
            "score_kind": part.score_kind if part else "",
            **parse.as_json(),
            "is_unknown": answer.is_unknown,
            "agrees": given.agrees,
            "heard": [asdict(each) for each in answer.changes],
            "probability": answer.probability and round(answer.probability, 4),
            "decision": answer.decision,
            "sureness": in_words(answer.decision, answer.probability),
            "spoken": said_by,
            "reasons": [{"code": each.code, "message": each.message} for each in answer.reasons],
            "nearest": self._nearest(answer),
            "several": [],
            "joint_plan": None,
        }
        if answer.several:
            head |= self._together(answer)
            said_by = head["spoken"]
        del head["candidates"]
        written = [each.answer for each in answer.readings]
        if first.get("task_plan"):
            written[0] = as_json(first | {"spoken": said_by})
        return f'{as_json(head)[:-1]}, "candidates": [{", ".join(written)}]}}'

    def _join(
        self, by_oracle: PartAnswer, learned: Sequence[Candidate], cleaned: HeardText
    ) -> PartAnswer:
        """Return what both parts say together: the oracle's readings where it has some, the likeliest of equally good
        ones first, else the learned answers."""
        if not by_oracle.candidates:
            return replace(
                by_oracle,
                text=cleaned.text,
                part=self.learned,
                candidates=learned,
                changes=cleaned.changes,
            )
        best = [each for each in learned[:1] if each.form != UNKNOWN]
        if not best:
            return by_oracle
        closest = by_oracle.candidates[0].score
        equal = [each for each in by_oracle.candidates if each.score == closest]
        same = [each for each in equal if _is_same(each, best[0])]
        chosen = same + [each for each in by_oracle.candidates if each not in same]
        return replace(by_oracle, candidates=chosen, agrees=bool(same))

    def _about(
        self, given: PartAnswer, heard: Anonymized, readings: Sequence[Reading[str]], fits: Fit
    ) -> AnsweredForm:
        """Return what is known of the first reading, for the calibration and the decision."""
        if not readings or readings[0].slots is None or readings[0].candidate.form == UNKNOWN:
            return AnsweredForm()
        best, part = readings[0], given.part
        is_oracle = part is not None and part is self.oracle
        scores = [_log_probability(each.candidate.score, part) for each in readings[:2]]
        known = [score for score in scores if score is not None]
        evidence = Evidence(
            part=self._kind_of(part),
            is_exact=is_oracle and not any(each.kind in _DOUBTFUL for each in best.candidate.heard),
            heard_cost=float(sum(each.kind != _COURTESY for each in best.candidate.heard))
            if is_oracle
            else 0.0,
            readings=sum(each.candidate.score == best.candidate.score for each in readings),
            learned_log_probability=None if is_oracle else scores[0],
            margin=known[0] - known[1] if len(known) > 1 else None,
            agrees=given.agrees,
            # What an unknown word may name was said.
            not_said=sum(not slot.phrases for slot in fits.not_said),
            left_out=len(fits.left_out),
            exchanged=bool(fits.exchanged),
            executable=best.executable_plans > 0,
            unknown_words=0 if is_oracle else self._unknown_words(heard, best.slots or ()),
        )
        is_open = any(slot.value is None for slot in best.slots or ())
        # Two names are equally near: "Hailey or Haley?"
        rivals = {
            each.candidate.values
            for each in readings
            if is_oracle and each.candidate.score == best.candidate.score and each.candidate.heard
        }
        is_ambiguous = len(rivals) > 1 and not given.agrees
        # "Put the desk on the apple": it cannot be meant as it was said.
        is_ambiguous |= any(
            len(each.slots) == 2 and not each.is_possible for each in fits.exchanged
        )
        return AnsweredForm(best.candidate.form, evidence, is_open, ambiguous=is_ambiguous)

    def _kind_of(self, part: LoadedParser | None) -> AnsweringPart:
        if part is not None and part is self.oracle:
            return AnsweringPart.ORACLE
        is_last = part is not None and part is self.last
        return AnsweringPart.LAST if is_last else AnsweringPart.LEARNED

    def _together(self, answer: Answer) -> dict[str, Any]:
        """Return what is said of several commands: the answer to each, and one plan of all."""
        several = [json.loads(self.write(each)) for each in answer.several]
        language = self.writer.language
        plans = [each.task_plan for each in understand(several, language)]
        texts = [each["utterance"] for each in several]
        joint = None
        if len(plans) <= MOST_COMMANDS:
            joint = join(plans, language.recipes, utterances=texts)
        questions = [each.message for each in answer.reasons]
        if answer.decision is Decision.CONFIRM:  # a yes is to all of them
            every = [each["candidates"][0]["english"] for each in several]
            questions.append(shall_i(", then ".join(every)))
        questions += [each["spoken"] for each in several if each["decision"] != Decision.ACT]
        said = next(iter(questions), joint.spoken if joint else "")
        return {
            "several": several,
            "joint_plan": joint.as_json() if joint else None,
            "spoken": said,
        }

    def _nearest(self, answer: Answer) -> list[str]:
        """Return commands that are near an utterance that was not understood, with entities of the world; none where
        somebody said what not to do."""
        is_lost = answer.decision is Decision.REFUSE and not answer.about.objections
        if not is_lost or answer.several or answer.given.part is None:
            return []
        language = self.writer.language
        near = language.near.nearest(answer.heard)
        return [with_entities(each, answer.heard, language.ontology) for each in near]

    def _spoken(self, answer: Answer, first: dict[str, Any]) -> str:
        """Return what the robot says by the decision. ``first`` is the JSON of the best candidate."""
        match answer.decision:
            case Decision.ACT:
                return str(first["spoken"])
            case Decision.CONFIRM:
                left_out = [each.message for each in answer.reasons if each.code == _LEFT_OUT]
                return " ".join((shall_i(first["english"]), *left_out))
            case Decision.ASK if first:
                asked = [slot["question"] for slot in first["open_slots"]]
                asked += [
                    gap["question"] for each in first["plan"]["unresolved"] for gap in each["open"]
                ]
                asked += [each["message"] for each in first["plan"]["problems"]]
                return next(iter(asked), shall_i(first["english"]))
        told = [each.message for each in answer.reasons if each.code not in _OF_FIT]
        return " ".join(told) or NOT_UNDERSTOOD


def _flat(pieces: Sequence[PartAnswer]) -> Iterator[PartAnswer]:
    """Yield the commands, those of a sentence that holds several too."""
    for piece in pieces:
        yield from _flat(piece.pieces) if piece.pieces else (piece,)


def _is_settled(answer: PartAnswer) -> bool:
    """Return whether the oracle understood an utterance as it is written, in one way, or its commands were answered."""
    if answer.pieces or not answer.text.strip():
        return True
    scores = [each.score for each in answer.candidates]
    return bool(scores) and scores[0] == 0 and scores.count(0) == 1


def _is_lost(answer: Answer) -> bool:
    """Return whether nothing was understood, or nothing that is trusted, of what may be a command."""
    return answer.is_unknown and not answer.about.objections and bool(answer.given.text.strip())


def _missing(given: PartAnswer) -> Iterator[str]:
    """Yield why the last part did not answer an utterance, or one of its commands."""
    if given.missing:
        yield given.missing
    for piece in given.pieces:
        yield from _missing(piece)


def _misfits(fits: Fit) -> Iterator[Objection]:
    """Yield what of a form does not fit what was said."""
    for slot in fits.not_said:
        if slot.phrases:
            continue
        noun = slot.entity_class
        yield Objection(_NOT_SAID, f"You did not say which {noun}.", 0, 0)
    for each in fits.left_out:
        message = f"“{each.text}” is left out." if each.text else "The number is left out."
        yield Objection(_LEFT_OUT, message, each.start, each.end)
    for pair in fits.exchanged:
        said = " and ".join(f"“{slot.filler}”" for slot in pair.slots)
        yield Objection(_ROLES, f"It is not certain which is which: {said}.", 0, 0)


def _form(reading: Reading[str]) -> Form:
    form = form_of(reading.candidate.form)
    assert form is not None
    return form


def _sequence(readings: Sequence[Reading[str]]) -> Candidate:
    """Return the candidate that does what several say, one after the other."""
    steps: list[Form] = []
    values: list[str | None] = []
    for reading in readings:
        steps += actions_of(_form(reading))
        values += [slot.filler for slot in reading.slots or () if slot.entity_class]
    return Candidate(canonical_text(Application(SEQUENCE, tuple(steps))), 0.0, values=tuple(values))


def _is_same(one: Candidate, other: Candidate) -> bool:
    first, second = form_of(one.form), form_of(other.form)
    return first is not None and second is not None and equivalent(first, second)


def _log_probability(score: float, part: LoadedParser | None) -> float | None:
    """Return the score as the logarithm of a probability; None where it is none."""
    kind = part.score_kind if part else ""
    if kind == ScoreKind.LOG_PROBABILITY:
        return min(score, 0.0)
    if kind == ScoreKind.PROBABILITY:
        return log(score) if score > 0 else LEAST_LOG
    return None
