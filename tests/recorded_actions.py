"""Scripted actions as sources of regenerations, observed once for all tests."""

from functools import cache

from capar.body.scripted_actions import action_capture
from capar.pipelines.round_trips import Trip, body, observed_source, round_trip
from capar.regeneration import Source
from capar.regeneration.scenes import Scene

RATE_HZ = 30.0


@cache
def recorded(action: str, who: str = "man", *, noisy: bool = False) -> Source:
    """What a perfect tracker, or a noisy one, records of an action at 30 Hz."""
    return observed_source(action_capture(action, who, rate_hz=RATE_HZ, noisy=noisy))


def good_trip(source: Source, agent: str, scene: Scene | None = None) -> Trip:
    """A round trip that has to pass, in the recorded scene unless stated."""
    trip = round_trip(source, agent, body(agent, source), 0, scene or source.scene)
    assert trip.passed, (trip.refused, trip.names, trip.quality and trip.quality.failed)
    return trip
