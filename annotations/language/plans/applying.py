"""Turn the plan of a form into the primitives of a team's robot."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from annotations.language.plans.book import RecipeBook
from annotations.language.plans.habitual_places import UsualPlaces
from annotations.language.plans.plan import (
    ASK,
    Described,
    OpenValue,
    Operator,
    Plan,
    Referred,
    Step,
    StepResult,
    TaskValue,
    Value,
    Words,
)
from annotations.language.plans.planning import numbered_name
from annotations.language.plans.rows import (
    ActionPattern,
    Argument,
    Call,
    EffectKind,
    Literal,
    Name,
    Parameter,
    Part,
    Primitive,
    PrimitiveParameter,
    Recipe,
)
from annotations.language.plans.situation import HERE, Place, Situation, Somewhere, with_texts
from annotations.language.plans.speaking import step_texts
from annotations.language.plans.task_plan import RecipeTrouble, TaskPlan, TaskProblem
from annotations.language.plans.values import kinds_of, renumbered, with_results

_CURRENT = Words("current")


def apply_recipes(
    plan: Plan,
    book: RecipeBook,
    usual: UsualPlaces | None = None,
    sent_to: TaskValue | None = None,
) -> TaskPlan:
    """Return the primitives that do what a plan says, in order.

    The most specific recipe that fits is used for each action. Questions to the operator come first, while
    the robot is with them. References stand for what they refer to. A primitive is left out if all that it
    does holds already: the robot is there, has found it here, or holds it. An action without a recipe is done by
    the primitive that is proposed for it, else stays as it is; both have a problem.

    Args:
        plan: the plan of a form, with the argument names of the language (no names of a robot).
        book: primitives and recipes; rows with errors are not used.
        usual: where the things of a category are, if the command does not say where to look; without it
            they are where the robot is.
        sent_to: where the command before has sent the robot (``TaskPlan.sends_to``): what has no place is
            looked for there.
    """
    return _Applier(plan, book, usual or {}, sent_to).task_plan()


@dataclass(frozen=True, slots=True)
class _Fit:
    """A recipe that fits a step, what its names stand for, and the other steps that it does as well."""

    recipe: Recipe
    values: Mapping[str, Value]
    absorbed: frozenset[int]


class _Applier:
    def __init__(
        self, plan: Plan, book: RecipeBook, usual: UsualPlaces, sent_to: TaskValue | None
    ) -> None:
        self._plan = plan
        self._book = book
        self._steps = {step.number: step for step in plan.steps}
        self._situation = Situation(usual=usual, sent_to=sent_to)
        self._sends_to: TaskValue | None = None
        self._numbers: dict[int, int] = {}  # step with a result → the step of the task plan

    def task_plan(self) -> TaskPlan:
        fits = {step.number: self._best_fit(step) for step in self._plan.steps}
        absorbed = {number for fit in fits.values() if fit for number in fit.absorbed}
        for step in sorted(self._plan.steps, key=lambda step: step.predicate != ASK):
            if step.number not in absorbed:
                self._apply(step, fits[step.number])
        steps = with_texts(self._situation.steps, step_texts(self._situation.steps))
        of_source: dict[int, list[int]] = {}
        for done in steps:
            of_source.setdefault(done.source, []).append(done.number)
        of_plan = (
            TaskProblem.of_plan(each, of_source.get(each.step, [0])[0])
            for each in self._plan.problems
        )
        own = (  # one that is about a step which was left out is about the whole plan
            each if each.step <= len(steps) else replace(each, step=0)
            for each in self._situation.problems
        )
        unresolved = (renumbered(each, of_source, self._numbers) for each in self._plan.unresolved)
        return TaskPlan(steps, (*of_plan, *own), tuple(unresolved), self._sends_to)

    def _best_fit(self, step: Step) -> _Fit | None:
        fits = self._fits(step, self._book)
        return max(fits, key=lambda fit: fit.recipe.pattern.restrictions, default=None)

    def _fits(self, step: Step, book: RecipeBook) -> list[_Fit]:
        recipes = book.recipes_of(step.predicate)
        return [fit for each in recipes if (fit := self._fit(step, each))]

    def _fit(self, step: Step, recipe: Recipe) -> _Fit | None:
        values: dict[str, Value] = {}
        absorbed: set[int] = set()
        if not self._match(step, recipe.pattern, values, absorbed):
            return None
        return _Fit(recipe, values, frozenset(absorbed))

    def _match(
        self, step: Step, pattern: ActionPattern, values: dict[str, Value], absorbed: set[int]
    ) -> bool:
        names = {each.name for each in pattern.parameters}
        arguments = {  # a recipe may number arguments that have names
            name if name in names else numbered_name(place): each
            for place, (name, each) in enumerate(step.arguments)
        }
        if step.predicate != pattern.action or names != arguments.keys():
            return False
        return all(
            self._match_argument(arguments[each.name], each, values, absorbed)
            for each in pattern.parameters
        )

    def _match_argument(
        self, value: Value, parameter: Parameter, values: dict[str, Value], absorbed: set[int]
    ) -> bool:
        if parameter.action is not None:
            if not isinstance(value, StepResult):
                return False
            absorbed.add(value.step)
            return self._match(self._steps[value.step], parameter.action, values, absorbed)
        values[parameter.name] = value
        return not parameter.kind or parameter.kind in kinds_of(value)

    def _apply(self, step: Step, fit: _Fit | None) -> None:
        number = len(self._situation.steps) + 1
        if fit is None:
            message = f"No recipe says how to do “{step.text}”."
            names = ", ".join(name for name, _ in step.arguments)
            hint = f"add a recipe for {step.predicate}({names})"
            self._situation.report(RecipeTrouble.NO_RECIPE, number, message, hint)
            values = {name: self._resolved(value) for name, value in step.arguments}
            primitive = self._proposed(step)
            done = self._situation.add(primitive, values, step.number, is_proposed=True)
            if done is not None and primitive.gives_result:
                self._numbers[step.number] = done.number
            return
        names_of = {name: self._resolved(value) for name, value in fit.values.items()}
        for call in fit.recipe.calls:
            self._do(call, names_of, step)
        self._sends_to = self._situation.sent_to if self._only_moves(fit.recipe) else None

    def _proposed(self, step: Step) -> Primitive:
        """Return what does a step without a recipe, with the parameters that it has arguments for."""
        book = self._book.proposed or RecipeBook()
        calls = [call for fit in self._fits(step, book) for call in fit.recipe.calls]
        proposed = book.primitive(calls[0].primitive) if calls else None
        parameters = tuple(PrimitiveParameter(name) for name, _ in step.arguments)
        return proposed or Primitive(step.action, parameters)

    def _do(self, call: Call, names: dict[str, TaskValue], step: Step) -> None:
        primitive = self._book.primitive(call.primitive)
        assert primitive is not None
        values: dict[str, TaskValue] = {}
        for parameter, argument in zip(primitive.parameters, call.arguments, strict=False):
            values[parameter.name] = self._value(argument, names, primitive, parameter.name)
        done = self._situation.add(primitive, values, step.number)
        self._note_sending(call, primitive)
        if done is not None and primitive.gives_result:
            self._numbers[step.number] = done.number
            if call.result:
                names[call.result] = StepResult(done.number)

    def _only_moves(self, recipe: Recipe) -> bool:
        called = (self._book.primitive(call.primitive) for call in recipe.calls)
        return all(each is not None and each.effect(EffectKind.MOVES) for each in called)

    def _note_sending(self, call: Call, primitive: Primitive) -> None:
        """Remember the place to which the robot has moved, if the command itself names it."""
        moves = primitive.effect(EffectKind.MOVES)
        for parameter, argument in zip(primitive.parameters, call.arguments, strict=False):
            if moves is not None and moves.subject == parameter.name:
                place = self._situation.place
                is_named = isinstance(argument, Name) and argument.part is None
                if is_named and not isinstance(place, Operator | Somewhere):
                    self._situation.sent_to = place

    def _value(
        self,
        argument: Argument,
        names: Mapping[str, TaskValue],
        primitive: Primitive,
        parameter: str,
    ) -> TaskValue:
        if isinstance(argument, Literal):
            return Words(argument.text, is_of_robot=True)
        if not isinstance(argument, Name):
            return Operator()
        value = names.get(argument.name, OpenValue(""))
        if argument.part is Part.OWNER:
            return value.of if isinstance(value, Described) and value.of else value
        if argument.part is Part.ATTRIBUTE:
            return Words(value.attribute if isinstance(value, Described) else "")
        if argument.part is Part.PLACE:
            return self._named(self._situation.place_of(value), primitive, parameter)
        return value

    def _named(self, place: Place, primitive: Primitive, parameter: str) -> TaskValue:
        """Return a place as an argument: nobody has named the one to which somebody leads."""
        moves = primitive.effect(EffectKind.MOVES)
        is_goal = moves is not None and moves.subject == parameter
        if isinstance(place, Operator) and self._situation.is_here(place) and not is_goal:
            return HERE
        if not isinstance(place, Somewhere):
            return place
        if self._situation.is_here(place):
            return HERE
        if is_goal:
            message = "Nobody has said where this place is."
            hint = "do what has to be done there before the robot leaves it"
            number = len(self._situation.steps) + 1
            self._situation.report(RecipeTrouble.UNKNOWN_PLACE, number, message, hint)
        return OpenValue("")

    def _resolved(self, value: Value) -> TaskValue:
        """Return what a value stands for, with results of steps of the task plan.

        The place where the robot is when it hears the command is that of the operator.
        """
        if value == _CURRENT:
            return Operator()
        plain = value.value if isinstance(value, Referred) else value
        for number in self._missing(plain):
            message = f"Nothing gives the result of “{self._steps[number].text}”."
            hint = "use a primitive that learns something in its recipe"
            step = len(self._situation.steps) + 1
            self._situation.report(RecipeTrouble.NO_RESULT, step, message, hint)
        return with_results(plain, self._numbers)

    def _missing(self, value: Value) -> Iterator[int]:
        if isinstance(value, StepResult) and value.step not in self._numbers:
            yield value.step
        if isinstance(value, Described):
            for condition in value.conditions:
                for each in condition.values:
                    yield from self._missing(each)
