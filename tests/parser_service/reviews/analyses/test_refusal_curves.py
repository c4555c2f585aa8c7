"""A risk–coverage curve in words."""

from __future__ import annotations

from parser_service.reviews.refusal_curves import curve_chart, place_of, points_of

# Log-probabilities, as a curve of seq2seq has them, from the highest bound to the lowest.
CURVE = {
    "count": 4,
    "correct": 3,
    "bounds": [None, -0.25, -12.5],
    "answered": [0, 3, 4],
    "wrong": [0, 0, 1],
    "lost": [3, 0, 0],
    "gained": [0, 0, 0],
    "spared": [1, 1, 0],
}


def test_people_read_a_minus_sign_and_addresses_have_a_hyphen():
    points = points_of(CURVE)
    assert [point.bound for point in points] == ["-12.5", "-0.25", ""]
    assert [point.shown for point in points] == ["−12.5", "−0.25", "any score"]
    assert "below a score of −0.25 withholds 1 wrong answer" in points[1].sentence
    assert place_of(points, "-0.25") == 1


def test_an_axis_of_percent_ends_at_100():
    worse = {**CURVE, "wrong": [0, 3, 4]}
    assert curve_chart(points_of(worse), 0)["y"]["max"] == 100
    assert (
        "max" not in curve_chart(points_of(CURVE), 0)["y"]
    )  # 25 % at most: the axis follows the curve
