"""The atoms that can continue a typed form, so that every form which ends passes the checker.

The checker (``check_form``) knows the predicates, how many arguments each takes and of what kinds; the
reader of forms wants every variable bound. Where an atom is allowed, some form that begins so is
within the limits of the ``Rules``: the least that completes it is known before it is written.
Variables are numbered by depth and each form has one spelling, so no two answers are the same form.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum, auto

from annotations.language.forms import UNKNOWN, Application, Form, Lambda, Variable
from annotations.language.world import ArgumentKind, admits, argument_kind
from parser_service.neural.t5.rules import NESTED, NEVER, Costs, Kinds, Rules, own_length
from parser_service.neural.t5.spelling import INSIDE, spell
from parser_service.parsers.remembering import remembered
from parser_service.parsers.short import CLOSE

REMEMBERED = 2_000  # states whose continuations are kept, of some kilobytes each


class PartKind(Enum):
    """What an open part of a form is."""

    ROOT = auto()  # the place of the whole form
    LAMBDA = auto()
    LEAF = auto()  # an application of leaves, whose end no atom marks
    NESTED = auto()  # an application with a λ or an application inside, or without arguments


@dataclass(frozen=True, slots=True)
class OpenPart:
    """A part of a form that more may be added to.

    ``signatures`` are those that its arguments allow so far, ``filled`` counts its parts, and ``bound``
    the λs around them.
    """

    place: PartKind
    signatures: tuple[Kinds, ...] = ()
    filled: int = 0
    has_nested: bool = False
    bound: int = 0

    def is_closable(self) -> bool:
        """Return whether it may end here, spelled as it is."""
        if self.place in (PartKind.ROOT, PartKind.LAMBDA):
            return self.filled > 0
        if self.place == PartKind.NESTED and self.filled and not self.has_nested:
            return False
        return any(len(kinds) == self.filled for kinds in self.signatures)

    def with_part(self, kind: str, may_refuse: bool = False) -> OpenPart | None:
        """Return it with one more part of ``kind``; None where that is not allowed."""
        is_nested = kind in NESTED
        if self.place in (PartKind.ROOT, PartKind.LAMBDA):
            is_refusal = may_refuse and self.place == PartKind.ROOT and kind == ArgumentKind.UNKNOWN
            is_allowed = is_nested or is_refusal
            if not is_allowed or (self.place == PartKind.ROOT and self.filled):
                return None
            return replace(self, filled=self.filled + 1)
        place = self.filled
        left = tuple(s for s in self.signatures if len(s) > place and admits(s[place], kind))
        has_nested = self.has_nested or is_nested
        return (
            replace(self, signatures=left, filled=place + 1, has_nested=has_nested)
            if left
            else None
        )


@dataclass(frozen=True, slots=True)
class UnfinishedForm:
    """A form that is being written: its open parts, the innermost last, and its bytes so far."""

    parts: tuple[OpenPart, ...] = (OpenPart(PartKind.ROOT),)
    spent: int = 0
    has_just_closed: bool = False


START = UnfinishedForm()


class Automaton:
    """Tells which atoms may follow, for forms by ``rules``."""

    def __init__(self, rules: Rules):
        self.rules = rules
        self.costs = Costs(rules)
        self.may_refuse = rules.may_refuse or self._least(START) > rules.longest
        # Every term that one atom writes or begins, without its parts.
        levels = range(1, rules.lambdas + 1)
        terms: list[Form] = [
            *rules.leaves(rules.lambdas),
            *(Lambda(level, type_, ()) for level in levels for type_ in rules.types),
            *map(Application, rules.signatures),
        ]
        self._terms = {atom: term for term in terms for atom in _spellings(term)}
        self.atoms = (*self._terms, CLOSE)
        self._alike = self._group()

    def continuations(self, state: UnfinishedForm) -> list[str]:
        """Return the atoms after which a form within the limits can be completed."""
        left = self.rules.longest - state.spent
        needs = self._count_needs(replace(state, spent=0))
        return [atom for atom, needed in needs if needed <= left]

    def follow(self, state: UnfinishedForm, atom: str) -> UnfinishedForm | None:
        """Return the state after ``atom``; None where it may not follow."""
        inner, ended = state.parts[-1], state
        if inner.place == PartKind.LEAF and not atom.startswith(INSIDE):  # which no atom ends
            if not inner.is_closable():
                return None
            ended = replace(state, parts=state.parts[:-1])
        if atom == CLOSE:
            if len(ended.parts) == 1 or not ended.parts[-1].is_closable():
                return None
            return UnfinishedForm(ended.parts[:-1], ended.spent, has_just_closed=True)
        term = self._terms.get(atom)
        if term is None:
            return None
        if atom.startswith(INSIDE) and inner.place != PartKind.LEAF:
            return None
        return self._add(ended, term, atom)

    def can_end(self, state: UnfinishedForm) -> bool:
        """Return whether the form may end here: all that is open closes without an atom."""
        return not state.has_just_closed and all(each.is_closable() for each in state.parts)

    def accepts(self, atoms: Sequence[str]) -> bool:
        """Return whether ``atoms`` may be written, each in its place, and may end there."""
        state = START
        for atom in atoms:
            after = self.follow(state, atom)
            if after is None or after.spent + self._least(after) > self.rules.longest:
                return False
            state = after
        return self.can_end(state)

    @remembered(REMEMBERED)
    def _count_needs(self, state: UnfinishedForm) -> list[tuple[str, int]]:
        """Return the atoms that may follow, each with the least bytes of it and of what completes the
        form. Atoms that are alike are tried together."""
        needs = []
        for atoms in self._alike:
            after = self.follow(state, atoms[0])
            if after is None or (least := self._least(after)) >= NEVER:
                continue
            for atom in atoms:
                own = 0 if atom == CLOSE else own_length(self._terms[atom])
                needs.append((atom, own + least))
        return needs

    def _group(self) -> list[list[str]]:
        """Return the atoms in groups, of which the same may follow each."""
        groups: dict[object, list[str]] = {}
        for atom, term in self._terms.items():
            key: tuple[object, ...] = (atom.startswith(INSIDE), argument_kind(term))
            if isinstance(term, Application):
                key = (atom.endswith(INSIDE), self.rules.signatures[str(term.predicate)])
            elif isinstance(term, Lambda | Variable):
                key = (*key, term.variable if isinstance(term, Lambda) else term.index)
            groups.setdefault(key, []).append(atom)
        return [*groups.values(), [CLOSE]]

    def _add(self, state: UnfinishedForm, term: Form, atom: str) -> UnfinishedForm | None:
        """Return the state with ``term`` in the innermost open part."""
        *outer, inner = state.parts
        if isinstance(term, Variable) and term.index > inner.bound:
            return None
        holder = inner.with_part(argument_kind(term), self.may_refuse)
        if holder is None:
            return None
        spent = state.spent + own_length(term)
        if not isinstance(term, Lambda | Application):
            return UnfinishedForm((*outer, holder), spent)
        opened = self._open(term, atom, inner.bound)
        if opened is None or len(state.parts) > self.rules.deepest:
            return None
        return UnfinishedForm((*outer, holder, opened), spent)

    def _open(self, term: Lambda | Application, atom: str, bound: int) -> OpenPart | None:
        if isinstance(term, Lambda):
            is_next = term.variable == bound + 1
            return OpenPart(PartKind.LAMBDA, bound=bound + 1) if is_next else None
        overloads = self.rules.signatures[str(term.predicate)]
        if not atom.endswith(INSIDE):
            return OpenPart(PartKind.NESTED, overloads, bound=bound)
        with_arguments = tuple(kinds for kinds in overloads if kinds)
        return OpenPart(PartKind.LEAF, with_arguments, bound=bound) if with_arguments else None

    def _least(self, state: UnfinishedForm) -> int:
        """Return the least bytes that complete a form. After a closing parenthesis something has to
        follow: at the end of a form none is written."""
        total = sum(
            self._more(part, level)
            for level, part in enumerate(state.parts)
            if not part.is_closable()
        )
        if state.has_just_closed and not total:
            return min(self._more(part, level) for level, part in enumerate(state.parts))
        return min(NEVER, total)

    def _more(self, part: OpenPart, level: int) -> int:
        """Return the least bytes of one or more parts after which it may end."""
        costs, bound = self.costs, part.bound
        if part.place == PartKind.ROOT:
            can_refuse = self.rules.may_refuse
            refusal = own_length(UNKNOWN) if can_refuse else NEVER
            return NEVER if part.filled else min(refusal, costs.body(level, bound))
        if part.place == PartKind.LAMBDA:
            return costs.body(level, bound)
        longer = [kinds for kinds in part.signatures if len(kinds) > part.filled]
        if part.place == PartKind.LEAF:
            return min(
                (
                    min(NEVER, sum(costs.leaf(kind, bound) for kind in kinds[part.filled :]))
                    for kinds in longer
                ),
                default=NEVER,
            )
        needs_nested = not part.has_nested
        return min(
            (costs.fill(kinds, part.filled, needs_nested, level, bound) for kinds in longer),
            default=NEVER,
        )


def _spellings(term: Form) -> tuple[str, ...]:
    """Return the atoms that write or begin a term in its different places."""
    if isinstance(term, Lambda):
        return spell(term)
    if isinstance(term, Application):
        return (*spell(term), spell(Application(term.predicate, (UNKNOWN,)))[0])
    return (INSIDE + spell(term)[0].removeprefix('"'), *spell(term))
