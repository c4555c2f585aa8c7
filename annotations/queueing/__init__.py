"""Verbs: say what is to be done and why, give it to one person at a time, and record what came of it.

``enqueue`` adds items and ``refill`` the ones that rows call for. ``next_item`` gives a person the item
they hold or the most urgent free one, under a lease; ``finish``, ``skip``, ``give_back`` and ``take_back``
end and reopen their assignment; ``settle`` and ``unsettle`` do so for what is decided elsewhere.
``send_examples`` asks about what examples of splits were copied from.

A share of the utterances goes to two people, who do not see each other's labels; where these differ a third
person compares them. ``answer`` labels an utterance and ends the assignment in one transaction. ``ask_about`` asks
for a look at a row, ``assign_first`` gives several items to one person.
"""
