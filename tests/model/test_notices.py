"""A notice is a value; its sentence is made from its fields, and nothing reads sentences back."""

import json
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from capar.model.errors import CaparError, UnknownNameError
from capar.model.notices import KINDS, Notice, notice, read_notice

ROOT = Path(__file__).parents[2]
ONE_OF_EACH = {
    notice("contact-tolerance", tolerance_m=0.0051, stated=False):
        "bodies count as touching within 5.1 mm, from the sensors' noise at rest",
    notice("contact-tolerance", tolerance_m=0.01, stated=True):
        "bodies count as touching within 10.0 mm, as the capture states",
    notice("pivot-distance", "hand", "mug", distance_m=0.12):
        "'hand' and 'mug' count as touching while their origins are within 120 mm",
    notice("touch-estimated", "hand", "mug", touch_m=0.0312, found="co-motion", frames=80):
        "'hand' and 'mug' count as touching within 31 mm of how they were in 80 frames in which "
        "one travels and is steady in the other's frame",
    notice("distance-contradicted", "hand", "mug", touch_m=0.05, shown_m=0.12, frames=80):
        "'hand' and 'mug' are stated to touch within 50 mm, but 80 frames of sure contact show "
        "120 mm; state that, or leave distance_m out",
    notice("mount-gap", "hand", "mug", touch_m=0.005, shown_m=0.0304, frames=80):
        "'hand' carries 'mug' steadily in 80 frames with a gap of 30 mm, but surfaces touch "
        "within 5 mm: a mount, a mesh or a fit is off",
    notice("no-mover", "mug", start_s=1.0, end_s=2.5, share=0.25, times=2, why="nobody"):
        "nothing moves 'mug' in 25.0 % of its motion, from 1.00 to 2.50 s, the longest of 2 times; "
        "nothing that is recorded was near and went with it: is a sensor missing, is the unit of "
        "a file wrong, or was it tracked wrongly?",
    notice("contact-gap", "mug", "hand", start_s=1.0, end_s=2.5, called="right hand"):
        "'mug' moves, and no contact of 'hand' with it was found from 1.00 to 2.50 s",
    notice("up-contradicted", "ball", start_s=1.0, end_s=1.5, shown="fall", angle_deg=90.0, up="y",
           declared="z"):
        "'ball' falls freely from 1.00 to 1.50 s, 90 degrees off the declared down: "
        'state up = "y" for its file, which was read with "z"',
    notice("up-contradicted", "ball", start_s=1.0, end_s=1.5, shown="fall", angle_deg=41.0, up="",
           declared="z"):
        "'ball' falls freely from 1.00 to 1.50 s, 41 degrees off the declared down; "
        "no axis of its file points up: level the world before it is read",
    notice("up-contradicted", "mug", "table", shown="rest", where="under", up="-z", declared="z"):
        "'mug' rests under 'table', with nothing under it: "
        'state up = "-z" for its file, which was read with "z"',
    notice("unit-contradicted", "head", "foot", start_s=1.0, end_s=1.0, shown="person", size_m=0.14,
           unit="cm", declared="mm"):
        "'head' and 'foot' of one person are 0.14 m apart at most: "
        'state unit = "cm" for its file, which was read in mm',
    notice("unit-contradicted", "hand", shown="speed", speed_mps=900.0, unit="mm", declared="m"):
        "'hand' is faster than 900 m/s for a tenth of the time: "
        'state unit = "mm" for its file, which was read in m',
    notice("unit-contradicted", "ball", start_s=1.0, end_s=1.5, shown="fall",
           acceleration_mps2=9810.0, unit="mm", declared="m"):
        "'ball' falls with 9810 m/s2 from 1.00 to 1.50 s, not with 9.81: "
        'state unit = "mm" for its file, which was read in m',
    notice("fall-rate", "ball", start_s=1.0, end_s=1.5, acceleration_mps2=39.2, rate_hz=60.0,
           declared_hz=120.0):
        "'ball' falls with 39.2 m/s2 from 1.00 to 1.50 s, not with 9.81: frames came at 60 a "
        "second, not at 120; state rate_hz = 60 for its file, or correct its time stamps",
    notice("shape-size", "mug", shape="mug.obj", size_m=110.0, unit="mm"):
        "the shape of 'mug', mug.obj, is 110 m long, and 'mug' is moved by hand: "
        'state unit = "mm" in its shape',
    notice("sides-exchanged", "right_hand", "left_hand", "head", share=0.97):
        "'right_hand' is on the left of 'left_hand' as 'head' looks, in 97% of what shows their "
        "sides: exchange the names, correct the gaze of 'head', or state handedness = \"left\" if "
        "the file has a left-handed world (the other way round if it is stated)",
    notice("order-contradicted", "Hand", "Mug", declared="xyzw", order="wxyz", stray_m=0.14,
           stretches=3):
        "Hand and Mug turn as one, but with quaternions read as xyzw Mug strays by 0.14 m in the "
        "frame of Hand, as in 3 stretches of a second; as wxyz it does not: state order = \"wxyz\"",
    notice("no-shape", "mug"): "'mug' has no shape, so no contact of it is known",
    notice("stand-in-shape", "mug", shape="ball of {radius}"):
        "'mug' is a stand-in: ball of {radius}",
    notice("assumed-support", "table", assumed="a box"): "'table' is assumed: a box",
    notice("moving-ground", "floor", agent="guest", speed_mps=1.129):
        "'floor' goes by under the feet of guest at 1.13 m/s, as a treadmill does: feet that move "
        "with it stand",
    notice("long-gap", "mug"): "mug is lost throughout",
    notice("long-gap", "mug", start_s=0.5, end_s=0.994): "mug is lost from 0.50 s to 0.99 s",
    notice("long-gap", "mug", times=1, fixed=False):
        "'mug' was lost throughout; no contact of it is known",
    notice("long-gap", "mug", start_s=1.0, end_s=2.0, times=1, fixed=True):
        "'mug' was lost from 1.00 to 2.00 s; it is held to stay",
    notice("long-gap", "mug", start_s=1.0, end_s=2.0, times=3, fixed=False):
        "'mug' was lost 3 times, for longest from 1.00 to 2.00 s; "
        "what touched it before and after is assumed to have touched it then",
    notice("markers-not-rigid", "mug", frames=3):
        "mug: 3 frames in which its markers are not rigid are taken as lost",
    notice("bone-stretches", "hand", "wrist", "index", shortest_m=0.4, longest_m=0.7):
        "'hand': from 'wrist' to 'index' it is 0.40 to 0.70 m, and bones keep their length; "
        "check the parents that capture.toml states, and the names of the file",
    notice("objects-left-out", "a", "b", objects=9):
        "2 of 9 objects have no shape and are left out: a, b",
    notice("doubled-stamps", samples=4): "4 samples repeat a stamp; the last of each is kept",
    notice("flicker", "hand", "mug", start_s=1.0, end_s=1.1, length_s=0.1, taken="apart"):
        "hand with mug: 0.10 s at 1.00 s taken for apart, not as measured: "
        "so the fewest changes explain it",
    notice("flicker", "mug", start_s=1.0, end_s=1.1, length_s=0.1, taken="still"):
        "mug: 0.10 s at 1.00 s taken for still, not as measured: so the fewest changes explain it",
    notice("sensors-grouped", "right_foot", sensors="right_heel, right_toe"):
        "'right_foot' is one end-effector of several sensors: right_heel, right_toe; "
        "parts = \"apart\" tells each",
    notice("no-unit"): "the file states no unit; lengths are shown as if it were metres",
    notice("offset-and-position", "hip", "knee"):
        "hip, knee: OFFSET and position channels both given; a root adds them, any other joint "
        "takes the channels alone",
    notice("rate-mistyped", stated_hz=1000.0, recorded_hz="100"):
        "rate_hz = 1000, but the files have 100 frames a second; is it mistyped?",
    notice("rate-contradicted", stated_hz=250.0, rate_hz=50.0):
        "the header states 250 frames a second, the time stamps 50; the time stamps are taken",
    notice("frames-missing", stated="900", frames=12):
        "the header states 900 frames, the file holds 12; was it cut short?",
    notice("end-effector-unknown", "hand", stated="hnd", known="hand, foot", near="hand"):
        "hand: end_effector 'hnd' is none of hand, foot, which rules know; did you mean 'hand'?",
    notice("mesh-not-closed", "cup", mesh="cup.obj", edges=6):
        "cup: the mesh cup.obj is not closed, it has 6 open edges",
    notice("earlier", was="no-unit", text="the file states no unit"): "the file states no unit",
    notice("rule-violation", violation="violation(x)"): "violation(x)",
    notice("nothing-acts"):
        'no sensor acts, so no action is told; state role = "acts" for the hands and feet that do',
}  # fmt: skip


