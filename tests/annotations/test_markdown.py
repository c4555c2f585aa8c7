"""Markdown of people becomes HTML that is safe to show, in linear time."""

from __future__ import annotations

import pytest

from annotations.showing.markdown import rendered
from benchmarks.language.hostile_patterns import HostileText, seconds

UNITS = (
    *("a", " ", "*", "**a", "_", "`", "``` ", "[", "](", "[a](b) ", "![", "<", "<a ", "> ", "- ", "# ", "|", "\\"),
    *("a\n", "a|b\n", "|-|\n", "&#", "[a]: b\n", "***", "*a_ ", "~~", "1. ", "    a\n", "<!--", "a@b.", "http://"),
)  # fmt: skip


@pytest.mark.parametrize(
    ("text", "html"),
    [
        ("# Labels", "<h3>Labels</h3>\n"),
        ("###### Deep", "<h6>Deep</h6>\n"),
        ("<script>x</script>", "<p>&lt;script&gt;x&lt;/script&gt;</p>\n"),
        ("[a](https://b)", '<p><a href="https://b" rel="noopener nofollow">a</a></p>\n'),
        ("[a](javascript:b)", "<p>[a](javascript:b)</p>\n"),
        ("[a](data:text/html,b)", "<p>[a](data:text/html,b)</p>\n"),
        ("[a](ftp://b)", "<p>[a](ftp://b)</p>\n"),
        ("[a](intent:b)", "<p>[a](intent:b)</p>\n"),
        ("<tel:112>", "<p>&lt;tel:112&gt;</p>\n"),
        ("[a](/b?c=d:e)", '<p><a href="/b?c=d:e" rel="noopener nofollow">a</a></p>\n'),
        ("<a@b.c>", '<p><a href="mailto:a@b.c" rel="noopener nofollow">a@b.c</a></p>\n'),
        ("<https://b>", '<p><a href="https://b" rel="noopener nofollow">https://b</a></p>\n'),
    ],
)
def test_what_becomes_of(text, html):
    assert rendered(text) == html


def test_images_and_handlers_are_not_made():
    html = rendered('![a](https://b/c.png "d") <img src=x onerror=y> [a](x "\\" onclick=\\"y")')
    assert "<img" not in html and 'onclick="' not in html


def test_tables_are_made():
    assert "<td>b</td>" in rendered("| a |\n| - |\n| b |\n")


def test_cells_are_aligned_by_class_as_styles_are_refused():
    html = rendered("| a | b |\n| -: | :- |\n| 1 | 2 |\n")
    assert '<td class="number">1</td>' in html
    assert "style" not in html


@pytest.mark.parametrize("head", ["", "[", "> ", "| a |\n| - |\n"])
@pytest.mark.parametrize("unit", UNITS)
def test_rendering_is_linear(unit, head):
    quarter, whole = (
        seconds(lambda size=size: rendered(HostileText(head, unit, "").of(size)), 2)
        for size in (5_000, 20_000)
    )
    assert whole < max(0.5, 9 * quarter)  # quadratic work takes sixteen times as long
