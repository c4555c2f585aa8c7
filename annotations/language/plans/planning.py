"""Make the plan of a form with entities."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain, count

from annotations.language.forms import (
    ANTECEDENTS,
    CONJUNCTION,
    KIND_CLASS,
    NOUN,
    PERSON,
    PERSON_CLASS,
    PERSON_PREDICATES,
    PLACE_CLASSES,
    SEQUENCE,
    THING,
    THINGS,
    UNKNOWN,
    Application,
    Constant,
    Form,
    Lambda,
    Reference,
    Unknown,
    Variable,
    children,
    described_kind,
    kind_of_class,
    walk,
)
from annotations.language.grounding import NOT_UNDERSTOOD, Slot, named_entities, question_for
from annotations.language.plans.descriptions import (
    Describer,
    is_description,
    open_lambdas,
    superlative_without_set,
)
from annotations.language.plans.lookup import Lookup
from annotations.language.plans.plan import (
    ASK,
    ActionName,
    Described,
    Named,
    Number,
    OpenArgument,
    OpenValue,
    Plan,
    PlanProblem,
    Referred,
    Step,
    StepResult,
    Trouble,
    Value,
    Words,
)
from annotations.language.plans.rows import OPERATOR_WORD
from annotations.language.plans.unresolved import COMMAND, Gaps, said_words
from annotations.language.texts import ARGUMENT_NAMES, NEEDED_ARGUMENTS, definite
from annotations.language.world import (
    ArgumentKind,
    Ontology,
    Predicate,
    PredicateKind,
    argument_kind,
    ask_for,
    declared_or_inferred,
    gloss,
)

MOST_STEPS = 50
_PLACE_ARGUMENTS = frozenset(
    ("destination", "source", "where")
)  # what they describe is no antecedent
_KINDS = {"thing": THING, "person": PERSON}  # of what answers a question for an argument


def make_plan(
    form: Form,
    ontology: Ontology,
    predicates: Mapping[str, Predicate] | None = None,
    action_names: Mapping[str, ActionName] | None = None,
    slots: Sequence[Slot] = (),
    lookup: Lookup | None = None,
    utterance: str = "",
) -> Plan:
    """Return the steps that a form asks for.

    Args:
        form: a logical form with entities. Class tokens and UNKNOWN become questions to the operator.
        ontology: says which texts are entities.
        predicates: which predicates are actions, and how to say them.
        action_names: predicate, or ``ask_operator`` → what the robot calls it and its arguments.
        slots: the slots that were asked about; an entity that is only likely is named as a problem, and for
            what is open the plan asks as ``question_for`` does.
        lookup: of ontology and predicates, to be shared by many plans; made here by default.
        utterance: what was said, to tell where the words stand that name nothing.
    """
    known = declared_or_inferred(predicates or {}, form)
    lookup = lookup or Lookup(ontology, predicates or {})
    planner = _Planner(lookup, known, predicates or {}, action_names or {}, form, utterance, slots)
    planner.problems += _doubts_about(slots)
    planner.add(form)
    unresolved = tuple(planner.gaps.unresolved(planner.steps))
    return Plan(tuple(planner.steps), tuple(planner.problems), unresolved)


def _doubts_about(slots: Sequence[Slot]) -> tuple[PlanProblem, ...]:
    """Return a problem for each slot with an entity that is only likely; they come before those of the steps."""
    doubts = []
    for slot in slots:
        if slot.value is None and slot.likely is not None:
            message = f"It is not certain that the {slot.entity_class} is “{slot.likely}”."
            offered = (*slot.candidates, *(slot.phrases if slot.is_choice else ()))
            asked = " or ".join(f"“{each}”" for each in offered or (slot.likely,))
            hint = f"ask whether it is {asked}"
            doubts.append(PlanProblem(Trouble.AMBIGUOUS, 0, message, hint))
    return tuple(dict.fromkeys(doubts))


def _open_slots(form: Form, slots: Sequence[Slot]) -> dict[tuple[Form, str], list[Slot]]:
    """Return what stands in the form for an open slot, and the predicate that takes it → its slots, in order."""
    found: defaultdict[tuple[Form, str], list[Slot]] = defaultdict(list)
    for slot in slots:
        if slot.value is None and slot.path:
            part, parent = form, form
            for place in slot.path:
                part, parent = children(part)[place], part
            if isinstance(parent, Application):
                found[part, str(parent.predicate)].append(slot)
    return found


@dataclass(frozen=True, slots=True)
class _ActionScope:
    """The descriptions that hold for the variables of a λ around actions, and their ids."""

    conjuncts: tuple[Form, ...] = ()
    described: dict[int, Described] = field(default_factory=dict)


@dataclass
class _Acting:
    """The action of a step with the descriptions around it, and which of its slots were asked for.

    ``form`` is a λ whose last body is the action, with a variable in place of what describes it.
    """

    action: str
    form: Lambda
    asked: Counter[tuple[Constant, str, int]] = field(default_factory=Counter)

    @classmethod
    def of(
        cls, form: Application, conjuncts: tuple[Form, ...], predicates: Mapping[str, Predicate]
    ) -> _Acting:
        about = tuple(each for each in form.arguments if is_description(each, predicates))
        if about:  # ``(follow (person $1) (at $1 …))``
            others = (each for each in form.arguments if each not in about)
            form = replace(form, arguments=(children(about[0])[0], *others))
        return cls(str(form.predicate), Lambda(1, "e", (*conjuncts, *about, form)))

    def constants(self) -> Iterator[tuple[Constant, str, int, tuple[int, ...]]]:
        """Yield the texts with the predicates and the places that take them, and the ways to them."""
        waiting: list[tuple[Form, tuple[int, ...]]] = [(self.form, ())]
        while waiting:
            form, path = waiting.pop(0)
            for place, child in enumerate(children(form)):
                waiting.append((child, (*path, place)))
                if isinstance(form, Application) and isinstance(child, Constant):
                    yield child, str(form.predicate), place, (*path, place)

    def next_slot(self, token: Constant, predicate: str, place: int) -> tuple[int, ...]:
        """Return the way to a class token; to the next one where several are taken alike."""
        key = (token, predicate, place)
        paths = [path for *each, path in self.constants() if tuple(each) == key]
        self.asked[key] += 1
        return paths[min(self.asked[key], len(paths)) - 1]

    def place_of(self, place: int) -> tuple[int, ...]:
        """Return the way to an argument of the action."""
        return len(self.form.bodies) - 1, place

    def form_for(self, path: tuple[int, ...]) -> Form:
        """Return the form with UNKNOWN for the arguments that are missing up to that at ``path``."""
        *about, action = self.form.bodies
        assert isinstance(action, Application)
        missing = path[1] + 1 - len(action.arguments) if path[0] == len(about) else 0
        arguments = (*action.arguments, *[UNKNOWN] * missing)
        return replace(self.form, bodies=(*about, replace(action, arguments=arguments)))


@dataclass
class _Planner:
    """Collects steps and problems."""

    lookup: Lookup
    predicates: Mapping[str, Predicate]
    declared: Mapping[str, Predicate]  # those that the form does not tell by itself
    names: Mapping[str, ActionName]
    form: Form
    utterance: str
    slots: Sequence[Slot]
    steps: list[Step] = field(default_factory=list)
    problems: list[PlanProblem] = field(default_factory=list)
    describer: Describer = field(init=False)
    acting: _Acting = field(default_factory=lambda: _Acting("", Lambda(1, "e", ())))
    waiting: list[tuple[Trouble, str, str]] = field(default_factory=list)
    last: dict[str, Value] = field(default_factory=dict)  # person or thing → the one described last
    gaps: Gaps = field(default_factory=Gaps)
    open_slots: dict[tuple[Form, str], list[Slot]] = field(init=False)

    def __post_init__(self) -> None:
        self.open_slots = _open_slots(self.form, self.slots)
        self.describer = Describer(
            self.predicates, self.text_value, self._referred, self.lookup.classes
        )

    def add(self, form: Form) -> None:
        """Add the steps of a whole form."""
        if isinstance(form, Unknown):
            self.report(
                Trouble.NOT_UNDERSTOOD,
                "the command has no form that the robot knows",
                "ask the operator to say it another way",
                step=0,
            )
            self._ask_what_to_do()
            return
        self._add(form, _ActionScope())
        if not any(step.predicate != ASK for step in self.steps):
            message = "the form says nothing to do"
            self.report(Trouble.NO_ACTION, message, "put an action around it, such as find", step=0)
            if not self.steps:
                self._ask_what_to_do()

    def _ask_what_to_do(self) -> None:
        words = (self.utterance,) if self.utterance.strip() else ()
        self.ask(OpenArgument(COMMAND, NOT_UNDERSTOOD, words=said_words(words, self.utterance)))

    def _add(self, form: Form, scope: _ActionScope, whole: str = "") -> None:
        """Add the steps of a form, or of a part of what the predicate ``whole`` puts together."""
        if isinstance(form, Lambda):
            bodies = tuple(open_lambdas(form))
            about = tuple(each for each in bodies if is_description(each, self.predicates))
            inner = replace(scope, conjuncts=(*scope.conjuncts, *about))
            actions = [body for body in bodies if body not in about]
            for body in actions:
                self._add(body, inner)
            if whole and not actions:
                self._miss_action(form, whole)
        elif isinstance(form, Application):
            declared = self.predicates.get(str(form.predicate))
            is_sequence = declared is not None and declared.kind is PredicateKind.SEQUENCE
            if is_sequence or form.predicate in (CONJUNCTION, SEQUENCE):
                for argument in form.arguments:
                    self._add(argument, scope, str(form.predicate))
                if not form.arguments:
                    self._miss_action(form, whole)
            else:
                self.step(form, scope)
        else:
            self._miss_action(form, whole)

    def _miss_action(self, form: Form, whole: str) -> None:
        """Ask about a part of the command that says nothing to do."""
        message = "a part of the command has no form that the robot knows"
        self.report(
            Trouble.NOT_UNDERSTOOD, message, "ask the operator to say it another way", step=0
        )
        gap = self._gap(COMMAND, NOT_UNDERSTOOD, self._slot_of(form, whole))
        self.ask(replace(gap, argument=COMMAND))

    def step(self, form: Application, scope: _ActionScope) -> int:
        """Add the step of one action, after the steps whose results it needs; return its number."""
        if len(self.steps) >= MOST_STEPS:
            message = f"the plan has more than {MOST_STEPS} steps"
            self.report(Trouble.TOO_LONG, message, "give shorter commands", step=0)
            return MOST_STEPS
        action = str(form.predicate)
        before, self.waiting = self.waiting, []
        spoken = Lambda(1, "e", (*scope.conjuncts, form)) if scope.conjuncts else form
        named = self.lookup.class_of_text
        text = gloss(spoken, self.predicates, self.lookup.classes, named)
        arguments: dict[str, Value] = {}
        said: list[tuple[Form, Value]] = []
        around, self.acting = self.acting, _Acting.of(form, scope.conjuncts, self.predicates)
        gathered = self._gather(form, scope)
        for place, argument in enumerate(gathered):
            value = self._value(argument, action, place, scope)
            entity_class = value.entity_class if isinstance(value, Named) else ""
            declared = self.declared.get(action)
            name = argument_name(action, place, argument, entity_class, declared)
            value = self._asked(value, name, place, argument)
            if name not in _PLACE_ARGUMENTS:
                said.append((argument, value))
            arguments[free_name(name, arguments)] = value
        for name in NEEDED_ARGUMENTS.get(action, ()):
            if name not in arguments:
                place = max(place_of_argument(action, name), len(gathered))
                arguments[name] = self._asked(OpenValue(""), name, place)
        # A reference of this very action stands for something before it.
        for argument, value in said:
            self._remember(argument, value)
        # A source says among what something is the largest, as in ``from the table``.
        for value in arguments.values():
            superlative = superlative_without_set(value) if isinstance(value, Described) else ""
            if superlative and "source" not in arguments:
                message = f"“{superlative}” does not say among which things"
                hint = "name a category or a place"
                self.waiting.append((Trouble.SUPERLATIVE_WITHOUT_SET, message, hint))
                assert isinstance(value, Described)
                self.gaps.vague[value.id] = OpenArgument("", _sentence(message))
        number = self._append(action, arguments, text)
        for trouble, message, hint in self.waiting:
            self.report(trouble, message, hint, step=number)
        self.waiting, self.acting = before, around
        return number

    def ask(self, gap: OpenArgument, noun: str = "") -> StepResult:
        """Add a question to the operator; return its answer. ``noun`` says what is expected, if that is no word."""
        arguments: dict[str, Value] = {
            "question": Words(gap.question, is_of_robot=True),
            "expects": Words(gap.entity_class or gap.argument, said=noun),
        }
        number = self._append(ASK, arguments, f"ask: {gap.question}", gives_result=True)
        self.gaps.asked[number] = replace(gap, asked_in=number)
        return StepResult(number)

    def report(self, trouble: Trouble, message: str, hint: str, step: int) -> None:
        problem = PlanProblem(trouble, step, _sentence(message), hint)
        if problem not in self.problems:
            self.problems.append(problem)

    def text_value(self, constant: Constant, predicate: str, place: int) -> Value:
        """Return the value of a constant; an open one is asked for, an unknown one reported."""
        slot = self._slot_of(constant, predicate)
        if constant.token_class:
            noun = self.lookup.classes.noun(constant.token_class)
            what = f"the {noun} is open"
            self.waiting.append((Trouble.OPEN_SLOT, what, "name one, or answer the question"))
            path = self.acting.next_slot(constant, predicate, place)
            question = "" if slot else self._question(constant.token_class, path)
            return self.ask(self._gap("", question, slot, constant.token_class), noun)
        text = str(constant.value)
        value, is_missing = self.lookup.value(text, predicate, place)
        if is_missing and (places := self.lookup.places_called(text)):
            message = f"“{text}” can be several places"
            *others, last = (definite(each.text) for each in places)
            choices = f"{', '.join(others)} or {last}"
            self.waiting.append((Trouble.AMBIGUOUS, message, "name one, or answer the question"))
            question, entity_class = f"Which one do you mean: {choices}?", places[0].entity_class
            return self.ask(self._gap("", question, None, entity_class, (text,)))
        if is_missing:
            message = f"the ontology has no “{text}”"
            hint = "add it to the ontology, or name something that is there"
            self.waiting.append((Trouble.UNKNOWN_ENTITY, message, hint))
            return Words(text, doubt=self._gap("", _sentence(message), None, "", (text,)))
        if slot is not None and isinstance(value, Named | Words):
            return replace(value, doubt=self._gap("", "", slot, constant.token_class))
        return value

    def _gather(self, form: Application, scope: _ActionScope) -> tuple[Form, ...]:
        """Put the variable in place of the descriptions in ``(follow (person $1) (at $1 …))``."""
        about = [each for each in form.arguments if is_description(each, self.predicates)]
        if not about:
            return form.arguments
        variable = children(about[0])[0]
        assert isinstance(variable, Variable)
        conjuncts = (*scope.conjuncts, *about)
        scope.described[variable.index] = self.describer.of_variable(variable.index, conjuncts, {})
        return (variable, *(each for each in form.arguments if each not in about))

    def _value(self, form: Form, action: str, place: int, scope: _ActionScope) -> Value:
        if isinstance(form, Constant):
            is_number = isinstance(form.value, int)
            return Number(int(form.value)) if is_number else self.text_value(form, action, place)
        if isinstance(form, Lambda):
            return self.describer.of_lambda(form)
        if isinstance(form, Reference):
            return self._referred(form.word)
        if isinstance(form, Variable):
            described = scope.described.get(form.index)
            if described is None:
                described = self.describer.of_variable(form.index, scope.conjuncts, {})
                if not described.conditions and described.of is None:
                    return OpenValue("")
                scope.described[form.index] = described
            return described
        if isinstance(form, Application):
            number = self.step(form, scope)
            self.steps[number - 1] = replace(self.steps[number - 1], gives_result=True)
            return StepResult(number)
        return OpenValue("")

    def _remember(self, form: Form, value: Value) -> None:
        """Keep what a later ``it`` or ``them`` can stand for: what is inside a description, then what it describes."""
        if isinstance(value, Referred):
            self._remember(UNKNOWN, value.value)
            return
        if isinstance(value, Described):
            if value.of is not None:
                self._remember(form, value.of)
                return
            for condition in value.conditions:
                for each in condition.values:
                    self._remember(UNKNOWN, each)
        kind = _kind_of(form, value)
        if isinstance(value, StepResult) and value.step in self.gaps.asked:
            kind = kind or _KINDS.get(self.gaps.asked[value.step].argument, "")
        if kind:
            self.last.pop(kind, None)
            self.last[kind] = value

    def _referred(self, word: str) -> Value:
        """Return what a reference stands for; the operator is asked where nothing was described before."""
        kinds = ANTECEDENTS[word]
        # The order in which the kinds were described last is that of ``last``.
        recent = [kind for kind in reversed(self.last) if kind in kinds]
        kind = PERSON if PERSON in recent else next(iter(recent), "")
        value = self.last.get(kind)
        if isinstance(value, Named | Described):
            return Referred(word, value)
        if value is not None:
            return value
        message = f"nothing before “{word}” says what it stands for"
        self.waiting.append((Trouble.NO_ANTECEDENT, message, "name it, or answer the question"))
        return self.ask(self._gap(kinds[0], f"What do you mean by “{word}”?", None, "", (word,)))

    def _slot_of(self, form: Form, predicate: str) -> Slot | None:
        """Return the open slot that stands in the form; None where the plan is made without slots."""
        slots = self.open_slots.get((form, predicate), [])
        return slots.pop(0) if len(slots) > 1 else next(iter(slots), None)

    def _gap(
        self,
        argument: str,
        question: str,
        slot: Slot | None,
        entity_class: str = "",
        words: Sequence[str] = (),
    ) -> OpenArgument:
        """Return what is open, with the question that a dialogue asks for its slot; ``question`` is the one without."""
        if slot is None:
            said = said_words(words, self.utterance)
            return OpenArgument(argument, question, entity_class, said)
        named, classes = named_entities(self.slots), self.lookup.classes
        question = question_for(slot, self.form, self.predicates, classes=classes, named=named)
        said = said_words(slot.phrases, self.utterance)
        return OpenArgument(argument, question, slot.entity_class, said, slot.likely)

    def _asked(self, value: Value, name: str, place: int, argument: Form | None = None) -> Value:
        """Return the answer of the operator in place of an argument that is open."""
        if not isinstance(value, OpenValue):
            return value
        message = f"nothing says the {name.replace('_', ' ')} of “{self.acting.action}”"
        self.waiting.append((Trouble.MISSING_ARGUMENT, message, "name it, or answer the question"))
        slot = None if argument is None else self._slot_of(argument, self.acting.action)
        question = "" if slot else self._question("", self.acting.place_of(place))
        return self.ask(self._gap(name, question, slot))

    def _question(self, entity_class: str, path: tuple[int, ...]) -> str:
        """Return the question for what is open at ``path`` of the action."""
        acting, classes = self.acting, self.lookup.classes
        named = {}
        for constant, predicate, place, _ in acting.constants():
            value, _ = self.lookup.value(str(constant.value), predicate, place)
            if isinstance(value, Named):
                named[str(constant.value)] = value.entity_class
        return ask_for(acting.form_for(path), path, entity_class, self.predicates, classes, named)

    def _append(
        self, predicate: str, arguments: Mapping[str, Value], text: str, gives_result: bool = False
    ) -> int:
        names = self.names.get(predicate, ActionName(predicate))
        renamed = tuple(
            (names.arguments.get(name, names.arguments.get(numbered_name(place), name)), each)
            for place, (name, each) in enumerate(arguments.items())
        )
        number = len(self.steps) + 1
        self.steps.append(Step(number, names.name, predicate, renamed, text, gives_result))
        return number


def _sentence(message: str) -> str:
    return f"{message[:1].upper()}{message[1:]}."


def _kind_of(form: Form, value: Value) -> str:
    """Return what a value is for a reference; empty for a place, and for what is a reference itself."""
    if isinstance(value, Named):
        return kind_of_class(value.entity_class)
    if not isinstance(value, Described):
        return described_kind(form)
    if any(each.predicate in PERSON_PREDICATES for each in value.conditions):
        return PERSON
    of_kind = [
        each
        for condition in value.conditions
        for each in condition.values
        if condition.predicate == NOUN and isinstance(each, Named)
    ]
    classes = {each.entity_class for each in of_kind}
    if classes & PLACE_CLASSES:
        return ""
    return THINGS if KIND_CLASS in classes else THING


def place_of_argument(action: str, name: str) -> int:
    """Return the place of the argument that plans call ``name``; 0 where the action has none of that name."""
    names = ARGUMENT_NAMES.get(action, ())
    known = (each == name if isinstance(each, str) else name in each.values() for each in names)
    return next((place for place, is_it in enumerate(known) if is_it), 0)


def argument_names(action: str) -> tuple[str, ...]:
    """Return what plans call the arguments of an action; empty for one that is not known."""
    names = ARGUMENT_NAMES.get(action, ())
    lists = ([each] if isinstance(each, str) else each.values() for each in names)
    return tuple(dict.fromkeys(name for each in lists for name in each))


def argument_name(
    action: str,
    place: int,
    argument: Form,
    entity_class: str = "",
    declared: Predicate | None = None,
) -> str:
    """Return the name of an argument: ``destination`` for the second one of ``guide``.

    ``entity_class`` is that of a text that names an entity. An argument that has no word of its own is called by the
    kind that the action is ``declared`` to take: by its class, such as ``plant``, else ``thing``, ``text`` or
    ``number``; else ``argument_1``, ``argument_2``, ….
    """
    names = ARGUMENT_NAMES.get(action, ())
    if place >= len(names):
        return _name_by_kind(place, declared)
    name = names[place]
    if isinstance(name, str):
        return name
    kind = argument_kind(argument)
    if kind in PLACE_CLASSES or entity_class in PLACE_CLASSES:
        said = "place"
    elif kind == ArgumentKind.NUMBER:
        said = "number"
    elif isinstance(argument, Unknown):
        said = "unknown"
    elif isinstance(argument, Lambda):
        predicates = {node.predicate for node in walk(argument) if isinstance(node, Application)}
        said = "person" if predicates & PERSON_PREDICATES else "thing"
    else:
        said = "name" if PERSON_CLASS in (kind, entity_class) else "text"
    return name.get(said) or name.get("") or numbered_name(place)


def _name_by_kind(place: int, declared: Predicate | None) -> str:
    signatures = declared.signatures if declared else ()
    kinds = {each.arguments[place] for each in signatures if each.arguments[place:]}
    kinds -= {ArgumentKind.ANY, ArgumentKind.UNKNOWN, ArgumentKind.VARIABLE}
    if len(kinds) > 1:  # what is named may be described as well
        kinds.discard(ArgumentKind.LAMBDA)
    kind = kinds.pop() if len(kinds) == 1 else ArgumentKind.FORM
    if kind in (ArgumentKind.FORM, OPERATOR_WORD):
        return numbered_name(place)
    return THING if kind == ArgumentKind.LAMBDA else str(kind)


def numbered_name(place: int) -> str:
    """Return what an argument is called that has no other name."""
    return f"argument_{place + 1}"


def free_name(name: str, taken: Collection[str]) -> str:
    """Return a name that is not taken, with a number behind it if need be."""
    names = chain((name,), (f"{name}_{number}" for number in count(2)))
    return next(each for each in names if each not in taken)


def arguments_of(use: Application, declared: Predicate) -> tuple[str, ...]:
    """Return what plans call the arguments of an action that is used like this, in order."""
    names: list[str] = []
    for place, argument in enumerate(use.arguments):
        name = argument_name(declared.name, place, argument, declared=declared)
        names.append(free_name(name, names))
    needed = NEEDED_ARGUMENTS.get(declared.name, ())  # the operator is asked for them
    return (*names, *(each for each in needed if each not in names))
