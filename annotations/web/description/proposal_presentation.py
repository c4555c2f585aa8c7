"""What the page By example shows of a proposal: why each thing is proposed, and what else would be understood."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import count, islice

from annotations.language.forms import head_predicate
from annotations.language.induction import (
    Change,
    Derived,
    Doubt,
    KnownWorld,
    MarkedClass,
    Offer,
    OfferKind,
    Proposal,
    ProposedTemplate,
    Synonyms,
    folded,
    is_slot,
)
from annotations.language.texts import say_count
from annotations.language.world import Signature, print_signatures

MOST_SAMPLES = 3  # of a predicate
MOST_TRIED = 30  # ways to fill a template, until so many are new
MOST_SHOWN = 12  # doubts, and offers of one kind
OFFER_TITLES = {
    OfferKind.ORDER: "The same words in another order",
    OfferKind.WORDING: "Other words that people use",
    OfferKind.ANALOGY: "As two of your lines differ",
}


@dataclass(frozen=True, slots=True)
class ShownClass:
    """``name`` is empty where nobody has said it; ``new`` are the members that the world lacks.

    ``names`` are what else these may be called, each with the line that refuses it.
    """

    token: str
    name: str
    is_known: bool
    members: tuple[str, ...]
    new: frozenset[str]
    names: tuple[tuple[str, str], ...]
    why: str


@dataclass(frozen=True, slots=True)
class ShownPredicate:
    """``english`` has class tokens in the places of the arguments, a sentence for each number of them.

    ``gloss`` is their pattern. ``is_changed`` says that the world has it otherwise, or not at all.
    """

    name: str
    is_known: bool
    signatures: str
    gloss: str
    is_changed: bool
    english: tuple[str, ...]
    why: str
    samples: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ShownDoubt:
    """``old`` are the names that become ``name``, which is empty where a person has to say it."""

    kind: str
    first: str
    second: str
    comment: str
    old: tuple[str, ...]
    name: str


@dataclass(frozen=True, slots=True)
class ShownTemplate:
    pattern: str
    form: str
    why: str


@dataclass(frozen=True, slots=True)
class ShownWords:
    name: str
    phrases: str
    why: str


@dataclass(frozen=True, slots=True)
class ShownChange:
    """``edits`` are stored lines before and after; ``comments`` the lines that refuse the change."""

    old: str
    phrases: str
    edits: tuple[tuple[str, str], ...]
    comments: tuple[str, ...]
    why: str


@dataclass(frozen=True, slots=True)
class ShownOffers:
    """``lines`` are some of ``total``, each beside the command alone."""

    kind: str
    title: str
    lines: tuple[tuple[str, str], ...]
    total: int


@dataclass(frozen=True, slots=True)
class ShownProposal:
    """``unnamed`` counts the classes that need a name before anything can be stored."""

    summary: str
    classes: tuple[ShownClass, ...]
    predicates: tuple[ShownPredicate, ...]
    words: tuple[ShownWords, ...]
    templates: tuple[ShownTemplate, ...]
    changes: tuple[ShownChange, ...]
    doubts: tuple[ShownDoubt, ...]
    offers: tuple[ShownOffers, ...]
    understood: str
    unnamed: int


def shown(proposal: Proposal, known: KnownWorld) -> ShownProposal:
    """Return what the page shows of a proposal for a world."""
    classes = tuple(_class(each, proposal, known) for each in proposal.classes)
    predicates = tuple(_predicates(proposal, known))
    new = {
        "kind of things": sum(not each.is_known for each in classes),
        "thing": sum(len(each.new) for each in classes),
        "action": sum(not each.is_known for each in predicates),
        "template": len(proposal.templates),
        "change": len(proposal.changes),
    }
    return ShownProposal(
        ", ".join(say_count(number, noun) for noun, number in new.items() if number),
        classes,
        predicates,
        tuple(map(_words, proposal.synonyms)),
        tuple(map(_template, proposal.templates)),
        tuple(map(_change, proposal.changes)),
        tuple(_doubt(each, proposal) for each in proposal.doubts[:MOST_SHOWN]),
        tuple(_offers(proposal.offers)),
        _lines(proposal.understood),
        sum(not each.is_named for each in proposal.classes),
    )


def _lines(numbers: Sequence[int]) -> str:
    if not numbers:
        return ""
    shown = ", ".join(map(str, numbers[:MOST_SHOWN])) + (" …" if len(numbers) > MOST_SHOWN else "")
    return f"{'line' if len(numbers) == 1 else 'lines'} {shown}"


def _class(each: MarkedClass, proposal: Proposal, known: KnownWorld) -> ShownClass:
    new = frozenset(text for text in each.texts if known.texts.get(folded(text)) != each.token)
    is_known = each.token in known.texts.values()
    reasons = list(dict.fromkeys(filter(None, (_reason(*evidence) for evidence in each.evidence))))
    why = f"{_lines(each.lines)}: " + ("; ".join(reasons[:3]) or "marked once")
    names = tuple(
        (name, f"# [{name}] is not [{text}]")
        for text in each.texts
        if text in new
        for name in proposal.names[text]
    )
    return ShownClass(
        each.token, each.token if each.is_named else "", is_known, each.texts, new, names, why
    )


def _reason(kind: str, what: str, role: str = "") -> str:
    match kind:
        case "said":
            return "so it is said"
        case "word":
            return f"they share the word “{what}”"
        case "role":
            return f"they stand behind “{role}” in {what}" if role else f"one says {what} of them"
    return ""


def _predicates(proposal: Proposal, known: KnownWorld) -> Iterator[ShownPredicate]:
    said = {each.text.casefold() for each in proposal.examples}
    texts = {each.token: each.texts for each in proposal.classes}
    phrases = {
        f"${each.name}": [" ".join(phrase) for phrase in each.phrases] for each in proposal.synonyms
    }
    of_head: defaultdict[str, list[ProposedTemplate]] = defaultdict(list)
    for template in proposal.templates:
        of_head[head_predicate(template.rule.form)].append(template)
    for each in proposal.predicates:
        predicate = each.predicate
        name, is_known = predicate.name, predicate.name in known.predicates
        source = (
            "the world has it"
            if is_known
            else "so it is said"
            if each.is_named
            else "after its words"
        )
        yield ShownPredicate(
            name,
            is_known,
            " ".join(print_signatures(predicate.signatures).splitlines()),
            predicate.gloss,
            known.predicates.get(name) != predicate,
            tuple(_english(predicate.gloss, predicate.signatures)),
            f"{_lines(each.lines)}: {source}",
            tuple(islice(_samples(of_head[name], texts, phrases, said), MOST_SAMPLES)),
        )


def _english(gloss: str, signatures: Sequence[Signature]) -> Iterator[str]:
    """Yield the sentences of a gloss with the kinds of a signature in the places of the arguments."""
    by_length = {len(each.arguments): each.arguments for each in signatures}
    for pattern in filter(None, gloss.split(" | ")):
        number = next(n for n in count() if f"{{{n + 1}}}" not in pattern)
        for place, kind in enumerate(map(str, by_length.get(number, ())), start=1):
            pattern = pattern.replace(f"{{{place}}}", f"<{kind}>")
        yield pattern


def _samples(
    templates: Sequence[ProposedTemplate],
    texts: dict[str, tuple[str, ...]],
    phrases: dict[str, list[str]],
    said: set[str],
) -> Iterator[str]:
    """Yield sentences that nobody has said and that would be understood."""
    found = set(said)
    for number in range(MOST_TRIED):
        for template in templates:
            words, places = [], count(number)
            for word in template.rule.words:
                place = number + next(places) if is_slot(word) or word in phrases else 0
                choices = texts[word[1:-1]] if is_slot(word) else phrases.get(word, [word])
                words.append(choices[place % len(choices)])
            sentence = " ".join(words).replace(" ,", ",")
            if sentence.casefold() not in found:
                found.add(sentence.casefold())
                yield sentence


def _words(each: Synonyms) -> ShownWords:
    where = "in all commands" if each.holds_everywhere else f"in {', '.join(sorted(each.heads))}"
    why = f"they stand in one place of lines that mean the same, {where}"
    return ShownWords(each.name, " | ".join(map(" ".join, each.phrases)), why)


def _template(each: ProposedTemplate) -> ShownTemplate:
    why = _derived(each.derived) if each.derived else _lines(each.lines)
    return ShownTemplate(each.pattern, each.form, why)


def _derived(each: Derived) -> str:
    old, new = " ".join(each.old) or "nothing", " ".join(each.new) or "nothing"
    pairs = say_count(len(each.examples), "pair")
    return f"nobody has said it: “{new}” for “{old}”, as in {pairs} of lines"


def _change(each: Change) -> ShownChange:
    edits = tuple((edit.before, edit.after) for edit in each.edits)
    why = f"{_lines(each.lines)}: all else is as in a template"
    if each.templates > 1:
        why += f"; {say_count(each.templates, 'template')} say “{each.old}”"
    return ShownChange(each.old, ", ".join(each.phrases), edits, each.comments, why)


def _doubt(each: Doubt, proposal: Proposal) -> ShownDoubt:
    if each.kind == "class":
        named = {one.token for one in proposal.classes if one.is_named}
        members = {one.token: one.texts[0] for one in proposal.classes}
        names = [token for token in (each.first, each.second) if token in named]
        said = [token if token in named else members[token] for token in (each.first, each.second)]
        old = tuple(token for token in (each.first, each.second) if token not in names)
        return ShownDoubt("class", said[0], said[1], each.comment, old, names[0] if names else "")
    named_actions = {one.predicate.name for one in proposal.predicates if one.is_named}
    names = [each.first, each.second]
    if each.second in named_actions:  # the other one is new
        names.reverse()
    return ShownDoubt("predicate", each.first, each.second, each.comment, (names[1],), names[0])


def _offers(offers: Sequence[Offer]) -> Iterator[ShownOffers]:
    for kind, title in OFFER_TITLES.items():
        lines = [(each.line, each.line.partition(" = ")[0]) for each in offers if each.kind is kind]
        if lines:
            yield ShownOffers(str(kind), title, tuple(lines[:MOST_SHOWN]), len(lines))
