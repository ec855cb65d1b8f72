"""What one can learn from wrong tracers: the bug zoo, and the lessons."""
