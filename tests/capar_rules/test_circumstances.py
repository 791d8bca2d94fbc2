"""What is told of a segment's circumstances is true: recomputed from streams and contacts."""

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import motions
import numpy as np
import pytest
from recomputed.known import Known
from recomputed.others import touched_nothing

from capar.model.capture import Capture
from capar.pipelines.explanation import Explained, measured_of
from capar.pipelines.observation import observe_measured
from capar_rules.engine.profiles import Profile, profile
from capar_rules.explain.explanation import Explainer
from extractors.measure import measure

WORDS = (
    "lasts_ms(S,A)", "contact_ms(S,A,B,C)", "mean_mm_s(S,A,B)", "met_mm_s(S,A,B,C)",
    "left_mm_s(S,A,B)", "borne_at(S,A,B,C)", "touches_with(S,A,B,C)", "toward_performer(S,A)",
    "from_performer(S,A)", "heads_for(S,A,B)", "swing_count(S,A)", "touched_times(S,A,B)",
    "rest_ms(S,A)", "contains_at(S,A,B,C)",
)  # fmt: skip
"""Words of which a segment is told whatever holds, by ``also``."""

HEAD = "head"


def telling(folder: Path) -> Profile:
    """The extended rules with a file that has every circumstance told beside the name."""
    path = folder / "telling.lp"
    lines = (f"also(named(S,N), {word}) :- named(S,N), {word}.\n" for word in WORDS)
    path.write_text('%* Telling: what holds. *%\nprimitive("Telling").\n' + "".join(lines))
    return replace(profile("extended"), added=(path,))


def told(capture: Capture, rules: Profile) -> Iterator[tuple[Known, str]]:
    """Each sentence of each segment, with what it can be recomputed from."""
    measurements = measure(capture)
    observation = observe_measured(capture, measurements, rules=rules)
    measured = measured_of(observation, measurements)
    explainer = Explainer(observation.facts, profile=rules, measured=measured)
    for segment in observation.segments:
        known = Known(
            Explained(observation, explainer, measurements),
            measurements.facts,
            segment,
            capture,
            {},
        )
        for reason in explainer.explain(segment).reason.with_sentences().walk():
            yield known, reason.sentence


def seconds(known: Known) -> float:
    return (known.segment.last - known.segment.first) / known.rate


def lasted(known: Known, at: str) -> bool:
    return abs(seconds(known) - float(at)) < 0.011


def contact_lasted(known: Known, what: str, side: str, at: str) -> bool:
    frame = known.border(side)
    return any(
        each.first - 16 <= frame <= each.last + 16
        and abs((each.last - each.first) / known.rate - float(at)) < 0.011
        for each in known.touching(known.segment.ee, what)
    )


def went(known: Known, what: str, speed: str) -> bool:
    frames = range(known.segment.first, known.segment.last + 1)
    path = np.array([known.middle(what, each) for each in frames])
    way = float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
    return abs(way / seconds(known) - float(speed) / 1000.0) < 0.03


def met(known: Known, one: str, other: str, speed: str) -> bool:
    """The distance of the two falls by no more than that within a moment before."""
    (frame,) = {
        each.first
        for each in known.touching(one, other)
        if abs(each.first - known.segment.last) <= known.reach
    }
    before = max(frame - round(0.05 * known.rate), 0)
    ways = [
        known.stream(each).positions[frame] - known.stream(each).positions[before]
        for each in (one, other)
    ]
    fastest = float(np.linalg.norm(ways[0] - ways[1])) * known.rate / (frame - before)
    return float(speed) / 1000.0 <= 1.5 * fastest + 0.05


def left(known: Known, what: str, speed: str) -> bool:
    frame = known.segment.last
    way = known.stream(what).positions[frame] - known.stream(what).positions[frame - 5]
    return abs(float(np.linalg.norm(way)) * known.rate / 5 - float(speed) / 1000.0) < 0.1


def borne(known: Known, bearer: str, load: str, side: str) -> bool:
    frame = known.border(side)
    bottom = known.points(load, frame)[:, 2].min()
    return bool(bottom >= known.points(bearer, frame)[:, 2].max() - 0.02)


def with_tool(known: Known, tool: str, hand: str, other: str, side: str) -> bool:
    frame = known.border(side)
    touch = [each.first - 16 <= frame <= each.last + 16 for each in known.touching(tool, other)]
    own = [each.first <= frame <= each.last for each in known.touching(hand, other)]
    return any(touch) and not any(own)


def nearer_by(known: Known, what: str, other: str) -> float:
    ends = known.segment.first, known.segment.last
    first, last = (
        float(np.linalg.norm(known.middle(what, each) - known.middle(other, each))) for each in ends
    )
    return first - last


def came_nearer(known: Known, what: str) -> bool:
    return nearer_by(known, what, HEAD) > 0.095


