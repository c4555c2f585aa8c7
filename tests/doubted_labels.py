"""Labels that an audit doubts."""

from __future__ import annotations

from annotations.labelling.audit_findings import SuspectPair
from annotations.language.corpus.label_errors import Finding, LabelledPair, Reason, Suspect
from annotations.models import Paraphrase, Utterance
from tests.sample_world import make_paraphrase

MALE = '( say ( count ( lambda $1 e ( person $1 ) ( male $1 ) ( at $1 " <room> " ) ) ) )'
FEMALE = MALE.replace("male", "female")
GO = '( go " <room> " )'


def say(world, utterance: str, form: str = MALE, **columns) -> Paraphrase:
    """Store a paraphrase that names the kitchen."""
    return make_paraphrase(
        world,
        prompt="tell me how many people in the kitchen are girls",
        utterance=utterance,
        logical_form=form,
        grounded_form=form.replace("<room>", "kitchen"),
        **columns,
    )


def doubt(row: Paraphrase | Utterance, suggested: str = FEMALE, *reasons: Reason) -> SuspectPair:
    """Return what an audit says against the label of ``row``."""
    name = "utterance" if isinstance(row, Utterance) else "paraphrase"
    text = row.anonymized_text if name == "utterance" else row.utterance
    pair = LabelledPair(f"{name}-{row.pk}", text, row.logical_form, "how many girls", suggested)
    findings = [
        Finding(pair, reason, f"The {reason} says so.", suggested, 1.0)
        for reason in reasons or (Reason.COMMAND,)
    ]
    return SuspectPair((name, row.pk), Suspect(pair, tuple(findings)))
