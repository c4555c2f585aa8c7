"""Probes: texts that a parser should not understand, or should answer as before. Make them, ask a run, sum up."""