def went_further(known: Known, what: str) -> bool:
    return nearer_by(known, what, HEAD) < -0.095


def headed(known: Known, what: str, other: str) -> bool:
    return nearer_by(known, what, other) >= 0.6 * float(np.linalg.norm(known.way(what)))


def turned_back(known: Known, what: str, count: str) -> bool:
    """Its way to the side changes its direction so often."""
    aside = known.stream(what).positions[known.segment.first : known.segment.last + 1, 1]
    smooth = np.convolve(aside, np.ones(5) / 5, mode="valid")
    steps = np.diff(smooth)
    moving = steps[np.abs(steps) > 5e-4]
    return abs(int((np.diff(np.sign(moving)) != 0).sum()) - int(count)) <= 1


def times(known: Known, what: str, count: str) -> bool:
    return len(known.touching(known.segment.ee, what)) >= int(count) >= 2


NAME = r"([\w ]+?)"
FORMS = (
    (r"it lasted (\d+\.\d\d) s", lasted),
    (rf"the contact with the {NAME} at the segment's (start|end) lasted (\d+\.\d\d) s",
     contact_lasted),
    (rf"the {NAME} went at (\d+) mm/s on average", went),
    (rf"the {NAME} met the {NAME} at (\d+) mm/s", met),
    (rf"the {NAME} went at (\d+) mm/s when it was let go", left),
    (rf"the {NAME} bore the {NAME} at the segment's (start|end)", borne),
    (
        rf"the {NAME}, and not the {NAME}, touched the {NAME} at the segment's (start|end)",
        with_tool,
    ),
    (rf"the {NAME} came nearer to the performer", came_nearer),
    (rf"the {NAME} went further from the performer", went_further),
    (rf"the {NAME} went straight towards the {NAME}", headed),
    (rf"the {NAME} turned back (\d+) times in between", turned_back),
    (rf"the {NAME} was touched (\d+) times, one soon after the other", times),
)  # fmt: skip


def waving() -> Capture:
    """A hand is raised beside a table, goes to and fro five times, and comes down."""
    capture = motions.touch_cycle(motions.TALL_MAN).capture
    (hand,) = capture.acting
    count = len(capture.times)
    clock = capture.times - capture.times[0]
    begin, end = 0.3 * clock[-1], 0.8 * clock[-1]
    ramp = np.clip(np.minimum(clock - begin, end - clock) / 0.2, 0.0, 1.0)
    positions = np.tile(hand.stream.positions[0], (count, 1))
    positions[:, 2] += 0.3 * np.clip(np.minimum(clock, clock[-1] - clock) / begin, 0.0, 1.0)
    positions[:, 1] += 0.12 * ramp * np.sin(2.0 * np.pi * 1.5 * (clock - begin))
    stream = replace(
        hand.stream,
        positions=positions,
        orientations=np.tile(hand.stream.orientations[0], (count, 1)),
    )
    sensors = tuple(
        replace(each, stream=stream) if each.name == hand.name else each for each in capture.sensors
    )
    return replace(capture, sensors=sensors)


@pytest.fixture(scope="module")
def sentences(tmp_path_factory: pytest.TempPathFactory) -> list[tuple[Known, str]]:
    rules = telling(tmp_path_factory.mktemp("rules"))
    captures = (motions.drink_from_mug(motions.TALL_MAN).capture, waving())
    return [each for capture in captures for each in told(capture, rules)]


def test_every_circumstance_that_is_told_is_true(sentences: list[tuple[Known, str]]) -> None:
    counts = dict.fromkeys((pattern for pattern, _ in FORMS), 0)
    for known, sentence in sentences:
        for pattern, check in FORMS:
            if found := re.fullmatch(pattern, sentence):
                counts[pattern] += 1
                assert check(known, *found.groups()), (known.segment, sentence)
    assert [pattern for pattern, count in counts.items() if not count] == [FORMS[-1][0]]


def test_that_nothing_is_touched_is_found_false_of_whoever_touches(
    sentences: list[tuple[Known, str]],
) -> None:
    named = {(known.segment.ee, known.segment.name): known for known, _ in sentences}
    found = {name: touched_nothing(known, ee) for (ee, name), known in named.items()}
    assert not found["MoveObjTo"]
    assert not found["TouchWith"]
    assert found["PostureChange"]


def test_a_hand_that_waves_goes_to_and_fro_and_one_that_drinks_does_not(
    sentences: list[tuple[Known, str]],
) -> None:
    counts = {
        (known.capture.name, int(found[1]))
        for known, sentence in sentences
        if (found := re.search(r"turned back (\d+) times", sentence))
    }
    waved = waving().name
    assert max(count for name, count in counts if name == waved) >= 5
    assert all(count < 3 for name, count in counts if name != waved)
