"""Names of joints and markers are known however files spell them, whoever's they are."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from marker_people import walker, write_trc
from scipy.spatial.transform import Rotation

from capar.pipelines.observation import observe
from extractors.readers.bundle.capture_toml import read_capture
from extractors.readers.drafting.draft import EDIT, draft
from extractors.readers.names import (
    SIDES,
    body_names,
    conventions,
    key_of,
    recognise,
)
from extractors.readers.registry import read_recording

SPELLINGS: dict[str, Callable[[str], str]] = {
    "as it stands": lambda name: name,
    "a subject": lambda name: f"Subject1:{name}",
    "a subject and an underscore": lambda name: f"Anna_{name}",
    "a subject with a space": lambda name: f"Skeleton 001_{name}",
    "a rig without a separator": lambda name: f"mixamorig{name}",
    "capitals": str.upper,
    "small letters": str.lower,
    "an ending": lambda name: f"{name}_study",
}
LANDMARKS = {
    "rizzoli": {"SHO": "AC", "ELB": "EL", "WRA": "RS", "WRB": "US", "ASI": "ASIS", "PSI": "PSIS",
                "KNE": "LFE", "ANK": "LM", "HEE": "CA", "TOE": "SMH", "MT5": "VMH"},
    "bony_landmarks": {"SHO": "_SAE", "ELB": "_HLE", "WRA": "_RSP", "WRB": "_USP", "ASI": "_IAS",
                       "PSI": "_IPS", "KNE": "_FLE", "ANK": "_FAL", "HEE": "_FCC", "TOE": "_FM2",
                       "MT5": "_FM5"},
    "opensim": {"SHO": "ACR", "ELB": "LEL", "WRA": "FAradius", "WRB": "FAulna", "ASI": "ASI",
                "PSI": "PSI", "KNE": "LFC", "ANK": "LMAL", "HEE": "CAL", "TOE": "TOE",
                "MT5": "MT5"},
    "motive_markers": {"SHO": "ShoulderTop", "ELB": "ElbowOut", "WRA": "WristIn",
                       "WRB": "WristOut", "FIN": "HandOut", "KNE": "KneeOut", "ANK": "AnkleOut",
                       "HEE": "Heel", "TOE": "ToeTip", "MT5": "ToeOut", "ASI": "IAS",
                       "PSI": "IPS"},
    "body25": {"SHO": "Shoulder", "ELB": "Elbow", "WRA": "Wrist", "ASI": "Hip", "KNE": "Knee",
               "ANK": "Ankle", "HEE": "Heel", "TOE": "BigToe", "MT5": "SmallToe", "FHD": "Eye",
               "BHD": "Ear"},
}  # fmt: skip
"""What other sets call the Plug-in Gait markers of a side."""

WORDS: dict[str, Callable[[str], str]] = {
    "hip_knee_ankle": lambda place: {
        "thigh": "{Side}Hip", "shank": "{Side}Knee", "foot": "{Side}Ankle", "toes": "{Side}Toe",
        "upper_arm": "{Side}Shoulder", "forearm": "{Side}Elbow", "hand": "{Side}Wrist",
    }[place],
    "asf_amc": lambda place: {
        "thigh": "{s}femur", "shank": "{s}tibia", "foot": "{s}foot", "toes": "{s}toes",
        "upper_arm": "{s}humerus", "forearm": "{s}radius", "hand": "{s}wrist",
    }[place],
    "biped": lambda place: {
        "thigh": "Bip01_{S}_Thigh", "shank": "Bip01_{S}_Calf", "foot": "Bip01_{S}_Foot",
        "toes": "Bip01_{S}_Toe0", "upper_arm": "Bip01_{S}_UpperArm",
        "forearm": "Bip01_{S}_Forearm", "hand": "Bip01_{S}_Hand",
    }[place],
    "smpl_words": lambda place: {
        "thigh": "{side}_hip", "shank": "{side}_knee", "foot": "{side}_ankle",
        "toes": "{side}_foot", "upper_arm": "{side}_shoulder", "forearm": "{side}_elbow",
        "hand": "{side}_wrist",
    }[place],
}  # fmt: skip
PLACES = ("thigh", "shank", "foot", "toes", "upper_arm", "forearm", "hand")


@pytest.mark.parametrize("spelled", SPELLINGS.values(), ids=SPELLINGS)
def test_every_convention_is_known_in_every_spelling(spelled: Callable[[str], str]) -> None:
    for name, convention in conventions().items():
        if spelled("") == "mixamorig" and len({each[0] for each in convention.points}) == 1:
            continue  # the rig would take with it what its own names begin with
        files = {spelled(each): each for each in (*convention.points, *convention.on)}
        found = body_names(files)
        lost = [file for file in files if file not in found]
        assert len(lost) <= 0.05 * len(files), (name, lost)
        places = convention.named(files)
        assert all(places[file] == convention.points[files[file]] for file in places)
        assert len(places) >= 0.95 * len(convention.points), name


def test_names_of_two_places_that_one_key_would_join_are_kept_apart() -> None:
    for convention in conventions().values():
        table = convention.points | convention.on
        for key, name in convention.keys.items():
            assert {table[each] for each in table if key_of(each) == key} == {table[name]}


@pytest.mark.parametrize("wanted", WORDS)
def test_a_skeleton_is_known_by_its_joints_among_others(wanted: str) -> None:
    names = [
        WORDS[wanted](place).format(S=side[0].upper(), s=side[0], Side=side.title(), side=side)
        for side in SIDES
        for place in PLACES
    ]
    extra = ["spine", "prop_1"]
    found = recognise([*names, *extra])
    assert found.name == wanted
    assert [found.named(names)[name] for name in names] == [
        f"{side}_{place}" for side in SIDES for place in PLACES
    ]


@pytest.mark.parametrize("wanted", LANDMARKS)
@pytest.mark.parametrize(
    "unit, scale, up", [("mm", 1000.0, "z"), ("m", 1.0, "y"), ("cm", 100.0, "z")]
)
def test_a_walk_under_other_names_units_and_axes_is_drafted_as_one(
    wanted: str, unit: str, scale: float, up: str, tmp_path: Path
) -> None:
    turn = Rotation.identity() if up == "z" else Rotation.from_euler("x", -90.0, degrees=True)
    rng = np.random.default_rng(1)
    markers = {}
    for name, places in walker().items():
        if name[1:] in LANDMARKS[wanted]:
            seen = scale * turn.apply(places)
            first = rng.integers(0, len(seen) - 12)
            seen[first : first + 8] = np.nan
            markers[f"Subject1:{name[0]}{LANDMARKS[wanted][name[1:]]}"] = seen
    write_trc(tmp_path / "walk.trc", markers, unit)
    text = draft([read_recording(tmp_path / "walk.trc")], tmp_path, "walk")
    (tmp_path / "capture.toml").write_text(text)
    assert EDIT not in text
    assert f'up = "{up}"' in text
    capture = read_capture(tmp_path)
    assert {each.name for each in capture.objects} == {"floor"}
    seen = observe(capture)
    steps = {
        link.ee: sum(each.name in {"Step", "Walk"} for each in link.segments)
        for link in seen.links
        if link.ee.endswith("foot")
    }
    assert steps == {"right_foot": 2, "left_foot": 3}
    assert not {each.name for each in seen.segments} & {"Kick", "HandOver", "Give", "Receive"}


def test_two_people_whose_names_have_no_colon_are_two_agents(tmp_path: Path) -> None:
    markers = {f"Anna_{name}": 1000.0 * at for name, at in walker().items()}
    aside = np.array([0.0, 2.0, 0.0])
    markers |= {f"Bert_{name}": 1000.0 * (at + aside) for name, at in walker().items()}
    write_trc(tmp_path / "walk.trc", markers)
    text = draft([read_recording(tmp_path / "walk.trc")], tmp_path, "walk")
    (tmp_path / "capture.toml").write_text(text)
    assert [each.name for each in read_capture(tmp_path).agents] == ["anna", "bert"]
