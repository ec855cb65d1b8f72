"""The same paths traced by a compute shader: same scene, same random integers, same estimator, in float32.

glsl/ has a file for each of the tracer's modules that a path passes, by the same name, with the same
functions in the same order. `refusals` says what is not done here.
"""
