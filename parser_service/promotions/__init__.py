"""Verbs: promote a run, so that it is the learned part of what answers in its world; roll back; propose and decline."""
