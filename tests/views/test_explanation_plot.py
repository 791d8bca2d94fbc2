"""A plot of an explanation has a panel for each quantity that its conditions compare."""

import motions
import pytest

from capar.model.errors import FileError
from capar.pipelines.explanation import Explained, explained, explanation_plot
from capar.views.explanation_plot import draw_explanation
from capar.views.explanation_text import reason_tree
from capar_rules.engine.profiles import profile


@pytest.fixture(scope="module")
def seen() -> Explained:
    return explained(motions.drink_from_mug(motions.TALL_MAN).capture, rules=profile())


def test_each_value_of_a_condition_is_marked_on_the_curve_of_its_quantity(seen: Explained):
    for told in seen.explain(seen.observation.segments):
        plot = explanation_plot(seen, told)
        marks = {
            (panel.title.split(" [")[0], mark[2]) for panel in plot.panels for mark in panel.marks
        }
        for condition in told.conditions:
            for one in condition.measures:
                if one.quantity != "duration":
                    assert (one.label, one.value_text) in marks
        for panel in plot.panels:
            for time, value, _ in panel.marks:
                on_curve = panel.values[abs(panel.times - time).argmin()]
                assert on_curve == pytest.approx(value, abs=0.3 + 0.05 * abs(value))


def test_limits_and_intervals_of_facts_are_drawn(seen: Explained):
    (moved,) = [one for one in seen.explain(seen.observation.segments) if one.index == 2]
    panels = {panel.title: panel for panel in explanation_plot(seen, moved).panels}
    contact = panels["distance of the mug from the head [mm]"]
    assert contact.held == "in contact"
    assert len(contact.bars) == 1
    assert {label for _, label in contact.limits} >= {"at most 5.0 mm"}


@pytest.mark.parametrize("suffix", [".png", ".svg", ".pdf"])
def test_the_same_explanation_is_drawn_in_the_same_bytes(seen: Explained, tmp_path, suffix: str):
    (told,) = seen.explain(seen.observation.segments[2:3])
    drawn = []
    for name in ("one", "other"):
        path = tmp_path / f"{name}{suffix}"
        draw_explanation(explanation_plot(seen, told), path)
        drawn.append(path.read_bytes())
    assert drawn[0] == drawn[1]
    with pytest.raises(FileError, match="no picture format"):
        draw_explanation(explanation_plot(seen, told), tmp_path / "why.bmp")


def test_joint_actions_are_those_that_were_observed():
    capture = motions.pick_up_with_both_hands(motions.TALL_MAN).capture
    both = explained(capture, rules=profile())
    assert both.observation.joint
    for told in both.explain(both.observation.segments):
        known = {
            joint.name
            for joint in both.observation.joint
            if (told.ee, told.index) in zip(joint.ees, joint.segments, strict=True)
        }
        lines = [each.sentence for each in reason_tree(told, both.observation).because]
        stated = {line.split(": ")[1].split(",")[0] for line in lines if "one action of" in line}
        assert stated == known
