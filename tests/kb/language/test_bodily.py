"""A body walks, and works with its hands: feet, elbows and shoulders are not told one by one."""

import re
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from observations import MUG, TABLE, Piece, observation

from capar.model.facts import Touching
from capar.model.locations import sampled_track
from capar.model.observation import Observation
from capar.model.par import FeatureSet
from kb.language.describe import describe

OWN = FeatureSet("1", "1", "1", "hand", "0")
FLOOR = replace(TABLE, name="floor", kind="floor")
WALKED = {
    "right_foot": (("Step", 50), ("Stand", 120), ("Step", 170), ("Stand", 400)),
    "left_foot": (("Stand", 60), ("Step", 110), ("Stand", 400)),
}
WORKED = (("Reach", 200), ("Lift", 300), ("ResumePosture", 400))


def seen(links: Mapping[str, tuple[tuple[str, int], ...]], way_m: float) -> Observation:
    """What parts of a body did within four seconds, whose feet go so far with each step."""
    pieces = {
        ee: tuple(
            Piece(
                name,
                end,
                ("floor" if ee.endswith("foot") else "mug",),
                features=OWN if name == "Lift" else None,
            )
            for name, end in parts
        )
        for ee, parts in links.items()
    }
    touch = Touching("right_hand", "mug", 200, 300)
    made = observation("Body", pieces, (MUG, FLOOR), facts=(touch,), frames=401, rate_hz=100.0)
    own = tuple(
        replace(
            link,
            segments=tuple(replace(each, possessed=each.name == "Lift") for each in link.segments),
        )
        for link in made.links
    )
    tracks = []
    for ee, parts in links.items():
        gone, now = np.zeros((401, 3)), 0
        for name, end in parts:
            if name == "Step":
                gone[now:, 0] += np.interp(np.arange(now, 401), (now, end), (0.0, way_m))
            now = end
        tracks.append(sampled_track(ee, 0.01, gone))
    return replace(made, links=own, tracks=tuple(tracks))


def test_steps_before_a_thing_is_taken_are_walking() -> None:
    told = describe(seen({"right_hand": WORKED, **WALKED}, 0.6), timed=True)
    assert told == (
        "The agent walked (0.00–1.74 s), lifted the mug with the right hand (2.00–3.00 s), and let "
        "go (3.00 s)."
    )


def test_who_comes_nearer_to_the_thing_walks_up_to_it() -> None:
    made = seen({"right_hand": WORKED, **WALKED}, 0.6)
    ahead = sampled_track("mug", 0.01, np.tile((1.5, 0.0, 0.8), (401, 1)))
    told = describe(replace(made, tracks=(*made.tracks, ahead)))
    assert told == (
        "The agent walked up to the mug, lifted it with the right hand, and put it down."
    )


def test_steps_on_the_spot_are_not_told_beside_what_hands_do() -> None:
    told = describe(seen({"right_hand": WORKED, **WALKED}, 0.05))
    assert told == "The agent lifted the mug with the right hand and let go."


def test_feet_alone_walk() -> None:
    assert describe(seen(WALKED, 0.6), timed=True) == "The agent walked (0.00–1.70 s)."


def test_an_elbow_that_goes_along_with_the_hand_is_not_told() -> None:
    told = describe(seen({"right_hand": WORKED, "right_elbow": WORKED}, 0.0))
    assert told == "The agent lifted the mug with the right hand and let go."


def crouching(*heights_m: float) -> str:
    """What is told of who lifts a mug from 2 to 3 s, by the pelvis's height each half second."""
    made = seen({"right_hand": WORKED}, 0.6)
    seconds = np.arange(401) / 100.0
    heights = np.interp(seconds, 0.5 * np.arange(len(heights_m)), heights_m)
    places = np.column_stack((np.zeros((401, 2)), heights))
    return describe(replace(made, tracks=(*made.tracks, sampled_track("pelvis", 0.01, places))))


def test_who_goes_down_beside_what_the_hands_do_crouches_and_stands_up() -> None:
    assert crouching(1.0, 1.0, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 1.0) == (
        "The agent crouched down, lifted the mug with the right hand, let go, and stood up."
    )


def test_who_stands_up_with_a_thing_lifts_it() -> None:
    assert crouching(1.0, 1.0, 0.5, 0.5, 0.5, 0.8, 1.0, 1.0, 1.0) == (
        "The agent crouched down, lifted the mug with the right hand, and let go."
    )


