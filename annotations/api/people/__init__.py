"""People: members of a world and how they join it, accounts, tokens, and the log of what they did."""
