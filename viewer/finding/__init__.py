"""Finding the paths of a picture that did something: what is asked, of what, and what came out."""
