"""The figures of how the code is cut, on a house of four files."""

from __future__ import annotations

import pytest

from benchmarks.house import House, figures_of

FILES = {
    "annotations/__init__.py": "",
    "annotations/urls.py": "from annotations import page\n",
    "annotations/rest_urls.py": "from annotations import route\n",
    "annotations/page.py": (
        "from annotations.ground import stand\n\ndef view():\n    return _once() + stand()\n\n"
        "def _once():\n    return _often() + _often()\n\ndef _often():\n    return 1\n"
    ),
    "annotations/route.py": "from annotations.page import view\n",
    "annotations/ground.py": "def stand():\n    from annotations import page\n    return page\n",
}


@pytest.fixture
def root(tmp_path):
    for name, source in FILES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(source)
    return tmp_path


def test_figures_are_read_from_the_source(root):
    figures = figures_of(root)
    assert figures["files"] == "5"  # the empty one does not count
    assert figures["functions"] == "4"
    assert figures["private functions used in one place"] == "1 (25.0%)"
    assert figures["imports of a page by a route"] == "1"
    assert figures["files that importing a page loads (median)"] == "1"
    assert figures["longest chain of imports"] == "4"


def test_an_import_within_a_function_closes_a_circle_and_loads_nothing(root):
    house = House(root)
    assert [sorted(circle) for circle in house.circles] == [
        ["annotations.ground", "annotations.page"]
    ]
    assert house.reached("annotations.ground") == set()
