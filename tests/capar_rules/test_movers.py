"""Whatever moves has a mover: each kind of evidence by a story, and none where there is none."""

import pytest

from capar.model.facts import Displaced, read_fact
from capar_rules.movers.movers import movers

SCENE = """
frames(0,400) rate_mhz(100000) link(right_hand,hand,right) link(left_hand,hand,left)
tag(mug,mobile) tag(tray,mobile) tag(lid,mobile) tag(table,fixed)
"""
MOVES = "displaced(mug,100,200) travels(mug,110,190)"
HELD = "touching(right_hand,mug,90,210) moves_with(mug,right_hand,100,200,0)"
TRAY = (
    "displaced(tray,100,200) touching(right_hand,tray,90,210) moves_with(tray,right_hand,100,200,0)"
)

CARRIED_TRAY = "moved_by(tray,right_hand,carried,100,200)"

STORIES = {
    "A hand holds the mug and goes with it.": (
        f"{MOVES} {HELD}",
        ["moved_by(mug,right_hand,carried,100,200)"],
    ),
    "The hand goes with it, 30 mm from touching it: the mount is off by a little.": (
        f"{MOVES} moves_with(mug,right_hand,100,200,30)",
        ["moved_by(mug,right_hand,carried,100,200)"],
    ),
    "A forearm goes with it 60 mm away, but the hand touches it: the hand carries.": (
        f"{MOVES} {HELD} moves_with(mug,left_hand,100,200,60)",
        ["moved_by(mug,right_hand,carried,100,200)"],
    ),
    "The hand goes with it 300 mm away: nobody can carry that.": (
        f"{MOVES} moves_with(mug,right_hand,100,200,300)",
        ["moved_by(mug,beyond_reach,unknown,100,200)"],
    ),
    "The hand touches it and goes otherwise: it pushes.": (
        f"{MOVES} touching(right_hand,mug,90,210)",
        ["moved_by(mug,right_hand,pushed,100,200)"],
    ),
    "The hand rests beside it while it leaves: the hand does not move it.": (
        f"{MOVES} touching(right_hand,mug,90,210) resting(right_hand,0,400)",
        [
            "moved_by(mug,left_behind,unknown,110,190)",
            "moved_by(mug,right_hand,pushed,100,109)",
            "moved_by(mug,right_hand,pushed,191,200)",
        ],
    ),
    "It stands on a tray that a hand carries: it goes along.": (
        f"{MOVES} {TRAY} moves_with(mug,tray,100,200,3)",
        ["moved_by(mug,tray,along,100,200)", CARRIED_TRAY],
    ),
    "It stands on a tray that moves by itself: neither has a mover.": (
        f"{MOVES} displaced(tray,100,200) moves_with(mug,tray,100,200,3) "
        "moves_with(tray,mug,100,200,3)",
        ["moved_by(mug,nobody,unknown,100,200)", "moved_by(tray,nobody,unknown,100,200)"],
    ),
    "A tray that a hand carries hits it, and it goes otherwise.": (
        f"{MOVES} {TRAY} touching(tray,mug,90,210)",
        ["moved_by(mug,tray,through,100,200)", CARRIED_TRAY],
    ),
    "A tray at rest is touched by it: what rests moves nothing.": (
        f"{MOVES} touching(tray,mug,90,210)",
        ["moved_by(mug,nobody,unknown,100,200)"],
    ),
    "It is thrown, and flies.": (
        "displaced(mug,100,200) touching(right_hand,mug,90,140) flies(mug,141,200)",
        ["moved_by(mug,mug,set_going,141,200)", "moved_by(mug,right_hand,pushed,100,140)"],
    ),
    "It is pushed and slides on for 0.3 s.": (
        "displaced(mug,100,170) touching(right_hand,mug,90,140)",
        ["moved_by(mug,mug,set_going,141,170)", "moved_by(mug,right_hand,pushed,100,140)"],
    ),
    "It is pushed and goes on for 1.6 s, which friction would not let it.": (
        "displaced(mug,100,300) touching(right_hand,mug,90,140)",
        ["moved_by(mug,nobody,unknown,141,300)", "moved_by(mug,right_hand,pushed,100,140)"],
    ),
    "It is pushed and rolls on for as long.": (
        "displaced(mug,100,300) touching(right_hand,mug,90,140) rolls(mug,120,300)",
        ["moved_by(mug,mug,set_going,141,300)", "moved_by(mug,right_hand,pushed,100,140)"],
    ),
    "It hangs from the table, is pushed, and swings on.": (
        "displaced(mug,100,300) touching(right_hand,mug,90,140) swings(mug,120,300) "
        "touching(mug,table,0,400)",
        ["moved_by(mug,mug,set_going,141,300)", "moved_by(mug,right_hand,pushed,100,140)"],
    ),
    "It is pushed, and goes to and fro in the air: nothing swings there by itself.": (
        "displaced(mug,100,300) touching(right_hand,mug,90,140) swings(mug,120,300)",
        ["moved_by(mug,nobody,unknown,141,300)", "moved_by(mug,right_hand,pushed,100,140)"],
    ),
    "It swings to and fro, and nobody ever set it going.": (
        f"{MOVES} swings(mug,100,200)",
        ["moved_by(mug,nobody,unknown,100,200)"],
    ),
    "It slides on out of a hand, and strikes a lid that touches it back.": (
        "displaced(mug,100,170) moves_with(mug,left_hand,100,140,0) displaced(lid,160,170) "
        "touching(mug,lid,160,170) touching(lid,mug,160,170)",
        [
            "moved_by(lid,mug,through,160,170)",
            "moved_by(mug,left_hand,carried,100,140)",
            "moved_by(mug,mug,set_going,141,170)",
        ],
    ),
    "It goes with the head, which has no surface.": (
        f"{MOVES} moves_with(mug,head,100,200,120)",
        ["moved_by(mug,head,body,100,200)"],
    ),
}  # fmt: skip


def facts(text: str) -> list:
    return [read_fact(each) for each in f"{SCENE} {text}".split()]


@pytest.mark.parametrize("story", STORIES)
def test_a_motion_is_given_to_who_or_what_moves_it(story: str) -> None:
    given, expected = STORIES[story]
    found = movers(facts(given))
    assert [str(each) for each in found] == [str(read_fact(each)) for each in sorted(expected)]


@pytest.mark.parametrize("story", STORIES)
def test_every_frame_of_every_motion_is_told_of(story: str) -> None:
    given = facts(STORIES[story][0])
    found = movers(given)
    for motion in (each for each in given if isinstance(each, Displaced)):
        told = {
            frame
            for each in found
            if each.object == motion.object
            for frame in range(each.first, each.last + 1)
        }
        assert told == set(range(motion.first, motion.last + 1))
