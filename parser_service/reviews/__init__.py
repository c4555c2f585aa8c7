"""Say why answers are wrong: error categories of a world, the machine's proposals, people's reviews."""
