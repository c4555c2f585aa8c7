"""Trainings that would last longer than they may."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from parser_service.neural.ranker.fitting import Fitting
from parser_service.neural.ranker.form_ranker import FormRanker
from parser_service.neural.ranker.steps import cut, plan
from parser_service.neural.training import LEAST_TIMED, Clock
from parser_service.parsers.hyperparameters.ranker import RankerConfig
from parser_service.parsers.interface import Cancelled
from tests.parser_service.neural.conftest import Recorder
from tests.parser_service.neural.ranker.sample_domain import utterances

LATE = 1e-9  # minutes, over before they begin


@given(st.lists(st.integers(1, 3000), min_size=1, max_size=2), st.integers(1, 500), st.data())
def test_what_is_left_of_a_plan_shrinks_and_what_is_over_stays(pairs, steps, data):
    spans = plan([1 / len(pairs)] * len(pairs), pairs, RankerConfig(steps=steps, batch_size=8))
    step = data.draw(st.integers(0, spans[-1].end - 1))
    most = data.draw(st.floats(1, spans[-1].end - step))
    fewer = cut(spans, step, most)
    assert fewer[0].first == 0
    assert [each.first for each in fewer[1:]] == [each.end for each in fewer[:-1]]
    assert {each.total for each in fewer} == {fewer[-1].end}
    for before, after in zip(spans, fewer, strict=True):
        assert after.end == before.end if before.end <= step else after.end > step
        assert after.end <= before.end
    assert fewer[-1].end - step <= max(most, len(pairs))


def timed(clock):
    for _ in range(LEAST_TIMED):
        with clock.step():
            sum(range(10_000))
    return clock


def test_without_a_bound_there_is_time_for_all():
    assert timed(Clock()).steps_left(1e9) == float("inf")


def test_what_was_spent_before_a_stop_and_what_is_reserved_count():
    clock = timed(Clock(1))
    clock.before = 40.0
    assert 0 < clock.steps_left(reserved=10.0) <= 10 / clock.a_step
    assert clock.steps_left(reserved=20.0) == 1


def test_threads_share_the_seconds(monkeypatch):
    monkeypatch.setattr("time.process_time", iter([100.0, 160.0]).__next__)
    assert Clock(1, threads=2).spent == 30.0


@pytest.mark.parametrize("steps", [40, 200])
def test_a_training_that_would_last_too_long_takes_fewer_steps_and_says_so(
    config, pairs, tmp_path, steps
):
    observe = Recorder(tmp_path)
    parser = FormRanker(replace(config, steps=steps, minutes=LATE))
    parser.fit(pairs[:20], pairs[20:], observe)
    [line] = [line for line in observe.lines if "are not enough" in line]
    assert "the training ends after 6." in line
    assert observe.fractions == sorted(observe.fractions)
    assert observe.fractions[-1] == 1
    assert all(parser.predict(utterances(pairs)))


def test_preparing_counts_as_progress(config, pairs, tmp_path, monkeypatch):
    """Time left is what progress leaves: after long preparing, few steps are most of neither."""
    prepare = Fitting._prepare

    def slowly(fitting, *arguments):
        prepare(fitting, *arguments)
        fitting._clock.before = 3600.0

    monkeypatch.setattr(Fitting, "_prepare", slowly)
    observe = Recorder(tmp_path)
    FormRanker(config).fit(pairs[:20], pairs[20:], observe)
    assert observe.fractions[LEAST_TIMED] > 0.9
    assert observe.fractions == sorted(observe.fractions)
    assert observe.fractions[-1] == 1


def test_a_training_that_has_time_takes_all_steps(config, pairs, tmp_path):
    observe = Recorder(tmp_path)
    FormRanker(config).fit(pairs[:20], pairs[20:], observe)
    assert not any("are not enough" in line for line in observe.lines)


@pytest.mark.parametrize("checks", [60, 75])
def test_a_training_that_was_cut_and_stopped_goes_on_to_its_end(config, pairs, tmp_path, checks):
    short = replace(config, minutes=LATE)
    with pytest.raises(Cancelled):
        FormRanker(short).fit(pairs[:20], pairs[20:], Recorder(tmp_path, checks))
    observe = Recorder(tmp_path)
    parser = FormRanker(short)
    parser.fit(pairs[:20], pairs[20:], observe)
    assert observe.fractions[-1] == 1
    assert all(parser.predict(utterances(pairs)))