def test_who_only_stoops_does_not_crouch() -> None:
    assert crouching(1.0, 1.0, 0.8, 0.8, 0.8, 0.8, 0.8, 0.8, 1.0) == (
        "The agent lifted the mug with the right hand and let go."
    )


def test_who_bends_down_by_the_trunk_alone_is_told_to() -> None:
    made = seen({"right_hand": WORKED}, 0.6)
    seconds = np.arange(401) / 100.0
    for lowest_m, told in ((1.2, "bent down, lifted"), (1.5, "lifted")):
        heights = np.interp(seconds, (0.5, 1.5, 3.2, 3.8), (1.7, lowest_m, lowest_m, 1.7))
        places = np.column_stack((np.zeros((401, 2)), heights))
        head = sampled_track("head", 0.01, places)
        text = describe(replace(made, tracks=(*made.tracks, head)))
        assert text.startswith(f"The agent {told} the mug with the right hand")
        assert text.endswith("and straightened up.") == (lowest_m < 1.4)


def bending(times_s: tuple[float, ...], heights_m: tuple[float, ...], *, crouches: bool) -> str:
    """What is told of who lifts a mug from 2 to 3 s, by the head's height, and the pelvis's."""
    made = seen({"right_hand": WORKED}, 0.6)
    seconds = np.arange(401) / 100.0
    tracks = [("head", np.interp(seconds, times_s, heights_m))]
    if crouches:
        tracks.append(("pelvis", np.interp(seconds, (1.0, 1.8), (1.0, 0.5))))
    own = [
        sampled_track(name, 0.01, np.column_stack((np.zeros((401, 2)), heights)))
        for name, heights in tracks
    ]
    return describe(replace(made, tracks=(*made.tracks, *own)), timed=True)


def test_who_is_on_the_way_down_as_a_recording_begins_bends_from_then_on() -> None:
    text = bending((0.0, 0.8, 2.2, 2.8), (1.6, 1.1, 1.1, 1.7), crouches=False)
    assert re.search(r"^The agent bent down \(0\.00–0\.[67]\d s\), lifted the mug", text)


@pytest.mark.parametrize(
    ("last_m", "words"), [(1.45, "began to straighten"), (1.6, "straightened")]
)
def test_who_is_on_the_way_up_as_a_recording_ends_began_to_straighten_up(
    last_m: float, words: str
) -> None:
    text = bending((0.5, 1.2, 3.2, 4.0), (1.7, 1.1, 1.1, last_m), crouches=False)
    assert f", and {words} up (3." in text
    assert text.endswith("–4.00 s).")


def test_who_bends_well_before_crouching_goes_down_since_then() -> None:
    early = bending((0.2, 1.0, 1.8), (1.7, 1.3, 0.9), crouches=True)
    assert re.search(r"^The agent crouched down \(0\.[23]\d–1\.[78]\d s\), lifted", early)
    late = bending((0.9, 1.8), (1.7, 0.9), crouches=True)
    assert re.search(r"^The agent crouched down \(1\.\d\d–1\.[78]\d s\), lifted", late)


def striding(*strides: tuple[str, float, float]) -> Observation:
    """Somebody lifts a mug from 2 to 3 s; feet, of which no contact was measured, go 0.6 m each.

    Args:
        strides: Each with the foot, and from when to when it goes [s].
    """
    feet = ("left_foot", "right_foot")
    links = {"right_hand": WORKED, **dict.fromkeys(feet, (("PostureChange", 400),))}
    made = seen(links, 0.0)
    quiet = tuple(
        replace(link, segments=tuple(replace(each, objects=()) for each in link.segments))
        if link.kind == "foot"
        else link
        for link in made.links
    )
    seconds = np.arange(401) / 100.0
    tracks = [sampled_track("mug", 0.01, np.tile((1.5, 0.0, 0.8), (401, 1)))]
    for foot in feet:
        gone = np.zeros((401, 3))
        for own, first_s, last_s in strides:
            way_m = 0.6 if first_s < 2.0 else -0.6
            gone[:, 0] += np.interp(seconds, (first_s, last_s), (0.0, way_m)) * (own == foot)
        tracks.append(sampled_track(foot, 0.01, gone))
    return replace(made, links=quiet, tracks=tuple(tracks))


