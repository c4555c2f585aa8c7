"""The charts of a report."""

from __future__ import annotations

import pytest

from parser_service.reviews.charts import BOTTOM, HEIGHT, LABEL_GAP, Line, draw_lines, spread

LOWEST = HEIGHT - BOTTOM


@pytest.mark.parametrize(
    ("heights", "expected"),
    [
        ([], []),
        ([50.0], [50.0]),
        ([50.0, 100.0], [50.0, 100.0]),
        ([52.0, 50.0], [50.0 + LABEL_GAP, 50.0]),
        ([LOWEST, LOWEST, 10.0], [LOWEST - LABEL_GAP, LOWEST, 10.0]),
    ],
)
def test_names_of_lines_do_not_lie_on_each_other(heights, expected):
    assert spread(heights) == expected


def test_epochs_are_counted_in_whole_numbers():
    drawn = draw_lines("Loss", [Line("training", [1, 2, 3], [0.9, 0.5, 0.4])], "epoch", "loss")
    assert ">2<" in drawn and "1.5<" not in drawn


def test_a_line_without_points_is_left_out():
    drawn = draw_lines("Loss", [Line("none", [1], [None]), Line("loss", [1, 2], [3, 1])], "x", "y")
    assert drawn.count("<polyline") == 1
    assert ">loss<" in drawn and ">none<" not in drawn and "style-1" in drawn
