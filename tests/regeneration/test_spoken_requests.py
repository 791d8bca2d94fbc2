"""What is asked for in words chooses a recording that holds it, or is refused with a reason."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import observations
import pytest
from bundles import DRINKING
from exit_codes import exit_code
from spoken_worlds import RATE_HZ, words, world

from capar.body.recording import Truth, write_bundle
from capar.body.scripted_actions import action_capture
from capar.model.observation import Observation
from capar.pipelines.observation import observe
from capar.pipelines.recordings import Recording, observed_actions, observed_recording
from capar.pipelines.spoken_requests import Choice, RequestError, choices, read_requests
from capar.pipelines.trials import trial_of

DRINK = observations.drink_from_mug()
BOTH = observations.pick_up_with_both_hands()


def _recording(seen: Observation, name: str = "") -> Recording:
    return replace(observed_recording(seen, Path("nowhere")), name=name or seen.capture)


def _chosen(text: str, *known: Recording, scene: str = "kitchen") -> tuple[Choice, ...]:
    asked = read_requests(text, words(), world(scene), observed_actions(known))
    return choices(asked, known)


def _refused(text: str, *known: Recording, scene: str = "demo") -> RequestError:
    with pytest.raises(RequestError) as error:
        _chosen(text, *known, scene=scene)
    assert "\n" not in str(error.value)
    return error.value


def test_a_thing_that_is_not_there_is_refused_with_those_that_are() -> None:
    error = _refused("reach for the apple", _recording(BOTH))
    assert error.why == "object"
    assert str(error) == "there is no 'apple' in the scene; there are mug, table"


def test_an_action_that_nobody_did_is_refused_with_those_that_were_done() -> None:
    error = _refused("open the mug", _recording(DRINK))
    assert error.why == "verb"
    assert "nobody was observed doing 'Open'" in str(error)
    assert "Reach" in str(error)
    assert _refused("please wash the mug", _recording(DRINK)).why == "verb"


@pytest.mark.parametrize(
    ("text", "remedy"),
    [
        ("the mug on put", "it could be"),
        ("what is on the table", "ask for an action"),
        ("don't touch the mug", "say only what to do"),
        ("", "empty"),
    ],
)
def test_words_that_are_no_request_are_refused_with_what_would_be_one(
    text: str, remedy: str
) -> None:
    error = _refused(text, _recording(DRINK))
    assert error.why == "words"
    assert remedy in str(error)


def test_of_several_recordings_the_same_is_chosen_in_whatever_order_they_are_stored() -> None:
    first, second = _recording(DRINK, "a"), _recording(DRINK, "b")
    for known in ((first, second), (second, first)):
        (choice,) = _chosen("reach for the mug", *known, scene="demo")
        assert choice.recording.name == "a"
        assert choice.others == ("b",)


def test_both_hands_are_taken_from_a_recording_of_both_hands() -> None:
    known = (_recording(DRINK, "a"), _recording(BOTH, "b"))
    (choice,) = _chosen("reach for the crate with both hands", *known, scene="crate")
    assert choice.recording.name == "b"
    (choice,) = _chosen("reach for the mug", *known, scene="demo")
    assert choice.recording.name == "a"


@pytest.mark.long
def test_what_is_asked_for_is_performed_in_the_scene_or_refused_and_nothing_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    own, out = str(tmp_path / "own"), tmp_path / "out"
    touch = action_capture("touch", rate_hz=RATE_HZ)
    write_bundle(touch, Truth((), (), (), ()), tmp_path / "own")
    where = ("--scene", str(DRINKING), "--agent", "child", "--output", str(out))
    assert exit_code(monkeypatch, "regenerate", own, "--say", "touch the apple", *where) == 2
    assert "there are mug, table" in capsys.readouterr().err
    assert not out.exists()
    assert exit_code(monkeypatch, "regenerate", own, "--say", "touch the mug", *where) == 0
    told = capsys.readouterr().out
    assert "'mug' has the part of 'crate'" in told
    assert "penetration" in told
    made = trial_of(out)
    assert {each.name for each in made.objects} == {"head", "mug", "table"}
    assert made.agent.kind == "child"
    mug = made.tag_object("mug").stream.positions
    assert np.ptp(mug, axis=0).max() < 0.001
    (seen,) = (link for link in observe(made).links if link.ee == "right_hand")
    names = [each.name for each in seen.segments if each.name != "Rest"]
    assert names == ["Reach", "Touch", "ResumePosture"]
