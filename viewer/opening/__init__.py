"""What the viewer opens beside scenes and recordings: a learner's own tracer, a log, a picture."""
