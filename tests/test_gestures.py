"""Motion files of people with nothing in their hands are described rightly as they are drafted."""

import re
from pathlib import Path

import gestures
import pytest

from capar.export.bvh import bvh_text
from capar.model.observation import Observation
from capar.pipelines.observation import observe
from extractors.readers.bundle.capture_toml import read_capture
from extractors.readers.drafting.draft import draft
from extractors.readers.registry import read_recording
from kb.language.describe import describe

WHO = pytest.mark.parametrize(
    ("who", "rate_hz", "side", "stance"),
    [("man", 30.0, "left", "right"), ("woman", 60.0, "right", "left"),
     ("child", 120.0, "right", "left")],
)  # fmt: skip
SKELETONS = {
    "LeftHand": {"hand": "{Side}Hand", "foot": "{Side}Foot", "forearm": "{Side}ForeArm",
                 "upper_arm": "{Side}Arm", "thigh": "{Side}UpLeg", "shank": "{Side}Leg",
                 "toes": "{Side}ToeBase", "clavicle": "{Side}Shoulder"},
    "lHand": {"hand": "{s}Hand", "foot": "{s}Foot", "forearm": "{s}ForeArm",
              "upper_arm": "{s}Shldr", "thigh": "{s}Thigh", "shank": "{s}Shin",
              "toes": "{s}Toe", "clavicle": "{s}Collar"},
    "lhand": {"hand": "{s}hand", "foot": "{s}foot", "forearm": "{s}radius",
              "upper_arm": "{s}humerus", "thigh": "{s}femur", "shank": "{s}tibia",
              "toes": "{s}toes", "clavicle": "{s}clavicle"},
}  # fmt: skip
"""What skeletons of other programs call the limbs."""


def seen(
    folder: Path, who: str, acts: gestures.Acts, rate_hz: float, *, stance: str = "left",
    names: dict[str, str] | None = None,
) -> Observation:  # fmt: skip
    """What is observed of a gesture's BVH file by its draft, unedited."""
    text = bvh_text(*gestures.motion(who, acts, rate_hz, stance=stance))
    for name, pattern in (names or {}).items():
        for side in ("left", "right"):
            own = pattern.format(Side=side.title(), s=side[0])
            text = re.sub(rf"\b{side}_{name}\b", own, text)
    (folder / "motion.bvh").write_text(text)
    drafted = draft([read_recording(folder / "motion.bvh")], folder, "gesture")
    assert "EDIT" not in drafted
    (folder / "capture.toml").write_text(drafted)
    return observe(read_capture(folder))


def steps(observation: Observation, ee: str) -> list[str]:
    """The names of an end-effector's steps but its rests."""
    (link,) = [each for each in observation.links if each.ee == ee]
    return [each.name for each in link.segments if each.name != "Rest"]


@WHO
def test_hands_that_meet_three_times_clap(
    tmp_path: Path, who: str, rate_hz: float, side: str, stance: str
) -> None:
    found = seen(tmp_path, who, gestures.clap(who), rate_hz)
    for ee in ("left_hand", "right_hand"):
        assert steps(found, ee).count("Clap") == 3
        assert set(steps(found, ee)) <= {"Clap", "Touch", "ResumePosture"}
    assert "clapped the hands three times" in describe(found)
    assert "foot" not in describe(found)


@WHO
def test_hands_that_go_up_and_come_down_are_raised_and_lowered(
    tmp_path: Path, who: str, rate_hz: float, side: str, stance: str
) -> None:
    found = seen(tmp_path, who, gestures.raised("left", "right"), rate_hz)
    assert steps(found, f"{side}_hand") == ["PostureChange"] * 2
    assert "raised both hands and lowered them" in describe(found)
    found = seen(tmp_path, who, gestures.raised(side, hold_s=0.0), rate_hz)
    assert f"raised the {side} hand for a moment" in describe(found)


@WHO
def test_a_foot_that_swings_out_and_comes_back_kicks(
    tmp_path: Path, who: str, rate_hz: float, side: str, stance: str
) -> None:
    found = seen(tmp_path, who, gestures.kick(side), rate_hz, stance=stance)
    assert steps(found, f"{side}_foot") == ["Stand", "PostureChange", "KickOut", "Step", "Stand"]
    assert describe(found) == f"The agent kicked out with the {side} foot."


def test_a_leg_that_is_put_forward_slowly_does_not_kick(tmp_path: Path) -> None:
    acts = gestures.kick("right", swing_s=1.2)
    assert "KickOut" not in steps(seen(tmp_path, "woman", acts, 60.0), "right_foot")


@WHO
def test_a_raised_hand_that_goes_to_and_fro_waves(
    tmp_path: Path, who: str, rate_hz: float, side: str, stance: str
) -> None:
    found = seen(tmp_path, who, gestures.wave(side), rate_hz)
    assert steps(found, f"{side}_hand") == ["PostureChange", "Wave", "PostureChange"]
    assert f"raised the {side} hand, waved it, and lowered it" in describe(found)
    assert not steps(found, f"{stance}_hand")


def test_both_hands_wave(tmp_path: Path) -> None:
    found = seen(tmp_path, "woman", gestures.wave("left", "right", rate_hz=2.0, angle=15.0), 60.0)
    assert "raised both hands, waved them, and lowered them" in describe(found)


def test_hands_that_push_at_nothing_are_stretched_out(tmp_path: Path) -> None:
    found = seen(tmp_path, "man", gestures.push(), 60.0)
    assert "raised both hands, stretched them out, and lowered them" in describe(found)


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_hand_at_the_own_head_touches_it(tmp_path: Path, side: str) -> None:
    found = seen(tmp_path, "woman", gestures.touch_head(side), 60.0)
    reached, *others = steps(found, f"{side}_hand")
    assert reached in {"Reach", "Salute"}
    assert others == ["TouchOneself", "ResumePosture"]
    assert "touched the head" in describe(found)


@pytest.mark.parametrize("names", SKELETONS.values(), ids=SKELETONS)
def test_limbs_are_called_left_and_right_whatever_a_file_calls_them(
    tmp_path: Path, names: dict[str, str]
) -> None:
    found = seen(tmp_path, "woman", gestures.clap("woman"), 60.0, names=names)
    assert {each.ee for each in found.links} == {
        "left_hand", "right_hand", "left_foot", "right_foot",
    }  # fmt: skip
    assert "clapped the hands three times" in describe(found)
