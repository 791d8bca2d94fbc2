"""What rule authors may ask of a segment agrees with streams and contacts."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import motions
import numpy as np
import pytest

from capar.model.capture import Capture
from capar.model.facts import Touching
from capar.model.observation import Segment
from capar.pipelines.explanation import Explained, explained
from capar_rules.engine.profiles import Profile, profile
from capar_rules.explain.sentences import parsed

WORDS = (
    "lasts_ms(S,A)", "contact_ms(S,A,B,C)", "mean_mm_s(S,A,B)", "borne_at(S,A,B,C)",
    "touches_with(S,A,B,C)", "toward_performer(S,A)", "from_performer(S,A)", "swing_count(S,A)",
)  # fmt: skip
"""Words that are stated of each segment of which they hold, by ``also``."""


def stating(folder: Path) -> Profile:
    """The extended rules with a file that has every circumstance stated beside the name."""
    path = folder / "stating.lp"
    lines = (f"also(named(S,N), {word}) :- named(S,N), {word}.\n" for word in WORDS)
    path.write_text('%* Stating: what holds. *%\nprimitive("Stating").\n' + "".join(lines))
    return replace(profile("extended"), added=(path,))


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
    orientations = np.tile(hand.stream.orientations[0], (count, 1))
    stream = replace(hand.stream, positions=positions, orientations=orientations)
    sensors = tuple(
        replace(each, stream=stream) if each.name == hand.name else each for each in capture.sensors
    )
    return replace(capture, sensors=sensors)


@pytest.fixture(scope="module")
def stated(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[tuple]]:
    rules = stating(tmp_path_factory.mktemp("rules"))
    captures = {"drink": motions.drink_from_mug(motions.TALL_MAN).capture, "wave": waving()}
    return {
        name: list(_stated(explained(capture, rules=rules))) for name, capture in captures.items()
    }


def _stated(seen: Explained) -> Iterator[tuple[Explained, Segment, str, list[str]]]:
    for segment, told in zip(
        seen.observation.segments, seen.explain(seen.observation.segments), strict=True
    ):
        for reason in told.reason.walk():
            predicate, arguments = parsed(reason.atom)
            if any(word.startswith(f"{predicate}(") for word in WORDS):
                yield seen, segment, predicate, arguments


def test_durations_and_speeds_are_those_of_the_streams(stated):
    for seen, segment, predicate, arguments in stated["drink"]:
        frames = slice(segment.first, segment.last + 1)
        duration = (segment.last - segment.first) / seen.observation.rate_hz
        if predicate == "lasts_ms":
            assert int(arguments[1]) == pytest.approx(1000.0 * duration, abs=11)
        if predicate == "mean_mm_s":
            steps = np.diff(seen.measures.body(arguments[1]).middles[frames], axis=0)
            way = float(np.linalg.norm(steps, axis=1).sum())
            assert int(arguments[2]) == pytest.approx(1000.0 * way / duration, abs=30)
        if predicate == "contact_ms":
            contacts = [
                1000.0 * (fact.last - fact.first) / seen.observation.rate_hz
                for fact in seen.observation.facts
                if isinstance(fact, Touching)
                and (fact.body, fact.other) == (segment.ee, arguments[2])
            ]
            assert min(abs(int(arguments[3]) - one) for one in contacts) < 11


def test_who_comes_nearer_to_the_performer_does_and_what_bears_is_below(stated):
    known = set()
    for seen, segment, predicate, arguments in stated["drink"]:
        known.add(predicate)
        ends = [segment.first, segment.last]
        if predicate in ("toward_performer", "from_performer"):
            away = seen.measures.body(arguments[1]).middles - seen.measures.body("head").middles
            first, last = np.linalg.norm(away[ends], axis=1)
            assert (first - last > 0.095) == (predicate == "toward_performer")
        if predicate == "borne_at":
            frame = ends[arguments[1] == "end"]
            load, bearer = (seen.measures.body(one).middles[frame, 2] for one in arguments[2:])
            assert load > bearer
    assert {"toward_performer", "from_performer", "borne_at", "touches_with"} <= known


def test_a_hand_that_waves_goes_to_and_fro_and_one_that_drinks_does_not(stated):
    counts = {
        name: [
            int(arguments[1]) for _, _, predicate, arguments in rows if predicate == "swing_count"
        ]
        for name, rows in stated.items()
    }
    assert max(counts["wave"]) >= 5
    assert all(count < 3 for count in counts["drink"])
