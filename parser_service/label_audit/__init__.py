"""Labels that may be wrong: answers of parsers that did not see them, and the checks of the language core."""
