"""No scene, motion or recording does what the audit's worlds say cannot be."""

from collections.abc import Iterator
from functools import cache
from pathlib import Path

import motions
import pytest
from motion_files import recordings_folder
from motions.uses import USES
from scenes.batteries import SOME

from capar.model.capture import Capture
from capar.model.par import UNKNOWN, FeatureSet
from capar.pipelines.observation import observe
from capar_rules.engine.profiles import profile
from capar_rules.engine.syntax import parse
from capar_rules.lint.audit import Features, evaluate, summarise
from extractors.readers.bundle.capture_toml import read_capture

EXAMPLES = Path(__file__).parents[2] / "examples"
TAKES = ("bimacs_optitrack:take0", "bimacs_optitrack:take4", "bimacs_optitrack:take5")


@cache
def possible() -> frozenset[Features]:
    """The feature sets that some world of the audit has."""
    atoms = evaluate(parse(profile("extended").files), [("possible", 4)])
    assert summarise(atoms).possible > 200
    rows = [row for name, row in atoms if name == "possible"]
    return frozenset(
        (str(start), str(end), str(change), str(force)) for start, end, change, force in rows
    )


def broken(capture: Capture) -> Iterator[str]:
    """Segments whose features no world has, and those that no rule names."""
    for link in observe(capture).links:
        for each in link.segments:
            found = each.features
            told = (found.rel_start, found.rel_end, found.change_loc, found.force)
            if (told not in possible() and not several(found)) or each.name == UNKNOWN:
                yield f"{link.ee}/{each.index} {each.name}: {told}"


def several(features: FeatureSet) -> bool:
    """Whether more than one object is in the hand: the worlds are named by the first alone."""
    count = len(features.change_loc)
    return any(bits[:count].count("1") > 1 for bits in (features.rel_start, features.rel_end))


@pytest.mark.parametrize("scene", SOME.values(), ids=SOME)
def test_no_scene_breaks_a_law_of_the_audit(scene) -> None:
    capture, _ = scene(100.0, 0.0005, 0.002, 0)
    assert list(broken(capture)) == []


@pytest.mark.parametrize("act", [*USES, motions.drink_from_mug], ids=lambda act: act.__name__)
def test_no_motion_breaks_a_law_of_the_audit(act) -> None:
    assert list(broken(act(motions.WOMAN).capture)) == []


@pytest.mark.parametrize("take", TAKES)
def test_no_recording_breaks_a_law_of_the_audit(take: str, monkeypatch) -> None:
    monkeypatch.setenv("CAPAR_DATA", str(recordings_folder()))
    assert list(broken(read_capture(f"{EXAMPLES / take}"))) == []
