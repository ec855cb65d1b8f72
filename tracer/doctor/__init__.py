"""The doctor: holds the laws of light transport against a Trace; says which are broken, where, and by what.

It judges what was recorded, not the program that recorded it: each number of each event is worked out anew in
float64 from the others, and over many paths their distributions are compared with what they claim to be. The
plain answers are its own where there is a second way to them (rays against every primitive one by one, the
chance of a lamp, weights, sums); BSDFs and densities of lamps are asked of the scene's own functions, in
float64.
"""

from tracer.doctor.diagnosis import Diagnosis, Finding, examine
from tracer.doctor.laws import LAWS
from tracer.doctor.rule import Rule, Verdict

__all__ = ["LAWS", "Diagnosis", "Finding", "Rule", "Verdict", "examine"]
