"""How an utterance is shown as it was heard."""

from __future__ import annotations

import pytest

from parser_service.templatetags.hearing import as_percent, heard
from parser_service.web.serving.heard_pieces import HeardPiece


def test_changes_are_marked_and_what_people_wrote_is_escaped():
    pieces = [
        HeardPiece("<uh>", why="a filler"),
        HeardPiece(" bring "),
        HeardPiece("Haley", heard="Hailey", why="it sounds alike"),
        HeardPiece("cup", "object", "red cup"),
    ]
    shown = heard(pieces)
    assert '<del title="a filler">&lt;uh&gt;</del> bring ' in shown
    assert (
        '<del title="it sounds alike">Haley</del> <ins title="it sounds alike">Hailey</ins>'
        in shown
    )
    assert 'data-class="object"' in shown


@pytest.mark.parametrize(("probability", "shown"), [(0.0, 1), (0.774, 77), (0.999, 99)])
def test_nothing_is_certain(probability, shown):
    assert as_percent(probability) == shown
