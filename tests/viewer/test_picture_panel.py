"""The doctor's panel says of the file that is compared with which mistakes it fits: hypotheses."""

import pytest

import tracer
from lessons.zoo import ZOO

pytestmark = pytest.mark.browser


def test_a_compared_picture_gives_hypotheses_in_the_doctors_panel(serve, browser, tmp_path):
    bug, file = ZOO["D06"], tmp_path / "mine.png"
    settings = bug.asked(width=48, height=48, spp=8)
    tracer.write(tracer.render(tracer.load("cornell"), settings, steps=bug.steps), file)
    page = browser.new_context(viewport={"width": 1280, "height": 720}).new_page()
    page.goto(serve("cornell", "--spp", "2", "--compare", str(file)).address)
    page.wait_for_selector("html[data-ready]")
    page.get_by_test_id("tab-doctor").click()
    page.get_by_test_id("doctor-guess").click()
    page.get_by_test_id("hypothesis-0").wait_for()
    assert "fits D06" in page.get_by_test_id("hypothesis-0").inner_text()
    assert "no findings" in page.get_by_test_id("doctor-guessed").inner_text()
    assert page.get_by_test_id("finding-0").count() == 0
    page.context.close()
