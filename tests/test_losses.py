"""What was lost for a while splits nothing: steps are those of the whole capture (spec 3)."""

from dataclasses import replace

import motions
import numpy as np
import pytest

from capar.model.capture import Capture, Sensor, Stream, TagObject
from capar.model.facts import Touching
from capar.pipelines.observation import observe

WHOLE = motions.drink_from_mug(motions.WOMAN).capture
HELD_S = (2.1, 2.6)
"""The mug is lifted and nears the head: nothing begins or ends [s]."""


def lost(capture: Capture, name: str, first_s: float, last_s: float) -> Capture:
    """The capture with one body lost for a while."""

    def mended(each: Sensor | TagObject) -> Stream:
        places, turns = each.stream.positions.copy(), each.stream.orientations.copy()
        gone = (capture.times >= first_s) & (capture.times <= last_s)
        places[gone], turns[gone] = np.nan, np.nan
        return Stream(each.stream.times, places, turns)

    sensors = (replace(e, stream=mended(e)) if e.name == name else e for e in capture.sensors)
    objects = (replace(e, stream=mended(e)) if e.name == name else e for e in capture.objects)
    return replace(capture, sensors=tuple(sensors), objects=tuple(objects))


@pytest.mark.parametrize("name", ["mug", "table", "head"])
@pytest.mark.parametrize("length_s", [0.15, 0.45])
def test_a_loss_in_which_nothing_happens_changes_no_step(name: str, length_s: float) -> None:
    whole = observe(WHOLE)
    seen = observe(lost(WHOLE, name, HELD_S[0], HELD_S[0] + length_s))
    assert [[s.name for s in link.segments] for link in seen.links] == [
        [s.name for s in link.segments] for link in whole.links
    ]
    touching = {each for each in whole.facts if isinstance(each, Touching)}
    assert {each for each in seen.facts if isinstance(each, Touching)} == touching


def test_what_ends_in_a_loss_ends_where_the_body_was_last_seen() -> None:
    """The hand lets go of the mug while the mug is lost until the capture ends."""
    (held,) = [
        each for each in observe(WHOLE).facts
        if isinstance(each, Touching) and (each.body, each.other) == ("right_hand", "mug")
    ]  # fmt: skip
    last_s = float(WHOLE.times[held.last])
    seen = observe(lost(WHOLE, "mug", last_s - 0.2, float(WHOLE.times[-1])))
    (cut,) = [
        each for each in seen.facts
        if isinstance(each, Touching) and (each.body, each.other) == ("right_hand", "mug")
    ]  # fmt: skip
    assert last_s - 0.25 < WHOLE.times[cut.last] < last_s - 0.15
