"""A small ontology in which no text has two meanings, except where a test says so."""

from __future__ import annotations

from annotations.language.world import Entity, Ontology

HOME = Ontology(
    (
        Entity("category", "drinks", (), {"singular": "drink"}),
        Entity("object", "tea", ("cuppa",), {"category": "drinks"}),
        Entity("object", "bread knife"),
        Entity("object", "knife"),
        Entity("object", "small dish"),
        Entity("object", "cookies"),
        Entity("category", "toys"),
        Entity("room", "attic"),
        Entity("room", "tea room"),
        Entity("location", "shelf", (), {"room": "attic", "isPlacement": "true"}),
        Entity("location", "shelf", (), {"room": "tea room", "isPlacement": "true"}),
        Entity("location", "stool", (), {"room": "attic", "isBeacon": "true"}),
        Entity("name", "Bo"),
        Entity("name", "Bo", (), {"gender": "Male"}),
        Entity("name", "Ada"),
        Entity("gesture", "waving their hand"),
        Entity("question", "What is up?", (), {"answer": "The sky."}),
        Entity("whattosay", "a joke"),
    )
)
