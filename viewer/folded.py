"""Chinese on the terminal: lines end between any two characters, but none begins with what closes a sentence.

rich breaks lines at spaces only, which moves whole sentences to the next line and cuts words in two.
"""

import re

from rich.cells import cell_len
from rich.measure import Measurement

# One Chinese character or mark with what must not be torn from it, or a word of other letters.
_WIDE = r"\u2e80-\u303f\u3400-\u9fff\uff00-\uffef“”‘’…"
_OPENS, _SHUTS = "（［｛“‘《「(\\[", "，。；：？！、）］｝”’》」…,;:?!)\\]"
_PIECE = re.compile(rf"[{_OPENS}]*(?:[{_WIDE}]|[^\s{_WIDE}]+)[{_SHUTS}]*\s*|\s+")


class Folded:
    """A rich Text that is broken into lines as Chinese is."""

    def __init__(self, text):
        self.text = text

    def __rich_console__(self, console, options):
        """Its lines."""
        for line in self.text.divide(ends_of_lines(self.text.plain, options.max_width)):
            spaces = len(line) - len(line.plain.rstrip(" "))
            yield line[: len(line) - spaces] if spaces else line

    def __rich_measure__(self, console, options):
        """From its longest piece to all of it on one line."""
        longest = max((cell_len(piece.rstrip()) for piece in _PIECE.findall(self.text.plain)), default=0)
        return Measurement(min(longest, options.max_width), min(cell_len(self.text.plain), options.max_width))


def ends_of_lines(text, width):
    """Where lines of at most `width` cells end; what is longer than a line begins one and fills the next."""
    ends, used = [], 0
    for found in _PIECE.finditer(text):
        word = found[0].rstrip()
        if used and used + cell_len(word) > width:
            ends.append(found.start())
            used = 0
        cuts = [found.start() + at for at in _cuts(word, width)]
        ends += cuts
        used = (
            0
            if "\n" in found[0]
            else used + cell_len(text[cuts[-1] if cuts else found.start() : found.end()])
        )
    return ends


def _cuts(word, width):
    """Where a word is cut that is longer than a line."""
    cuts, used = [], 0
    for at, letter in enumerate(word if cell_len(word) > width else ""):
        if used + cell_len(letter) > width:
            cuts.append(at)
            used = 0
        used += cell_len(letter)
    return cuts
