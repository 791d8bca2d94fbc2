"""What sliding windows see is put together as if the whole had been seen at once."""

from dataclasses import replace
from multiprocessing import active_children
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from live_runs import rig_of
from measured_bodies import pick_and_place

from capar.model.errors import CaptureError, RuleError
from capar.model.facts import (
    Gap,
    Leans,
    Moving,
    Observed,
    Pause,
    Place,
    Resting,
    Reverses,
    Touching,
)
from capar.pipelines.live.decided_until import (
    Handling,
    nameless,
    out_of_sight,
    undecided,
)
from capar.pipelines.live.frames import (
    DeviceFrames,
    FrameBuffer,
    Poses,
    body_names,
    replayed,
)
from capar.pipelines.live.ledgers import FactLedger, RuleMemory
from capar.pipelines.live.rule_process import RuleProcess, inferred
from capar_rules.engine.profiles import profile
from extractors.devices.tracker import Description, Frame
from extractors.measure import measure

FRAMES = 400


@st.composite
def contacts(draw: st.DrawFn) -> list[Touching]:
    """Contacts of one hand with two things, disjoint for each, at least a frame apart."""
    found = []
    for other in ("cup", "box"):
        ends = draw(st.lists(st.integers(0, FRAMES - 1), max_size=12, unique=True).map(sorted))
        pairs = zip(ends[::2], ends[1::2], strict=False)
        found += [Touching("hand", other, first, last) for first, last in pairs]
    return found


@given(contacts(), st.integers(5, 60), st.integers(1, 30), st.integers(0, 40))
@settings(max_examples=150, deadline=None)
def test_intervals_that_windows_cut_are_put_together_whole(
    whole: list[Touching], step: int, margin: int, more: int
) -> None:
    length = step + 2 * margin + more
    named = [Gap(each.body, each.other, each.first, 7 * each.first) for each in whole]
    instants = [Pause("hand", each.last) for each in whole]
    ledger, done = FactLedger(), []
    for now in [*range(step, FRAMES - 1, step), FRAMES - 1]:
        begin = max(0, now - length)
        seen = [_cut(each, begin, now) for each in whole if each.first <= now]
        seen = [each for each in seen if each.first <= each.last]
        gaps = [
            replace(gap, first=gap.first - begin)
            if gap.first >= begin
            else Gap(gap.body, gap.other, 0, -1)
            for gap, each in zip(named, whole, strict=True)
            if each.first <= now and each.last >= begin
        ]
        pauses = [
            Pause("hand", each.frame - begin) for each in instants if begin <= each.frame <= now
        ]
        stitched = ledger.stitched([*seen, *gaps, *pauses], begin)
        frontier = now if now == FRAMES - 1 else max(now - margin, ledger.frontier)
        done += ledger.settle(stitched, frontier)
    assert sorted(map(str, done)) == sorted(map(str, {*whole, *named, *instants}))


def test_where_a_motion_was_highest_is_taken_when_it_has_come_down_and_once() -> None:
    ledger, done = FactLedger(), list[Observed]()
    for now in range(20, 220, 10):
        facts: list[Observed] = [Moving("box", 10, min(now, 150))] if now >= 10 else []
        if now >= 130:  # only then has the box come down far enough
            facts += [Reverses("box", 80), Place("box", 80, 0, 0, 9)]
        done += ledger.settle(ledger.stitched(facts, 0), now - 10)
    assert sorted(map(str, done)) == sorted(
        ["moving(box,10,150)", "reverses(box,80)", "place(box,80,0,0,9)"]
    )


def _cut(each: Touching, begin: int, now: int) -> Touching:
    return replace(each, first=max(each.first, begin) - begin, last=min(each.last, now) - begin)


def test_the_memory_of_rules_stays_bounded_however_long_they_are_told_facts() -> None:
    memory, sizes = RuleMemory(), []
    for round_ in range(400):
        at = 100 * round_
        memory.add([Touching("hand", "cup", at, at + 40), Resting("hand", at + 50, at + 90)])
        memory.add([Place("hand", at + 90, 10 * (round_ % 7), 0, 0)])
        memory.forget(at - 500, [at], 100)
        sizes.append(len(list(memory)))
    assert max(sizes[200:]) <= max(sizes[:200])
    assert Resting("hand", 50, 90) in list(memory)


def test_only_the_last_frames_are_held() -> None:
    capture = pick_and_place()
    buffer = FrameBuffer(rig_of(capture), 50)
    frames = replayed(capture)
    for each in frames:
        buffer.push(each)
    window = buffer.window(1000)
    assert len(window.capture.times) == 50
    assert window.last == len(frames) - 1
    for name, body in window.capture.bodies.items():
        expected = capture.bodies[name].stream.positions[-50:]
        np.testing.assert_array_equal(body.stream.positions, expected)


