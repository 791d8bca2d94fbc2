"""The motions of several bodies as one capture, so that they can be observed again."""

from dataclasses import replace
from pathlib import Path

from capar.body.recording import Truth, joined, write_bundle
from capar.model.capture import Capture
from capar.regeneration.captures import capture_of, truth_of_motion
from capar.regeneration.joint_regenerating import JointMotion
from capar.regeneration.sources import Source


def joint_capture_of(made: JointMotion, *, name: str) -> Capture:
    """What a tracker would have recorded, its sensors called as in the recording.

    Args:
        made: What was done.
        name: Of the capture.
    """
    captures = {
        who: capture_of(motion, name=name, agent=who) for who, motion in made.motions.items()
    }
    return joined(captures, {who: _names(one) for who, one in made.source.sources.items()})


def _names(source: Source) -> dict[str, str]:
    """What a performer's sensors were called in the recording."""
    names = {f"{side}_hand": hand.sensor for side, hand in source.hands.items()}
    heads = [sensor.name for sensor in source.capture.sensors if sensor.end_effector == "head"]
    eyes = [sensor.name for sensor in source.capture.sensors if sensor.end_effector == "eyes"]
    names |= {"head": heads[0]}
    return names | {"eyes": eyes[0] if eyes else f"{heads[0]}_eyes"}


def write_joint_motion(made: JointMotion, capture: Capture, folder: Path) -> None:
    """Write the motions' capture as a bundle, with what was planned as the truth beside it."""
    truths = []
    for who, motion in made.motions.items():
        names, truth = _names(made.source.sources[who]), truth_of_motion(motion)
        rows = [(names.get(a, a), names.get(b, b), t, u) for a, b, t, u in truth.contacts]
        truths.append(replace(truth, contacts=tuple(rows)))
    contacts = tuple(sorted({row for truth in truths for row in truth.contacts}))
    first = truths[0]
    write_bundle(capture, Truth(contacts, first.motions, first.phases, first.looks), folder)
