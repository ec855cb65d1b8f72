"""From a strange picture to the guilty event and the name of the mistake: in six clicks or keys."""

import json
from dataclasses import fields

import pytest
from suite import castray

from lessons import zoo
from tracer.settings import Settings
from viewer.link import Link

pytestmark = pytest.mark.browser

SIDE, SPP, MOST = 24, 8, 6


class Reader:
    """Who looks at a strange picture: clicks are counted, and the commands are asked what is to be seen."""

    def __init__(self, page, bug):
        self.page, self.bug, self.clicks = page, zoo.of(bug), 0
        self.settings = self.bug.asked(width=SIDE, height=SIDE, spp=SPP, bug=bug)
        link = Link(self.bug.scene, self.settings, (12, 12, 0, 0)).write()
        page.evaluate("link => window.trame.trigger('open', [link])", link)
        page.locator(f"[data-testid=castray][data-link='{link}']").wait_for()
        page.get_by_test_id("progress").wait_for(state="detached")

    def click(self, name):
        """Click what has a test id, when it is there."""
        self.clicks += 1
        self.page.get_by_test_id(name).click()

    def pick(self, x, y):
        """Click a pixel of the picture."""
        self.clicks += 1
        box = self.page.get_by_test_id("picture").bounding_box()
        side = min(box["width"], box["height"])
        left, top = (box[a] + (box[b] - side) / 2 for a, b in (("x", "width"), ("y", "height")))
        self.page.mouse.click(left + (x + 0.5) * side / SIDE, top + (y + 0.5) * side / SIDE)
        self.page.locator(f"[data-testid=event-table][data-pixel='{x},{y}']").wait_for()

    def choose(self, name, value):
        """Choose from a list: to open it and to take one are a click each, or some keys and one more."""
        self.clicks += 2
        self.page.get_by_test_id(name).select_option(value)

    def stands_at(self, x, y, path, event):
        """Wait until the table shows the place."""
        table = f"[data-testid=event-table][data-pixel='{x},{y}'][data-path='{path}']"
        self.page.locator(f"{table} [data-testid=row-{event}][data-now=true]").wait_for()

    def reason(self, x, y, key):
        """Click the sentence of that kind, which is the command's, and stand where it leads."""
        said = self.command("inspect", "--pixel", x, y, "--why")["why"]
        number, reason = next((k, r) for k, r in enumerate(said) if r["key"] == key)
        assert reason["strange"]
        assert self.page.get_by_test_id(f"reason-{number}").inner_text() == reason["sentence"]
        self.click(f"reason-{number}")
        self.stands_at(x, y, reason["path"], reason["event"])

    def command(self, name, *words):
        """What a command says of the same picture."""
        options = ["--size", SIDE, SIDE]
        for f in fields(Settings):
            value = getattr(self.settings, f.name)
            if f.name not in ("width", "height") and value != f.default:
                option = f.name.replace("_", "-")
                options += [f"--no-{option}"] if value is False else [f"--{option}", value]
        ran = castray(name, self.bug.scene, *options, *words, "--json")
        assert ran.stdout, ran.stderr
        return json.loads(ran.stdout)

    def is_led_to_the_cause(self):
        """Click the first finding: it is the command's, names the mistake, and leads to what proves it."""
        self.page.get_by_test_id("doctor-verdict").wait_for()
        found = next(f for f in self.command("doctor")["findings"] if f["follows"] is None)
        card, first = self.page.get_by_test_id("finding-0"), found["first"]
        assert found["bug"] in zoo.alike(self.bug.id) and found["bug"] in card.get_attribute("data-bug")
        assert card.get_attribute("data-rule") == found["rule"]
        assert int(card.get_attribute("data-count")) == found["count"]
        self.click("finding-go-0")
        self.stands_at(first["x"], first["y"], first["sample"], first["step"])
        assert self.page.get_by_test_id("event-kind").get_attribute("class").endswith(first["kind"])
        assert self.clicks <= MOST


@pytest.fixture(scope="module")
def page(serve, tab):
    """One tab of one viewer for all stories."""
    size = ("--size", f"{SIDE}", f"{SIDE}", "--spp", f"{SPP}")
    return tab(serve("cornell", *size, "--bug", "D01").address)


def test_black_stripes(page):
    """A dark pixel beside a bright one, why it is dark, the doctor."""
    reader = Reader(page, "D01")
    reader.pick(8, 20)
    reader.click("tab-why")
    reader.reason(8, 20, "light.phantom")
    reader.click("why-doctor")
    reader.is_led_to_the_cause()


def test_white_dots(page):
    """The brightest firefly of the picture, then the doctor."""
    reader = Reader(page, "E01")
    reader.click("tab-find")
    reader.click("find-prepare")
    reader.click("firefly-0")
    page.locator("[data-testid=event-kind].hit").wait_for()  # a lamp that was met
    reader.click("tab-doctor")
    reader.click("doctor-examine")
    reader.is_led_to_the_cause()


def test_too_bright(page):
    """The largest part of the pixel, its equation, which does not give what was recorded, the doctor."""
    reader = Reader(page, "D11")
    reader.click("tab-ledger")
    largest = max(
        page.locator("[data-testid^='bar-light-']").all(),
        key=lambda bar: sum(json.loads(bar.get_attribute("data-exact"))),
    )
    reader.click(largest.get_attribute("data-testid"))
    reader.click("tab-equation")
    page.get_by_test_id("equation-differs").wait_for()
    reader.click("tab-doctor")
    reader.click("doctor-examine")
    reader.is_led_to_the_cause()


def test_wrong_wall_colour(page):
    """A pixel of the wall that should be red, why it is grey, the doctor."""
    reader = Reader(page, "D06")
    reader.pick(3, 9)
    reader.click("tab-why")
    reader.reason(3, 9, "unfit.f")
    reader.click("why-doctor")
    reader.is_led_to_the_cause()


def test_dark_glass(page):
    """A dark pixel of the glass, where a direction is no number, the doctor."""
    reader = Reader(page, "S02")
    reader.pick(6, 8)
    reader.click("tab-why")
    reader.reason(6, 8, "unfit.direction")
    reader.click("why-doctor")
    reader.is_led_to_the_cause()
