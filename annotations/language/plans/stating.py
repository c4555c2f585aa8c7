"""Tell what asks for nothing: stories, reports of facts, plans of the speaker, questions about the past.

Who is the subject, in which tense, and is anything wanted? An utterance is a statement if one of its clauses is one
and none may ask for something. Whatever is not certain may: a clause that begins with a verb, that says what is
wanted, needed or due, or that tells the robot what to do.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from annotations.language.texts import (
    ADVERBS,
    DETERMINERS,
    IMAGINING_PHRASES,
    INDEFINITE_PERSONS,
    NUMBERS,
    PAST_VERBS,
    PLACE_PREPOSITIONS,
    REPORTING_VERBS,
    THINKING_PHRASES,
    TIME_PHRASES,
    WANTING_PHRASES,
)


def _any_of(phrases: Iterable[str]) -> str:
    longest_first = sorted(phrases, key=len, reverse=True)
    return rf"(?:{'|'.join(map(re.escape, longest_first))})(?!\w)"


_NAME = "_+"  # an entity, whose name is blotted out
_PRONOUN = rf"(?:he|she|it|they|this|that|there|these|those|{_any_of(INDEFINITE_PERSONS)})(?!\w)"
_NOUN = r"(?!(?:that|who|which)\b)[a-z_]+"
_NOUNS = rf"{_NOUN}(?: {_NOUN}){{0,2}}?"
_WHERE = rf"(?: (?:in|on|at|from|with) (?:the )?{_NAME}(?!\w))?"
_THIRD = (
    rf"(?:{_PRONOUN}|{_any_of((*DETERMINERS, *NUMBERS))} {_NOUNS}{_WHERE}|(?:people|{_NAME})(?!\w))"
)
_SOMEBODY = rf"(?:(?:i|we|you)(?!\w)|{_THIRD})"
_ADVERBS = rf"(?: (?:{_any_of(ADVERBS)}|[a-z]+ly(?!\w))){{0,3}}"
_PAST = rf"(?:(?!(?:named|called|dressed)\b)[a-z]{{2,}}ed|{_any_of(PAST_VERBS)})(?!\w)"
_PARTICIPLE = rf"(?:{_PAST}|been(?!\w)|[a-z]{{2,}}en(?!\w))"
_NOT = "(?:n't)?"
_PERFECT = rf"(?:(?: (?:have|has|had){_NOT}|'(?:ve|s|d)){_ADVERBS} {_PARTICIPLE})"
_PRESENT = r"(?: (?:am|is|are)(?!\w)|'(?:m|s|re)(?!\w))"
_FUTURE = r"(?: (?:will|can|shall|might)|'ll)(?! (?:have|take|you)\b)(?!\w)"
# "It's urgent that somebody finds Robin", "Charlie is the person to greet": somebody is to do something.
_IS_DUE = rf"(?!.* (?:to (?!{_any_of(DETERMINERS)}|{_NAME})|that ))"
_THERE = rf"(?:{_any_of(PLACE_PREPOSITIONS | DETERMINERS)})"
_JOINTS = ("and", "so", "but", "well", "because", "since", "that")
_BEFORE = _any_of((*TIME_PHRASES, *ADVERBS, *THINKING_PHRASES, *_JOINTS))
_OPENING = rf"(?:{_BEFORE},? ){{0,4}}"
_UNREAL = r"(?:would|could|should|might|must) have"
_STATEMENT = re.compile(
    rf"{_OPENING}(?:"
    rf"{_SOMEBODY}(?:{_ADVERBS} (?:{_PAST}|(?:did|was|were){_NOT}(?!\w))|{_PERFECT}| {_UNREAL} {_PARTICIPLE})"
    rf"|(?:i|we){_PRESENT}|{_THIRD}{_PRESENT}{_IS_DUE}|(?:(?:i|we)(?!\w)|{_THIRD}){_ADVERBS}{_FUTURE}"
    rf"|(?:he|she|{_NAME}){_ADVERBS} [a-z]{{2,}}s(?!\w)"
    rf"|you(?: are|'re) {_THERE}"
    r")"
)
# Questions about the past, and about what somebody can do or likes.
_QUESTION = re.compile(
    rf"{_OPENING}(?:(?:who|what|why|where|when|how|which)(?: [a-z_]+)? )?(?:"
    rf"(?:did|was|were|had) {_SOMEBODY}|has {_NAME} {_PAST}"
    r"|(?:have|has) (?:you|i|we|he|she|they|it)(?!\w)(?! got)"
    rf"|(?<=who ){_PAST}"
    r"|(?<=how )(?:do|does|would) (?:you|i|we|one)(?!\w)|are you able|do you know how to"
    rf"|do you{_ADVERBS} (?!mind|think|know|want|see|have|wish)[a-z]+)"
)
_WANTING = re.compile(rf"(?<!\w){_any_of(WANTING_PHRASES)}|'d (?!{_PAST}|been)(?!have\b)")
_HYPOTHETICAL = re.compile(rf"{_UNREAL}(?= {_PARTICIPLE})")
# "The man said: bring me the cola" tells of somebody; "Anna asked you to" does not.
_REPORT = re.compile(
    rf"{_OPENING}{_THIRD}{_ADVERBS} (?:{_any_of(REPORTING_VERBS)})(?! (?:you|for)(?!\w))"
)
_IMAGINING = re.compile(rf"{_OPENING}{_any_of(IMAGINING_PHRASES)}")
# "… and took the cola", after a statement; "put" may be an order.
_ON = re.compile(rf"(?:and |then )*(?!put\b){_PAST}")
# Says nothing by itself: "in the kitchen", "the small one".
_BEGINNING = _any_of(
    (*PLACE_PREPOSITIONS, *DETERMINERS, "no", "yes", "oh", "for", "with", "of", "all")
)
_FRAGMENT = re.compile(rf"{_OPENING}(?:(?:{_BEGINNING}|{_NAME}(?!\w)).*)?$")
_SENTENCE = re.compile(r"[^.!?;…\n]+")
_CLAUSES = re.compile(r"[,:–—\"“”]|(?<!\w)(?=(?:and|so|but|because|then)\s)")
_LONGEST_CLAUSE = 200  # characters that are looked at


def states(text: str) -> bool:
    """Return whether a text asks for nothing, since it states or asks about facts. Takes linear time.

    Args:
        text: with straight apostrophes, and an underscore for each character of a name of an entity.
    """
    has_statement = False
    for sentence in _SENTENCE.findall(text.casefold()):
        clauses = [each for each in map(_plain, _CLAUSES.split(sentence)) if each]
        if clauses and (_IMAGINING.match(clauses[0]) or _REPORT.match(clauses[0])):
            has_statement = True
            continue
        is_told = False
        for clause in clauses:
            if _is_statement(clause, is_told):
                is_told = has_statement = True
            elif not _FRAGMENT.match(clause) or _WANTING.search(clause):
                return False
    return has_statement


def _plain(clause: str) -> str:
    return " ".join(clause[:_LONGEST_CLAUSE].split())


def _is_statement(clause: str, is_told: bool) -> bool:
    if _WANTING.search(_HYPOTHETICAL.sub("had", clause)):
        return False
    return bool(
        _STATEMENT.match(clause) or _QUESTION.match(clause) or (is_told and _ON.match(clause))
    )
