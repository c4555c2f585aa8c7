"""What refusing to answer below a bound on the score costs and saves."""
