"""Submissions judged: a tracer in Python, a log or a picture alone, or all that lie in a folder."""
