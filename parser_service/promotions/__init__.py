"""Verbs: promote a run, so that it answers in its world; roll back; propose and decline."""
