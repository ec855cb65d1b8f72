"""New users walk lessons from the list to the last solved task: with the mouse, and by the keyboard alone."""

import pytest
from viewers import SMALL

from lessons import answer
from lessons.course import lesson
from lessons.run import Run
from viewer.link import of_moment
from viewer.reading import PLACES

pytestmark = pytest.mark.browser
SEEN = "() => document.activeElement.dataset.testid"
# Whether an element comes before the one that has the focus
BEHIND = """id => {
  const place = document.activeElement.compareDocumentPosition(document.querySelector(`[data-testid=${id}]`));
  return Boolean(place & Node.DOCUMENT_POSITION_PRECEDING);
}"""


class Mouse:
    """Points and clicks; types only what has to be typed."""

    def __init__(self, page):
        self.page = page

    def turn_to_lessons(self):
        self.press("tab-lesson")

    def press(self, testid):
        self.page.get_by_test_id(testid).click()

    def write(self, testid, text):
        self.page.get_by_test_id(testid).fill(text)

    def choose(self, testid, value):
        self.page.get_by_test_id(testid).select_option(value)

    def tick(self, first, testid):
        self.page.get_by_test_id(testid).check()

    def pick(self, x, y):
        """A pixel, in the picture."""
        size = self.page.evaluate("() => window.trame.state.get('picture')")
        box = self.page.get_by_test_id("picture").bounding_box()
        unit = min(box["width"] / size["width"], box["height"] / size["height"])
        across = box["x"] + box["width"] / 2 + (x + 0.5 - size["width"] / 2) * unit
        down = box["y"] + box["height"] / 2 + (y + 0.5 - size["height"] / 2) * unit
        self.page.mouse.click(across, down)

    def event(self, step):
        self.press(f"mark-{step}")

    def path(self, number):
        many = self.page.evaluate("() => window.trame.state.get('samples').bars.length")
        bars = self.page.get_by_test_id("bars")
        box = bars.bounding_box()
        bars.click(position={"x": (number + 0.5) * box["width"] / many, "y": box["height"] / 2})


class Keyboard:
    """Keys and nothing else: Tab goes from one thing to the next."""

    def __init__(self, page):
        self.page = page

    def reach(self, testid):
        """Tab until that has the focus, or Shift and Tab if it lies behind."""
        key = "Shift+Tab" if self.page.evaluate(BEHIND, testid) else "Tab"
        for _ in range(300):
            if self.page.evaluate(SEEN) == testid:
                return
            self.page.keyboard.press(key)
        raise AssertionError(f"Tab does not lead to {testid}")

    def turn_to_lessons(self):
        self.page.keyboard.press("l")

    def press(self, testid):
        self.reach(testid)
        self.page.keyboard.press("Enter")

    def write(self, testid, text):
        self.reach(testid)
        self.page.keyboard.press("Control+A")
        self.page.keyboard.type(text)

    def choose(self, testid, value):
        self.reach(testid)
        self.page.keyboard.type(value)

    def tick(self, first, testid):
        """One of several answers: from the first on, arrows go through them."""
        self.reach(first)
        self.page.keyboard.press("Space")
        while self.page.evaluate(SEEN) != testid:
            self.page.keyboard.press("ArrowDown")

    def pick(self, x, y):
        for testid, value in (("pixel-x", x), ("pixel-y", y)):
            self.write(testid, str(value))
            self.page.keyboard.press("Enter")

    def event(self, step):
        self.page.keyboard.press("Home")
        for _ in range(step):
            self.page.keyboard.press("ArrowRight")

    def path(self, number):
        now = self.page.evaluate("() => window.trame.state.get('path_index')")
        for _ in range(abs(number - now)):
            self.page.keyboard.press("ArrowDown" if number > now else "ArrowUp")


@pytest.fixture(scope="module", params=[Mouse, Keyboard], ids=["mouse", "keyboard"])
def hand(request, newcomer, tab):
    """Somebody who has done nothing yet, at one tab of a viewer of their own."""
    return request.param(tab(newcomer("cornell_unit", *SMALL).address))


def give(hand, run, task, said):
    """Give one answer, as the task asks for it."""
    page = hand.page
    if task.kind in PLACES:
        hand.press(f"there-{task.id}")
        there = of_moment(run.lesson.moments[task.at]).write()
        page.locator(f"[data-link='{there}']").wait_for()
        {"pixel": hand.pick, "path": hand.path, "event": hand.event}[task.kind](*map(int, said))
        where = {"pixel": "x={}&y={}&", "path": "&path={}&", "event": "&event={}"}[task.kind].format(*said)
        page.locator(f"[data-link*='{where}']").wait_for()
    elif task.kind == "choice":
        first = next(iter(run.lesson.words["en"].tasks[task.id].choices))
        hand.tick(f"answer-{task.id}-{first}", f"answer-{task.id}-{said[0]}")
    elif task.kind == "bug":
        hand.choose(f"answer-{task.id}", said[0])
    else:
        hand.write(f"answer-{task.id}", said[0])
    hand.press(f"check-{task.id}")


@pytest.mark.parametrize("number", [1, 4, 13, 14, 21])
def test_a_new_user_solves_a_lesson(hand, number):
    """One wrong answer, the hint that it brings, and then every task right."""
    it, run, page = lesson(number), Run(lesson(number)), hand.page
    hand.turn_to_lessons()
    if page.get_by_test_id("lesson-list").count():
        hand.press("lesson-list")
        page.get_by_test_id("lesson-1").wait_for()
    hand.press(f"lesson-{number}")
    page.get_by_test_id("lesson-title").filter(has_text=it.words["en"].title).wait_for()
    first = next(iter(it.tasks.values()))
    page.get_by_test_id(f"task-{first.id}").wait_for()
    give(hand, run, first, answer.spelled(answer.wrong(run, first)[0]))
    page.locator(f"[data-testid=reply-{first.id}][data-right=false]").wait_for()
    page.get_by_test_id(f"hints-{first.id}").first.wait_for()
    for task in it.tasks.values():
        give(hand, run, task, answer.spelled(answer.right(run, task)))
        page.locator(f"[data-testid=task-{task.id}][data-solved=true]").wait_for()
    page.get_by_text("All tasks of this lesson are solved.").wait_for()
