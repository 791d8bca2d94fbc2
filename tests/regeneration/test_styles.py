"""How something is done may be another's, in another time, or by the other hand."""

import numpy as np
import pytest
from recorded_actions import recorded

from capar.pipelines.observation import observe
from capar.pipelines.round_trips import by_hand
from capar.regeneration import PlanError, capture_of, regenerate
from capar.regeneration.captures import mirrored
from capar.regeneration.styles import Kind, arc_shares, borrowed_style, mapped, own_style, paced


def test_mirrored_twice_is_as_it_was() -> None:
    capture = recorded("touch").capture
    twice = mirrored(mirrored(capture, (0.1, 0.2), 0.7), (0.1, 0.2), 0.7)
    for name, body in capture.bodies.items():
        again = twice.bodies[name].stream
        np.testing.assert_allclose(again.positions, body.stream.positions, atol=1e-9)
        turned = np.abs(np.sum(again.orientations * body.stream.orientations, axis=1))
        np.testing.assert_allclose(turned, 1.0, atol=1e-9)


def test_the_left_hand_does_what_the_right_one_did_with_the_same_things() -> None:
    source = recorded("touch")
    left = by_hand(source, "left")
    assert {hold.side for hold in left.holds} == {"left"}
    motion, found = regenerate(left, left.human, source.scene)
    assert found.passed, found.failed
    crate = source.scene.thing("crate")
    np.testing.assert_allclose(motion.plan.things["crate"].translation[0], crate.place)
    again = observe(capture_of(motion, name="left", agent="man"))
    names = {link.ee: [each.name for each in link.segments] for link in again.links}
    first = {link.ee: link.segments for link in source.observation.links}
    assert names["left_hand"] == [each.name for each in first["right_hand"]]
    assert by_hand(source, "right") is source


@pytest.mark.parametrize("duration_s", [3.5, 8.0])
def test_in_another_time_everything_takes_as_much_longer(duration_s: float) -> None:
    source = paced(recorded("touch"), duration_s)
    motion, found = regenerate(source, source.human)
    assert found.passed, found.failed
    again = observe(capture_of(motion, name="paced", agent="man"))
    assert again.complex_par.signature == source.observation.complex_par.signature
    assert motion.plan.source.times[-1] == pytest.approx(duration_s)


def test_a_borrowed_style_has_the_events_of_one_and_the_ways_of_the_other() -> None:
    source, other = recorded("drink"), recorded("drink", "woman")
    style = borrowed_style(source, other)
    hold, theirs = source.holds[0], other.holds[0]
    ends = style.hands["right"].translation[[hold.first, hold.last]]
    true = other.hands["right"].path.translation[[theirs.first, theirs.last]]
    np.testing.assert_allclose(ends, true, atol=1e-9)
    own = borrowed_style(source, source)
    for side, hand in source.hands.items():
        np.testing.assert_allclose(own.hands[side].translation, hand.path.translation, atol=1e-9)


def test_the_style_of_something_else_is_refused() -> None:
    with pytest.raises(PlanError, match="another order of events"):
        borrowed_style(recorded("drink"), recorded("touch"))


@pytest.mark.parametrize("kind", list(Kind))
def test_every_style_leads_from_the_start_to_the_goal(kind: Kind) -> None:
    source = recorded("touch")
    path = own_style(source).hands["right"][: source.holds[0].first + 1]
    start, goal = path[0], source.hands["left"].path[0]
    made = mapped(path, start, goal, kind=kind)
    np.testing.assert_allclose(made.translation[[0, -1]], [start.translation, goal.translation])
    if kind is not Kind.EVEN:
        shares = arc_shares(made.translation)
        np.testing.assert_allclose(shares, arc_shares(path.translation), atol=0.02)
    if kind in {Kind.VEL, Kind.EVEN}:
        way = np.linalg.norm(np.diff(made.translation, axis=0), axis=1).sum()
        assert way == pytest.approx(np.linalg.norm(made.translation[-1] - made.translation[0]))
