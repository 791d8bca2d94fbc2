"""The capture that ships is what a command writes, and shows what was published."""

from importlib import resources
from pathlib import Path

import pytest
from motions.drink import PUBLISHED_SHARES, STEPS
from shell import run

from capar.body.sensors import places
from capar.model.facts import LookingAt
from capar.model.observation import Observation
from capar.pipelines.observation import observe
from capar.pipelines.round_trips import observed_source, round_trips
from extractors.readers.bundle.capture_toml import read_capture

DEMO = Path(str(resources.files("capar"))) / "demo" / "drink_from_mug"
COMMAND = "capar perform drink_from_mug --rig thesis --noisy --rate 103.3"


@pytest.mark.long
def test_a_command_of_the_pages_writes_every_file_of_it_byte_for_byte(tmp_path: Path) -> None:
    run(*COMMAND.split()[1:], "--output", tmp_path / "made")
    made, shipped = (
        {each.name: each.read_bytes() for each in folder.iterdir()}
        for folder in (tmp_path / "made", DEMO)
    )
    assert made == shipped
    root = Path(__file__).parents[1]
    assert all(COMMAND in (root / page).read_text() for page in ("CONTRIBUTING.md", "docs/body.md"))


def test_it_has_the_sensors_of_the_thesis_and_only_the_right_hand_acts() -> None:
    capture = read_capture(DEMO)
    assert {each.name for each in capture.sensors} == {*places(), "eyes"}
    assert {each.name for each in capture.objects} == {"head", "mug", "table"}
    assert [each.name for each in capture.acting] == ["right_hand"]
    assert capture.rate_hz == pytest.approx(103.3, abs=0.01)


def said(seen: Observation) -> list[str]:
    """What each step is called, or is a kind of, by the names of the thesis."""
    (link,) = seen.links
    known = [each for each in link.segments if each.name != "Rest"]
    return [next(n for n in (each.name, *each.general) if n in STEPS) for each in known]


@pytest.mark.parametrize("rules", ["thesis", "extended"])
def test_its_steps_and_their_shares_are_the_published_ones(rules: str) -> None:
    seen = observe(DEMO, rules=rules)
    assert said(seen) == list(STEPS)
    shares = [each.share for each in seen.complex_par.links[0].steps]
    assert shares == pytest.approx(PUBLISHED_SHARES, abs=0.02)
    assert not [each for each in seen.notices if each.code != "contact-tolerance"]


def test_the_head_looks_at_the_mug_before_the_hand_has_it() -> None:
    seen = observe(DEMO)
    reach = next(each for each in seen.segments if each.name == "Reach")
    looks = [each for each in seen.facts if isinstance(each, LookingAt)]
    assert {each.sensor for each in looks} == {"head"}
    during = [each for each in looks if each.first < reach.last and each.last > reach.first]
    assert "mug" in {each.object for each in during}


@pytest.mark.long
def test_man_and_child_do_it_again_with_every_gate() -> None:
    """So does a woman, by the command of docs/body.md (test_readme.py)."""
    trips = list(round_trips(observed_source(DEMO), ("man", "child")))
    assert [(each.agent, each.refused, each.failed) for each in trips] == [
        (who, "", ()) for who in ("man", "child")
    ]
    assert all(each.passed for each in trips)
