"""Verbs: upload utterances as people have them, undo and redo an upload, delete and restore, export labels.

``reading`` recognises formats and is free of the database; ``uploads`` shows what would be stored and
stores it; ``deletion`` deletes and restores; ``exports`` writes utterances with their labels.
"""
