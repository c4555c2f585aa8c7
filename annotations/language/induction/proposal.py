"""Propose a world from what people say: classes, entities, predicates, words that vary, and templates.

The program follows alignment-based learning (van Zaanen, COLING 2000), made synchronous by the forms: see
``synonyms`` and ``analogies``. It generalises carefully. Commands with other verbs are other predicates, until somebody
gives them one name; what only one pair of commands speaks for is offered and not taken.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import combinations, islice

from annotations.language.forms import (
    Application,
    Constant,
    Form,
    Nonterminal,
    Text,
    Wildcard,
    canonical_text,
    head_predicate,
    print_sequence,
    read_form,
    to_template,
    with_leaves,
)
from annotations.language.grammar import CHECK_STEPS, Budget
from annotations.language.induction.actions import Action, ArgumentOrder, orders_of, read_action
from annotations.language.induction.analogies import Derived, derive
from annotations.language.induction.classes import (
    MarkedClass,
    MarkedPlace,
    classes_of,
    folded,
)
from annotations.language.induction.clauses import clauses_of
from annotations.language.induction.lengthening import Change, Extension, StoredTemplates, extend
from annotations.language.induction.marked_lines import (
    Example,
    Mark,
    Part,
    read_examples,
    rewritten,
    said_apart,
    said_english,
    with_english,
)
from annotations.language.induction.names import other_names
from annotations.language.induction.offers import Offer, offers_for
from annotations.language.induction.rules import (
    Rule,
    Words,
    articles_varied,
    differences,
    is_slot,
    phrase_symbols,
    shared_at_end,
    with_tokens,
    without_articles,
)
from annotations.language.induction.synonyms import Synonyms, find_synonyms, with_nonterminals
from annotations.language.templates import TemplateChart
from annotations.language.texts import (
    DETERMINERS,
    MAX_GLOSS,
    Position,
    Problem,
    error_at,
)
from annotations.language.world import Predicate, PredicateKind, signature_of

CATEGORY = "commands"  # the task category of commands that people give as examples
MOST_DOUBTS = 2_000
MOST_ASKED = 3  # predicates of the world that a new one may be
_ANY = "<>"  # a slot whose class is not known yet


@dataclass(frozen=True)
class KnownWorld:
    """What a world has already.

    ``texts`` are what its entities are called, folded, with their class; ``rules`` some commands of its templates;
    ``nonterminals`` the names that its grammar has; ``stored`` are all of its templates. New templates go to the
    task category ``category``.
    """

    texts: Mapping[str, str] = field(default_factory=dict)
    predicates: Mapping[str, Predicate] = field(default_factory=dict)
    rules: tuple[Rule, ...] = ()
    nonterminals: frozenset[str] = frozenset()
    stored: StoredTemplates | None = None
    category: str = CATEGORY

    @property
    def chart(self) -> TemplateChart | None:
        """What understands all of its commands."""
        return self.stored.chart if self.stored else None

    @cached_property
    def orders(self) -> tuple[ArgumentOrder, ...]:
        """The roles of the arguments of its predicates, as the words of its templates say them."""
        orders: dict[str, ArgumentOrder] = {}
        for rule in sorted(self.rules, key=lambda each: len(each.words)):
            roles = _roles_in_order(rule)
            if roles is not None:
                order = orders.setdefault(
                    head_predicate(rule.form), ArgumentOrder(head_predicate(rule.form))
                )
                if order.takes(frozenset(roles)):
                    order.add(roles)
        return tuple(orders.values())

    @cached_property
    def verbs(self) -> Mapping[str, str]:
        """The predicate that the words of a command name, where all templates with these words agree."""
        names: defaultdict[str, set[str]] = defaultdict(set)
        for rule in self.rules:
            names[read_action(rule.words).name].add(head_predicate(rule.form))
        return {name: min(heads) for name, heads in names.items() if len(heads) == 1}

    @cached_property
    def roles(self) -> Mapping[tuple[str, str], str]:
        """The class of a role of a predicate."""
        found: dict[tuple[str, str], str] = {}
        for rule in self.rules:
            for role, token in zip(
                read_action(rule.words).roles, filter(is_slot, rule.words), strict=True
            ):
                found.setdefault((head_predicate(rule.form), role), token[1:-1])
        return found

    def understands(self, rule: Rule, is_given: bool) -> bool:
        """Return whether a command of its templates has the words of a rule, and its form.

        Where no form ``is_given``, that of the templates counts, as long as its predicate is that of the rule.
        """
        if self.chart is None:
            return False
        head, means = head_predicate(rule.form), canonical_text(with_tokens(rule.form))
        return any(
            each.form_text == means
            or (not is_given and head_predicate(read_form(each.form_text)) == head)
            for words in articles_varied(rule.words)
            for each in self.chart.parse(" ".join(words), Budget(CHECK_STEPS))
        )


def _roles_in_order(rule: Rule) -> list[str] | None:
    """Return the roles of a rule in the order of the arguments; None where its arguments are not its slots."""
    roles = read_action(rule.words).roles
    form = rule.form
    if not isinstance(form, Application):
        return None
    numbers = [each.id for each in form.arguments if isinstance(each, Wildcard) and each.id]
    if len(numbers) != len(form.arguments) or sorted(numbers) != list(range(1, len(roles) + 1)):
        return None
    return [roles[number - 1] for number in numbers]


@dataclass(frozen=True, slots=True)
class ProposedPredicate:
    """A predicate, the lines that show it, and whether somebody has said its name."""

    predicate: Predicate
    lines: tuple[int, ...]
    is_named: bool


@dataclass(frozen=True, slots=True)
class ProposedTemplate:
    """``pattern = form``, from lines; ``derived`` says what it follows from where nobody has said it."""

    rule: Rule
    lines: tuple[int, ...] = ()
    derived: Derived | None = None

    @property
    def pattern(self) -> str:
        return print_sequence(tuple(self._symbols()))

    @property
    def form(self) -> str:
        return to_template(self._slots_as_written(self.rule.form))

    def _symbols(self) -> Iterator[Text | Nonterminal | Wildcard]:
        number = 0
        for word in self.rule.words:
            if is_slot(word):
                number += 1
                yield self._wildcard(word[1:-1], number)
            else:
                yield from phrase_symbols((word,))

    def _wildcard(self, token: str, number: int) -> Wildcard:
        return Wildcard(token, id=number if self.rule.words.count(f"<{token}>") > 1 else None)

    def _slots_as_written(self, form: Form) -> Form:
        def change(leaf: Form) -> Form:
            if isinstance(leaf, Wildcard) and leaf.id is not None:
                return self._wildcard(leaf.name, leaf.id)
            return leaf

        return with_leaves(form, change)


@dataclass(frozen=True, slots=True)
class Doubt:
    """What only a person can say: whether two classes, or two predicates, are one. ``kind`` is class or predicate.

    ``comment`` is the line that says that they are not.
    """

    kind: str
    first: str
    second: str
    comment: str


@dataclass(frozen=True, slots=True)
class Proposal:
    """What the lines make. Classes and predicates that the world has are among them where lines use them.

    ``understood`` are the lines whose commands the world understands already: they make no templates. ``names`` has
    what else the texts of the classes may be called.
    """

    examples: tuple[Example, ...]
    problems: tuple[Problem, ...]
    classes: tuple[MarkedClass, ...]
    predicates: tuple[ProposedPredicate, ...]
    synonyms: tuple[Synonyms, ...]
    templates: tuple[ProposedTemplate, ...]
    offers: tuple[Offer, ...]
    doubts: tuple[Doubt, ...]
    tokens: Mapping[Mark, str]
    predicates_of_lines: Mapping[int, tuple[str, ...]]
    understood: tuple[int, ...] = ()
    changes: tuple[Change, ...] = ()
    names: Mapping[str, tuple[str, ...]] = field(default_factory=dict)


def propose(text: str, known: KnownWorld | None = None) -> Proposal:
    """Return what follows from the lines of a text.

    Args:
        text: examples, a line each, as ``read_examples`` reads them.
        known: what is there already.
    """
    known = known or KnownWorld()
    examples, problems = read_examples(text)
    clauses = [
        _Clause(example, parts, known) for example in examples for parts in clauses_of(example)
    ]
    orders = orders_of((each.action for each in clauses), known.orders)
    places = tuple(
        MarkedPlace(mark, orders[each.action].name, role, each.example.line)
        for each in clauses
        for mark, role in zip(each.marks, each.action.roles, strict=True)
    )
    tokens, classes = classes_of(places, known.texts, known.roles)
    lines: dict[Rule, list[int]] = {}
    given: set[Rule] = set()
    alike: dict[tuple[Words, Form], Rule] = {}
    for each in clauses:
        rule = each.rule(orders[each.action], tokens)
        # With and without an article is one: the oracle passes over them.
        first = alike.setdefault((without_articles(rule.words), rule.form), rule)
        lines.setdefault(first, []).append(each.example.line)
        if each.example.form is not None:
            given.add(first)
    new = {
        rule: where for rule, where in lines.items() if not known.understands(rule, rule in given)
    }
    not_understood = {line for where in new.values() for line in where}
    apart = said_apart(text)
    extended = Extension((), tuple(new), new)
    if known.stored:
        extended = extend(known.stored, known.category, new, given, apart, known.nonterminals)
    names = known.nonterminals | {each.name for each in extended.changes}
    rules, synonyms = find_synonyms(tuple(extended.written))
    synonyms, rules = _renamed(synonyms, tuple(extended.written), names)
    of_rule: defaultdict[Rule, list[int]] = defaultdict(list)
    for rule, where in extended.written.items():
        of_rule[with_nonterminals(rule, synonyms)] += where
    templates = [ProposedTemplate(rule, tuple(sorted(set(of_rule[rule])))) for rule in rules]
    analogies = derive(rules)
    templates += [ProposedTemplate(each.rule, derived=each) for each in analogies if each.is_sure]
    used: defaultdict[str, list[int]] = defaultdict(list)
    of_lines: defaultdict[int, list[str]] = defaultdict(list)
    for each in clauses:
        head = head_predicate(each.rule(orders[each.action], tokens).form)
        used[head].append(each.example.line)
        of_lines[each.example.line].append(head)
    named = {each.example.action for each in clauses} | known.predicates.keys()
    comments = {name: said for name, said in said_english(text).items() if name in used}
    english = {name: gloss for name, (gloss, _) in comments.items() if len(gloss) <= MAX_GLOSS}
    problems += tuple(
        error_at(
            Position(line=line), f"the English of {name} is too long", f"{MAX_GLOSS} is the limit"
        )
        for name, (_, line) in comments.items()
        if name not in english
    )
    predicates = tuple(
        ProposedPredicate(
            _predicate(
                name,
                [
                    rule
                    for rule in (extended.left if name in known.predicates else lines)
                    if head_predicate(rule.form) == name
                ],
                known,
                english,
            ),
            tuple(sorted(set(where))),
            name in named,
        )
        for name, where in used.items()
    )
    doubts = tuple(_doubts(predicates, classes, tuple(lines), named, places, tokens, apart))
    asked = {frozenset((each.first, each.second)) for each in doubts}
    not_given = [each for each in extended.left if each not in given]
    return Proposal(
        examples,
        problems,
        classes,
        predicates,
        synonyms,
        tuple(templates),
        offers_for(extended.left, analogies, {each.token: each.marks for each in classes}),
        (*doubts, *_stored_doubts(not_given, named, apart | asked, known)),
        tokens,
        {line: tuple(dict.fromkeys(names)) for line, names in of_lines.items()},
        tuple(
            each.line
            for each in examples
            if each.line not in not_understood
            and all(folded(mark.text) in known.texts for mark in each.marks)
        ),
        extended.changes,
        other_names(classes, known.texts, apart, (*lines, *known.rules)),
    )


@dataclass(frozen=True)
class _Clause:
    example: Example
    parts: tuple[Part, ...]
    known: KnownWorld

    @property
    def marks(self) -> tuple[Mark, ...]:
        return tuple(part for part in self.parts if isinstance(part, Mark))

    @cached_property
    def action(self) -> Action:
        read = read_action(tuple(_ANY if isinstance(part, Mark) else part for part in self.parts))
        if self.example.form is not None:
            return replace(read, name=head_predicate(self.example.form))
        name = self.example.action or self.known.verbs.get(read.name, read.name)
        return replace(read, name=name)

    def rule(self, order: ArgumentOrder, tokens: Mapping[Mark, str]) -> Rule:
        words = tuple(
            f"<{tokens[part]}>" if isinstance(part, Mark) else part for part in self.parts
        )
        slots = [
            Wildcard(tokens[mark], id=number) for number, mark in enumerate(self.marks, start=1)
        ]
        if self.example.form is not None:
            texts = {folded(mark.text): slot for mark, slot in zip(self.marks, slots, strict=True)}
            return Rule(words, _with_slots(self.example.form, texts))
        by_role = dict(zip(self.action.roles, slots, strict=True))
        arguments = tuple(by_role[role] for role in order.roles if role in by_role)
        return Rule(words, Application(order.name, arguments))


def _with_slots(form: Form, texts: Mapping[str, Wildcard]) -> Form:
    """Return the form with the slots of the marked texts in place of the constants that name them."""

    def change(leaf: Form) -> Form:
        if isinstance(leaf, Constant) and isinstance(leaf.value, str):
            return texts.get(folded(leaf.value), leaf)
        return leaf

    return with_leaves(form, change)


def _renamed(
    synonyms: Sequence[Synonyms], rules: Sequence[Rule], taken: frozenset[str]
) -> tuple[tuple[Synonyms, ...], tuple[Rule, ...]]:
    """Return the synonyms under names that the grammar does not have yet, and the rules written with them."""
    used = set(taken)
    renamed: list[Synonyms] = []
    for each in synonyms:
        numbered = (f"{each.name}{n}" for n in range(2, 100_000))
        name = each.name if each.name not in used else next(n for n in numbered if n not in used)
        used.add(name)
        renamed.append(replace(each, name=name))
    written = dict.fromkeys(with_nonterminals(rule, renamed) for rule in rules)
    return tuple(renamed), tuple(written)


def _predicate(
    name: str, rules: Sequence[Rule], known: KnownWorld, english: Mapping[str, str]
) -> Predicate:
    """Return a predicate with the signatures that the rules use, and how they say it in English.

    ``english`` has the gloss patterns that somebody has written. One of the world is otherwise as it is there, unless
    it takes other arguments as well now.
    """
    own = known.predicates.get(name)
    before = own.signatures if own else ()
    new = sorted(
        {signature_of(r.form) for r in rules if isinstance(r.form, Application)} - {*before}
    )
    if own is not None and not new:
        return replace(own, gloss=english.get(name, own.gloss))
    said: dict[int, str] = {}
    for rule in sorted(rules, key=lambda each: len(each.words)):
        form = rule.form
        if isinstance(form, Application) and all(
            isinstance(each, Wildcard) for each in form.arguments
        ):
            said.setdefault(len(form.arguments), _gloss(rule, form))
    if own is not None:
        arities = {len(each.arguments) for each in before}
        more = [said[arity] for arity in said if arity not in arities] if own.gloss else []
        longer = " | ".join((own.gloss, *more))
        gloss = longer if len(longer) <= MAX_GLOSS else own.gloss
        return replace(own, signatures=(*before, *new), gloss=english.get(name, gloss))
    gloss = " | ".join(said.values())
    return Predicate(
        name,
        PredicateKind.ACTION,
        tuple(new),
        english.get(name, gloss if len(gloss) <= MAX_GLOSS else ""),
    )


def _gloss(rule: Rule, form: Application) -> str:
    """Return the words of a rule with the places of its arguments: ``water {1} in {2}``."""
    numbers = [each.id for each in form.arguments if isinstance(each, Wildcard)]
    words: list[str] = []
    slot = 0
    for word in rule.words:
        if is_slot(word):
            slot += 1
            if words and words[-1].lower() in DETERMINERS:
                words.pop()
            words.append(f"{{{numbers.index(slot) + 1}}}")
        elif word != ",":
            words.append(word)
    return " ".join(words)


def _doubts(
    predicates: Sequence[ProposedPredicate],
    classes: Sequence[MarkedClass],
    rules: Sequence[Rule],
    named: Iterable[str],
    places: Sequence[MarkedPlace],
    tokens: Mapping[Mark, str],
    apart: Iterable[frozenset[str]],
) -> Iterator[Doubt]:
    """Yield what may be one: predicates whose commands differ in their verb alone, classes behind one preposition.

    ``apart`` are the pairs that are said not to be: names of predicates, or marked texts in their brackets. Nobody
    answers very many questions: of predicates there are at most ``MOST_DOUBTS``.
    """
    new = {each.predicate.name for each in predicates} - set(named)
    token_of = {f"[{mark.text}]": token for mark, token in tokens.items()}
    seen = {frozenset(token_of.get(each, each) for each in pair) for pair in apart}
    asked = 0
    headed = [(head_predicate(each.form), each.words) for each in rules]
    for (first, words), (second, others) in combinations(headed, 2):
        pair = frozenset((first, second))
        if first == second or pair.isdisjoint(new) or pair in seen or asked == MOST_DOUBTS:
            continue
        if _differ_in_verb(words, others):
            seen.add(pair)
            asked += 1
            yield Doubt("predicate", first, second, f"# {first} is not {second}")
    roles: defaultdict[str, dict[str, None]] = defaultdict(dict)
    for place in places:
        if place.role.partition(" ")[0]:  # behind a preposition
            roles[place.role].setdefault(tokens[place.mark])
    member = {each.token: each.texts[0] for each in classes}
    unnamed = {each.token for each in classes if not each.is_named}
    for of_role in roles.values():
        for first, second in combinations(of_role, 2):
            if {first, second} & unnamed and frozenset((first, second)) not in seen:
                seen.add(frozenset((first, second)))
                comment = f"# [{member[first]}] is not [{member[second]}]"
                yield Doubt("class", first, second, comment)


def _stored_doubts(
    rules: Iterable[Rule],
    named: Iterable[str],
    apart: Iterable[frozenset[str]],
    known: KnownWorld,
) -> Iterator[Doubt]:
    """Yield what new predicates may be of those that the world has: templates differ from them in the verb alone."""
    if known.stored is None:
        return
    names, seen = set(named), set(apart)
    budget = Budget(CHECK_STEPS)
    for rule in rules:
        new = head_predicate(rule.form)
        if new in names:
            continue
        others = (
            spot.head
            for spot in known.stored.spots(rule.words, "", budget)
            if rule.words[: len(spot.phrase)] == spot.phrase
            and _role_behind(spot.phrase) == _role_behind(print_sequence(spot.old).split())
        )
        for other in islice(dict.fromkeys(others), MOST_ASKED):
            if frozenset((new, other)) not in seen:
                seen.add(frozenset((new, other)))
                yield Doubt("predicate", new, other, f"# {new} is not {other}")


def _role_behind(words: Sequence[str]) -> tuple[str, ...]:
    """Return the role of a slot behind some words."""
    return read_action((*words, _ANY)).roles


def _differ_in_verb(left: Words, right: Words) -> bool:
    end = shared_at_end(left, right)
    before, instead = left[: len(left) - end], right[: len(right) - end]
    if any(map(is_slot, (*before, *instead))) or not {*before}.isdisjoint(instead):
        return False
    found = differences(left, right)
    return (
        len(found) == 1
        and found[0].start == found[0].other_start == 0
        and not any(map(is_slot, (*found[0].old, *found[0].new)))
    )


def with_class_named(text: str, proposal: Proposal, token: str, name: str) -> str:
    """Return the lines with ``name`` behind each mark of the class ``token`` of their proposal."""

    def change(example: Example) -> Example:
        parts = (
            replace(part, entity_class=name)
            if isinstance(part, Mark) and proposal.tokens.get(part) == token
            else part
            for part in example.parts
        )
        return replace(example, parts=tuple(parts))

    return rewritten(text, change)


def with_predicate_named(text: str, proposal: Proposal, predicate: str, name: str) -> str:
    """Return the lines with ``= name`` behind each command of a predicate; those of several commands stay."""

    def change(example: Example) -> Example:
        is_of_it = proposal.predicates_of_lines.get(example.line) == (predicate,)
        one = len(clauses_of(example)) == 1 and example.form is None
        return replace(example, action=name) if is_of_it and one else example

    english = said_english(text)
    if predicate in english and name != predicate:
        text = with_english(text, predicate, "")
        text = text if name in english else with_english(text, name, english[predicate][0])
    return rewritten(text, change)
