"""Texts that a parser should not understand."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from parser_service.analysis.probe_texts import PAPER_PROBES, ProbeKind, make_probes

utterances = st.lists(
    st.lists(st.sampled_from(["bring", "me", "the", "tea", "go", "to", "hall"]), max_size=8).map(
        " ".join
    ),
    max_size=12,
)


@given(utterances, st.integers(0, 6), st.integers())
def test_probes_are_made_of_utterances_and_are_never_one_of_them(texts, count, seed):
    probes = make_probes(texts, count, seed)
    assert probes == make_probes(texts, count, seed)
    of_paper = [probe for probe in probes if probe.kind is ProbeKind.PAPER]
    assert of_paper == (list(PAPER_PROBES) if "bring" in " ".join(texts).split() else [])
    for probe in probes[len(of_paper) :]:
        if probe.base is None:
            assert probe.expects_unknown
            continue
        words = texts[probe.base].split()
        assert probe.text not in texts
        if probe.kind is ProbeKind.SHUFFLED:
            assert sorted(probe.text.split()) == sorted(words)
        else:
            kept = probe.text.split()
            assert kept == words[: len(kept)]
            assert 1 <= len(kept) <= len(words) // 2
    for kind in set(ProbeKind) - {ProbeKind.PAPER}:
        assert sum(probe.kind is kind for probe in probes) <= count


def test_a_world_that_brings_nothing_is_not_asked_the_texts_of_the_paper():
    texts = [f"water the tomatoes in bed {number}" for number in range(9)]
    assert ProbeKind.PAPER not in {probe.kind for probe in make_probes(texts, 5)}


def test_there_are_probes_of_every_kind():
    texts = [f"bring me item{number} from the hall" for number in range(30)]
    kinds = [probe.kind for probe in make_probes(texts, 5)]
    assert {kind: kinds.count(kind) for kind in ProbeKind} == {
        "paper": 6,
        "empty": 5,
        "shuffled": 5,
        "truncated": 5,
        "unrelated": 5,
    }
