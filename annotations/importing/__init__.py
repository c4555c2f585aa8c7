"""Verb: import files, all or nothing. A second import of the same files changes nothing."""
