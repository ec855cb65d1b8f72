"""Why a pixel is what it is: its parts, its reasons, and what happened at one of its vertices."""
