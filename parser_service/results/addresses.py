"""Where the answers behind a number of a comparison are listed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from django.urls import reverse
from django.utils.http import urlencode

from annotations.models import World
from parser_service.models import TrainingRun
from parser_service.results.measures import Measure

# Filters that say something of answers rather than of examples.
OF_ANSWERS = {
    *("outcome", "category", "category_by", "answer", "label", "answer_head", "slot", "slice"),
}
MOST_REVIEWED = 6  # runs beside each other on the review page
Parameters = Mapping[str, str]


@dataclass(frozen=True, slots=True)
class Addresses:
    """``query`` are the filters of the comparison, without ``part``; ``measure`` says which answers are right.

    A filter of answers means those of the first run, so that the list of another run's answers would show others:
    there such a number leads to the first run's answers where the other run is right or wrong.
    """

    world: World
    runs: tuple[TrainingRun, ...]
    part: str
    query: Parameters = field(default_factory=dict)
    measure: Measure = Measure.EXACT

    def of_base(self, chosen: Parameters) -> str:
        """Return the address of all answers of the first run in a slice; empty where no list shows just these."""
        return self._list(0, chosen)

    def of_run(self, run: int, chosen: Parameters, only_wrong: bool = False) -> str:
        """Return the address of a run's answers in a slice, the wrong ones or all; empty where no list shows
        just these."""
        outcome = self.measure.outcomes[1] if only_wrong else ""
        if run == 0 or not OF_ANSWERS & {*self.query, *chosen}:
            return self._list(run, chosen, {"outcome": outcome} if outcome else {})
        versus = {"versus": str(self.runs[run].pk), "versus_outcome": outcome}
        return self._list(0, chosen, versus if outcome else {})

    def of_win(self, winner: int, loser: int) -> str:
        """Return the address of the answers where one run is right and another is wrong; empty where no list shows
        just these."""
        right, wrong = self.measure.outcomes
        if not OF_ANSWERS & set(self.query):
            first, second, outcomes = loser, winner, (wrong, right)
        elif 0 in (winner, loser) and "outcome" not in self.query:
            first, second = 0, winner or loser
            outcomes = (right, wrong) if winner == 0 else (wrong, right)
        else:
            return ""
        versus = {"versus": str(self.runs[second].pk), "versus_outcome": outcomes[1]}
        return self._list(first, {}, {"outcome": outcomes[0], **versus}, beside=(second,))

    def of_confusion(self, run: int, label: str, answer: str) -> str:
        """Return the address of a run's answers with one head predicate for labels with another; empty where
        the list would show others."""
        if run and OF_ANSWERS & set(self.query):
            return ""
        confused = {"head": label, "answer_head": answer}
        return self._list(run, {}, confused) if label != answer else self._list(run, confused)

    def compare(self, chosen: Parameters) -> str:
        """Return the address of the same comparison on a smaller slice."""
        keys = [("run", str(run.pk)) for run in self.runs]
        given = {"part": self.part, **(join(self.query, chosen) or chosen)}
        if self.measure != Measure.EXACT:
            given["measure"] = self.measure
        path = reverse("compare", kwargs={"world": self.world.name})
        return f"{path}?{urlencode([*keys, *given.items()])}"

    def _list(
        self,
        run: int,
        chosen: Parameters,
        asked: Parameters | None = None,
        beside: Sequence[int] | None = None,
    ) -> str:
        """Return the address of a run's answers: the review page, with other runs ``beside`` it (all of them unless
        given), where something is ``asked`` of the answers, else the list."""
        joined = join(self.query, chosen)
        joined = None if joined is None else join(joined, asked or {})
        if joined is None:
            return ""
        given = urlencode({"part": self.part, **joined})
        of_world = {"world": self.world.name}
        if not asked:
            return f"{reverse('predictions', kwargs={**of_world, 'pk': self.runs[run].pk})}?{given}"
        others = range(len(self.runs)) if beside is None else beside
        shown = [run, *(other for other in others if other != run)][:MOST_REVIEWED]
        runs = urlencode([("run", self.runs[each].pk) for each in shown])
        return f"{reverse('review', kwargs=of_world)}?{runs}&{given}"


def join(first: Parameters, second: Parameters) -> dict[str, str] | None:
    """Return filters that choose what both choose; None where one filter would need two values."""
    joined = dict(first)
    for name, value in second.items():
        other = joined.setdefault(name, value)
        if other == value:
            continue
        if name.startswith("min_"):
            joined[name] = str(max(int(other), int(value)))
        elif name.startswith("max_"):
            joined[name] = str(min(int(other), int(value)))
        else:
            return None
    return joined
