"""Verbs: collect utterances, give them a form, take an answer back, mend what the anonymizer missed.

``collect`` stores texts that people said or wrote; ``label`` stores one person's answer, ``take_back_label``
undoes it exactly; ``accept`` makes a stored answer the one that counts; ``mend_span`` says which words
name an entity; ``restore_utterance`` makes it again what it was.
"""