def test_steps_are_told_by_how_feet_go_though_their_contacts_were_missed() -> None:
    made = striding(("left_foot", 0.2, 0.8), ("right_foot", 0.8, 1.4))
    assert describe(made).startswith("The agent stepped up to the mug, lifted it with")
    made = striding(("left_foot", 0.1, 0.6), ("right_foot", 0.6, 1.1), ("left_foot", 1.1, 1.6))
    assert describe(made).startswith("The agent walked up to the mug, lifted it with")
    made = striding(("left_foot", 0.2, 0.8), ("right_foot", 1.7, 2.4))
    assert describe(made).startswith("The agent stepped up to the mug, lifted it with")


def test_who_goes_away_in_the_end_is_told_to_but_not_in_a_summary() -> None:
    made = striding(("left_foot", 3.1, 3.5), ("right_foot", 3.5, 3.9))
    assert describe(made).endswith("and stepped away.")
    assert "away" not in describe(made, detail="summary")
    made = striding(("left_foot", 3.1, 3.35), ("right_foot", 3.35, 3.6), ("left_foot", 3.6, 3.9))
    assert describe(made).endswith("and walked away.")
    assert describe(striding(("left_foot", 3.1, 3.7))).endswith("and stepped away.")


@pytest.mark.parametrize(("facing", "words"), [(1.0, "stepped back."), (-1.0, "stepped away.")])
def test_who_leaves_backwards_by_the_hips_steps_back(facing: float, words: str) -> None:
    made = striding(("left_foot", 3.1, 3.5), ("right_foot", 3.5, 3.9))
    hips = [
        sampled_track(f"{side}_hip", 0.01, np.tile((0.0, facing * y_m, 0.9), (401, 1)))
        for side, y_m in (("left", 0.1), ("right", -0.1))
    ]
    feet = [link for link in made.links if link.kind == "foot"]
    links = [replace(foot, ee=f"{foot.side}_hip", kind="hip", segments=()) for foot in feet]
    made = replace(made, links=(*made.links, *links), tracks=(*made.tracks, *hips))
    assert describe(made).endswith(f"and {words}")


def test_a_summary_tells_no_steps_to_a_thing() -> None:
    made = striding(("left_foot", 0.2, 0.8), ("right_foot", 0.8, 1.4))
    assert "stepped up" in describe(made)
    assert "stepped" not in describe(made, detail="summary")


def test_a_step_in_the_end_neither_nearer_nor_away_is_not_told() -> None:
    made = striding(("left_foot", 3.1, 3.7))
    feet = [track for track in made.tracks if track.body == "left_foot"]
    turned = sampled_track("left_foot", 0.01, feet[0].positions[:, [1, 0, 2]])
    rest = tuple(track for track in made.tracks if track.body != "left_foot")
    assert "step" not in describe(replace(made, tracks=(*rest, turned)))


@pytest.mark.parametrize(
    ("about_rad", "words"),
    [
        (0.5, "took two steps"),
        (1.8, "walked partway around the mug"),
        (2.6, "walked halfway around the mug"),
    ],
)
def test_who_goes_about_a_thing_walks_a_part_of_the_way_around_it(
    about_rad: float, words: str
) -> None:
    made = striding(("left_foot", 0.2, 0.8), ("right_foot", 0.8, 1.4))
    angles = np.interp(np.arange(401) / 100.0, (0.2, 1.4), (0.0, about_rad))
    around = 1.2 * np.column_stack((np.cos(angles), np.sin(angles), np.zeros(401)))
    feet = [
        sampled_track(foot, 0.01, around + np.array((1.5, 0.0, 0.0)))
        for foot in ("left_foot", "right_foot")
    ]
    mug = tuple(track for track in made.tracks if track.body == "mug")
    assert describe(replace(made, tracks=(*mug, *feet))).startswith(f"The agent {words}")


def test_who_straightens_up_does_so_until_the_head_rises_no_more() -> None:
    made = seen({"right_hand": WORKED}, 0.6)
    seconds = np.arange(401) / 100.0
    heights = np.interp(seconds, (0.5, 1.5, 3.1, 3.4, 3.8), (1.7, 1.2, 1.2, 1.63, 1.7))
    places = np.column_stack((np.zeros((401, 2)), heights))
    head = sampled_track("head", 0.01, places)
    told = describe(replace(made, tracks=(*made.tracks, head)), timed=True)
    found = re.search(r"straightened up \((.*)–(.*) s\)", told)
    assert found is not None
    assert 3.0 < float(found[1]) < 3.3
    assert 3.6 < float(found[2]) <= 3.8
