"""Hypothesis strategies for commands of several actions, with the entities of ``sample_ontology.HOME``."""

from __future__ import annotations

from hypothesis import strategies as st

PLACES = ("attic", "tea room", "stool")
THINGS = ("tea", "bread knife", "knife")
NAMES = ("Ada", "Bo")


@st.composite
def things(draw: st.DrawFn) -> str:
    at = draw(st.sampled_from(("", *(f' (at $1 "{place}")' for place in PLACES))))
    return f'(λ$1:e (is_a $1 "{draw(st.sampled_from(THINGS))}"){at})'


@st.composite
def people(draw: st.DrawFn) -> str:
    at = draw(st.sampled_from(("", *(f' (at $1 "{place}")' for place in PLACES))))
    named = draw(st.sampled_from(("", *(f' (name $1 "{name}")' for name in NAMES))))
    return f"(λ$1:e (person $1){named}{at})"


@st.composite
def actions(draw: st.DrawFn) -> str:
    """One action; ``it`` and ``them`` may stand for nothing."""
    thing = draw(st.one_of(things(), st.just("it")))
    person = draw(st.one_of(people(), st.just("them")))
    place = f'"{draw(st.sampled_from(PLACES))}"'
    patterns = (
        *("(go {place})", "(find {thing})", "(find {person})", "(take {thing})", "(bring {thing})"),
        *(
            "(bring {thing} {person})",
            "(put {thing} {place})",
            "(open {thing})",
            "(greet {person})",
        ),
        *("(follow {person})", "(follow {person} {place})", "(guide {person} {place})"),
        *('(say "a joke")', '(say "a joke" {person})', "(say (count {things}))", "(bring UNKNOWN)"),
    )
    pattern = draw(st.sampled_from(patterns))
    return pattern.format(thing=thing, person=person, place=place, things=draw(things()))


@st.composite
def commands(draw: st.DrawFn, most: int = 4) -> str:
    """A command of up to ``most`` actions."""
    parts = draw(st.lists(actions(), min_size=1, max_size=most))
    return parts[0] if len(parts) == 1 else f"(sequence {' '.join(parts)})"
