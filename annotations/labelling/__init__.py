"""Verbs: collect utterances, give them a form, take an answer back, mend what the anonymizer missed.

``collect`` stores texts that people said or wrote; ``label`` stores one person's answer, ``take_back``
undoes it exactly; ``accept`` makes a stored answer the one that counts; ``mend_span`` says which words
name an entity; ``restore_utterance`` makes it again what it was.
"""

from annotations.labelling.answers import AnsweredMeanwhile, accept, label, take_back
from annotations.labelling.collecting import collect
from annotations.labelling.form_check import canonical_label, check_label
from annotations.labelling.restoring import restore_utterance
from annotations.labelling.spans import mend_span

__all__ = [
    "AnsweredMeanwhile",
    "accept",
    "canonical_label",
    "check_label",
    "collect",
    "label",
    "mend_span",
    "restore_utterance",
    "take_back",
]