@pytest.mark.parametrize("each", ONE_OF_EACH, ids=lambda each: each.code)
def test_its_sentence_is_made_from_its_fields(each: Notice) -> None:
    assert each.message == ONE_OF_EACH[each]


def test_every_code_is_told_here() -> None:
    assert {each.code for each in ONE_OF_EACH} == set(KINDS)


@pytest.mark.parametrize("each", ONE_OF_EACH, ids=lambda each: each.code)
def test_it_comes_back_from_json(each: Notice) -> None:
    assert read_notice(json.loads(json.dumps(each.document()))) == each


@given(st.permutations(list(ONE_OF_EACH)))
def test_notices_have_one_order(shuffled: list[Notice]) -> None:
    assert sorted(shuffled) == sorted(ONE_OF_EACH)


def test_an_unknown_code_is_refused_with_those_that_there_are() -> None:
    with pytest.raises(UnknownNameError, match=r"no kind of notice 'long_gap'.*'long-gap'"):
        notice("long_gap", "mug")


@pytest.mark.parametrize(
    "make",
    [
        lambda: notice("stand-in-shape", "mug"),
        lambda: notice("stand-in-shape", shape="ball"),
        lambda: notice("pivot-distance", "mug", distance_m=0.1),
        lambda: notice("flicker", "mug", length_s=0.1, taken="still"),
    ],
)
def test_a_notice_without_what_its_sentence_needs_is_refused(make: object) -> None:
    with pytest.raises(CaparError, match="lacks a field"):
        make()  # type: ignore[operator]


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"code": 3}, "code: expected a text"),
        ({"bodies": "mug"}, "bodies: expected a list of names"),
        ({"values": []}, "values: expected names"),
        ({"start_s": "now"}, "expected seconds"),
        ({"body": "mug"}, "no field of a notice 'body'"),
    ],
)
def test_a_wrong_document_is_refused_with_what_was_expected(
    changed: dict[str, object], message: str
) -> None:
    right = notice("stand-in-shape", "mug", shape="ball").document()
    with pytest.raises(CaparError, match=message):
        read_notice({**right, **changed})


def test_no_source_matches_against_a_message() -> None:
    """Who wants a field asks for it; no pattern is laid on a notice's message."""
    reading = re.compile(
        r"re\.\w+\([^\n]*\.message|\w+\.(?:match|search|fullmatch|findall)\(\w+\.message"
        r"|\.message\.(?:split|partition|startswith|removeprefix)"
    )
    sources = [path for package in ("capar", "extractors", "capar_rules", "kb")
               for path in (ROOT / package).rglob("*.py")]  # fmt: skip
    assert len(sources) > 100
    found = [str(path) for path in sources if reading.search(path.read_text(encoding="utf-8"))]
    assert found == []
