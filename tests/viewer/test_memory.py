"""Picking goes on for hours: what the server holds does not grow with the number of picks."""

import gc
import tracemalloc

import pytest
from benchmarks.looking import _server as calls_of
from benchmarks.memory import slope

import tracer
from viewer.session import Session

pytestmark = pytest.mark.slow

BATCHES, PICKS, SIDE = 5, 8, 8
MOST = 5e3  # bytes a pick, the list of picked pixels among them; a record has many times as many


def grown(keep):
    """Bytes that one pick more leaves behind; keep(session) is called after each."""
    settings = tracer.Settings(width=SIDE, height=SIDE, spp=2, max_depth=3)
    session = Session(tracer.load("cornell_unit"), settings, None)
    calls, sizes, k = calls_of(session), [], 0
    tracemalloc.start()
    try:
        for _ in range(BATCHES):
            for _ in range(PICKS):
                k += 1
                calls["pick"](k * 3 % SIDE, k * 5 % SIDE)
                keep(session)
            gc.collect()
            sizes.append(tracemalloc.get_traced_memory()[0])
    finally:
        tracemalloc.stop()
    return slope(sizes[2:]) / PICKS


def test_memory_is_flat_however_many_pixels_are_picked():
    assert grown(lambda session: None) < MOST


def test_records_that_are_kept_are_seen():
    """The broken twin: whoever holds on to what was picked before."""
    kept = []
    assert grown(lambda session: kept.append(session.record)) > MOST