def test_a_frame_of_other_bodies_or_of_an_earlier_time_is_refused() -> None:
    capture = pick_and_place()
    buffer = FrameBuffer(rig_of(capture), 50)
    frame = replayed(capture)[0]
    buffer.push(frame)
    with pytest.raises(CaptureError, match="does not follow"):
        buffer.push(frame)
    with pytest.raises(CaptureError, match="the rig has 3 bodies"):
        buffer.push(Poses(1.0, np.zeros((2, 3)), np.zeros((2, 4))))


def described(*names: str) -> Description:
    return Description("flock", "simulated", names, 100.0)


def frame_of(names: int, cycle: int) -> Frame:
    return Frame(0.0, None, np.full((names, 3), float(cycle)), np.ones((names, 4)), cycle)


def test_lost_cycles_of_a_tracker_are_lost_frames_on_an_even_clock() -> None:
    rig = pick_and_place()
    frames = DeviceFrames(rig, described("thing", "right_hand"), 0.01)
    got = [each for cycle in (5, 6, 9, 2) for each in frames.poses(frame_of(2, cycle))]
    assert [each.time_s for each in got] == pytest.approx([0.0, 0.01, 0.02, 0.03, 0.04, 0.05])
    moving = [name for name in body_names(rig) if "table" not in name]
    row = body_names(rig).index(moving[0])
    assert [bool(np.isnan(each.positions[row]).any()) for each in got] == [
        False, False, True, True, False, False
    ]  # fmt: skip
    assert frames.filled == 2
    table = next(index for index, name in enumerate(body_names(rig)) if "table" in name)
    assert not any(np.isnan(each.positions[table]).any() for each in got)


def test_who_holds_a_thing_that_has_not_moved_and_touches_another_is_undecided_for_a_while() -> (
    None
):
    cup, table = Touching("hand", "cup", 100, 150), Touching("hand", "table", 95, 150)

    def told(
        *moving: Moving, last: int = 150, touching: tuple[Touching, ...] = (cup, table)
    ) -> dict[str, int]:
        return undecided(Handling(touching, moving, {"cup"}, last=last, margin=15, longest=200))

    assert told() == {"hand": 95}
    assert told(touching=(cup,)) == {}
    assert told(Moving("cup", 120, 140)) == {}
    assert told(Moving("cup", 20, 60)) == {"hand": 95}
    later = (replace(cup, last=400), replace(table, last=400))
    assert told(last=400, touching=later) == {}


def test_what_has_just_tipped_is_not_announced_while_it_leans_and_for_a_while() -> None:
    own, lean = Touching("hand", "cup", 100, 400), Leans("cup", 380, 400)
    handling = Handling(
        (own,), [Moving("cup", 150, 400)], {"cup"}, last=400, margin=15, longest=200
    )
    assert nameless(handling) == {}
    tipped = replace(handling, leans=(lean,))
    assert nameless(tipped) == {"hand": 380}
    assert undecided(tipped) == {}
    assert nameless(replace(tipped, leans=(Leans("cup", 350, 370),))) == {}
    assert nameless(replace(tipped, leans=(Leans("cup", 150, 400),))) == {}
    assert nameless(replace(tipped, leans=(Leans("jug", 380, 400),))) == {}


def test_the_rules_answer_the_same_from_one_process_after_the_other() -> None:
    rules = profile()
    facts = measure(pick_and_place()).facts
    asked = RuleProcess(rules, own_asks=1, asks=2)
    known = inferred(facts, rules)
    workers = set[int | None]()
    for _ in range(4):
        assert asked.ask(facts) == known
        workers |= {each.pid for each in active_children()}
    assert len(workers) >= 2
    for worker in active_children():
        worker.kill()
    assert asked.ask(facts) == known
    asked.close()
    assert not active_children()
    assert asked.ask(facts) == known


def test_a_fault_of_the_rules_is_told_by_a_worker_too(tmp_path: Path) -> None:
    added = tmp_path / "unfinished.lp"
    added.write_text("fits(Segment, :-", encoding="utf-8")
    asked = RuleProcess(profile(added=(added,)), own_asks=0)
    with pytest.raises(RuleError, match="unfinished"):
        asked.ask(measure(pick_and_place()).facts)
    assert active_children()
    asked.close()


def test_what_a_hand_does_with_a_thing_that_is_out_of_sight_is_undecided_for_a_while() -> None:
    own, other = Touching("hand", "cup", 100, 150), Touching("left", "jug", 20, 120)

    def handling(last: int, since: int) -> Handling:
        lost = {"cup": since, "jug": since}
        return Handling((own, other), (), {"cup"}, last=last, margin=15, longest=200, lost=lost)

    assert out_of_sight(handling(160, 150)) == {"hand": 150}
    assert undecided(handling(160, 150)) == {"hand": 150}
    assert handling(160, 150).sure == 149
    assert out_of_sight(handling(351, 150)) == {}
    assert handling(351, 150).sure == 351
    assert out_of_sight(handling(160, 155)) == {}
