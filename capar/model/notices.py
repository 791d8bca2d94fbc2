"""What a user should know about a capture that is no error: notices, with a sentence each."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from capar.model.errors import CaparError, UnknownNameError


def _long_gap(each: "Notice") -> str:
    """Of one gap as it was read, or of all of a body's, with what follows from them."""
    (body,), values = each.bodies, dict(each.values)
    if "times" not in values:
        span = "throughout" if each.start_s is None else f"from {each.start_s:.2f} s"
        return f"{body} is lost {span}" + ("" if each.end_s is None else f" to {each.end_s:.2f} s")
    if each.start_s is None:
        return f"{body!r} was lost throughout; no contact of it is known"
    often = {1: "", 2: "twice, for longest "}.get(
        int(values["times"]), f"{values['times']} times, for longest "
    )
    touched = "what touched it before and after is assumed to have touched it then"
    follows = "it is held to stay" if values["fixed"] else touched
    return f"{body!r} was lost {often}from {each.start_s:.2f} to {each.end_s:.2f} s; {follows}"


def _up_contradicted(each: "Notice") -> str:
    """Gravity or rests that the declared upward axis does not fit."""
    bodies, fields = each.bodies, each.fields
    if fields["shown"] == "rest":
        found = f"{bodies[0]!r} rests {fields['where']} {bodies[1]!r}, with nothing under it"
    else:
        found = (
            f"{bodies[0]!r} falls freely from {fields['start_s']:.2f} to {fields['end_s']:.2f} s, "
            f"{fields['angle_deg']:.0f} degrees off the declared down"
        )
    if not fields["up"]:
        return f"{found}; no axis of its file points up: level the world before it is read"
    remedy = f'state up = "{fields["up"]}" for its file'
    return f'{found}: {remedy}, which was read with "{fields["declared"]}"'


UNIT = ': state unit = "{unit}" for its file, which was read in {declared}'
UNMOVED = (
    "nothing moves {0!r} in {share:.1%} of its motion, for longest from {start_s:.2f} to "
    "{end_s:.2f} s; "
)

Value = str | int | float | bool

#: A name and what it is, such as ``("tolerance_m", 0.005)``
Field = tuple[str, Value]


@dataclass(frozen=True, slots=True)
class Notice:
    """Something about a capture that is no error and that its user ought to know."""

    code: str  #: A stable name in kebab case, of those in ``KINDS``
    bodies: tuple[str, ...] = ()  #: The bodies that it is about
    start_s: float | None = None  #: When what it says begins [s]; None where it is about no time
    end_s: float | None = None
    #: Further numbers and words, sorted by name; a unit ends the name: ``tolerance_m``
    values: tuple[Field, ...] = ()

    def __post_init__(self) -> None:
        """Check that its sentence can be made."""
        if self.code not in KINDS:
            raise UnknownNameError("kind of notice", self.code, KINDS)
        try:
            _ = self.message
        except (KeyError, IndexError, TypeError, ValueError) as error:
            raise CaparError(f"notice {self.code!r} lacks a field for its text: {error}") from None

    def __getitem__(self, name: str) -> Value:
        """The value of that name; KeyError where it has none."""
        return dict(self.values)[name]

    def __lt__(self, other: "Notice") -> bool:
        """Notices are sorted by code, bodies and time."""
        return self._order < other._order

    @property
    def _order(self) -> tuple[Any, ...]:
        times = [-1.0 if each is None else each for each in (self.start_s, self.end_s)]
        return self.code, self.bodies, *times, [(name, str(value)) for name, value in self.values]

    @property
    def message(self) -> str:
        """The notice in words."""
        kind = KINDS[self.code]
        text = kind.text[str(self[kind.by])] if isinstance(kind.text, Mapping) else kind.text
        return text.format(*self.bodies, **self.fields) if isinstance(text, str) else text(self)

    @property
    def fields(self) -> dict[str, Any]:
        """Times and values by name; lengths also in millimetres: ``touch_m`` as ``touch_mm``."""
        lengths = {f"{k[:-1]}mm": 1e3 * float(v) for k, v in self.values if k.endswith("_m")}
        listed = {"all": ", ".join(self.bodies), "count": len(self.bodies)}
        times = {"start_s": self.start_s, "end_s": self.end_s}
        return {**times, **lengths, **listed, **dict(self.values)}

    def document(self) -> dict[str, Any]:
        """Its JSON form: the fields that it has, and the message for those who read no code."""
        out: dict[str, Any] = {"code": self.code, "bodies": list(self.bodies)}
        times = {"start_s": self.start_s, "end_s": self.end_s}
        out |= {name: value for name, value in times.items() if value is not None}
        return out | {"values": dict(self.values), "message": self.message}


def notice(
    code: str,
    *bodies: str,
    start_s: float | None = None,
    end_s: float | None = None,
    **values: Value,
) -> Notice:
    """A notice about some bodies, with such values as its code needs.

    Raises:
        UnknownNameError: There is no such code.
        CaparError: A field that its sentence needs is missing.
    """
    return Notice(code, bodies, start_s, end_s, tuple(sorted(values.items())))


def read_notice(document: Mapping[str, Any]) -> Notice:
    """The notice that a JSON form states, its message made again; CaparError if it is none."""
    kinds: dict[str, tuple[Any, str]] = {
        "code": (str, "a text"),
        "bodies": (list, "a list of names"),
        "values": (dict, "names with numbers or texts"),
        "start_s": (int | float | None, "seconds"),
        "end_s": (int | float | None, "seconds"),
        "message": (str | None, "a text"),
    }
    if not isinstance(document, Mapping):
        raise CaparError(f"expected an object in braces, found {document!r}")
    for name in document:
        if name not in kinds:
            raise UnknownNameError("field of a notice", name, kinds)
    for name, (kind, expected) in kinds.items():
        if not isinstance(found := document.get(name), kind) or isinstance(found, bool):
            raise CaparError(f"{name}: expected {expected}, found {found!r}")
    parts: dict[str, Any] = {name: document.get(name) for name in ("start_s", "end_s")}
    if not all(isinstance(body, str) for body in document["bodies"]):
        raise CaparError(f"bodies: expected a list of names, found {document['bodies']!r}")
    if not all(isinstance(value, str | int | float) for value in document["values"].values()):
        raise CaparError(f"values: expected numbers or texts, found {document['values']!r}")
    return notice(document["code"], *document["bodies"], **parts, **document["values"])


@dataclass(frozen=True, slots=True)
class NoticeKind:
    """What is said of notices of a code."""

    #: A template over the bodies by number and the other fields by name, one for each value of the
    #: field ``by``, or what makes the text
    text: str | Mapping[str, str] | Callable[[Notice], str]
    #: What many of it are called; empty where it does not bear on the truth of what is told.
    #: Without one that does, what is told would be taken for more certain than it is
    several: str = ""
    #: Whether it tells of a fault of the recording, or of what was stated of it
    fault: bool = False
    #: Whether it bears on nothing but what is told of its two bodies together
    of_pair: bool = False
    by: str = ""


_HINGE = "{0!r} turns on a hinge of {1!r} about ({axis}) in its axes"
_RAIL = "{0!r} slides on a rail of {1!r} along ({axis}) in its axes"
_OFF = ", with a residual of {residual_mm:.1f} mm"
_UNCLOSED = "; no closed place of it is known"

#: Each code with its text: every sentence of a notice is here
KINDS: Mapping[str, NoticeKind] = {
    "long-gap": NoticeKind(_long_gap, "tracks with gaps"),
    "markers-not-rigid": NoticeKind(
        "{0}: {frames} frames in which its markers are not rigid are taken as lost",
        "bodies whose markers are not rigid",
    ),
    "bone-stretches": NoticeKind(
        "{0!r}: from {1!r} to {2!r} it is {shortest_m:.2f} to {longest_m:.2f} m, and bones keep "
        "their length; check the parents that capture.toml states, and the names of the file",
        "bones that change their length",
        fault=True,
    ),
    "stand-in-shape": NoticeKind("{0!r} is a stand-in: {shape}", "stand-in shapes"),
    "no-shape": NoticeKind(
        "{0!r} has no shape, so no contact of it is known", "bodies without a shape"
    ),
    "objects-left-out": NoticeKind(
        "{count} of {objects} objects have no shape and are left out: {all}",
        "groups of objects left out",
    ),
    "assumed-support": NoticeKind("{0!r} is assumed: {assumed}", "assumed supports"),
    "moving-ground": NoticeKind(
        "{0!r} goes by under the feet of {agent} at {speed_mps:.2f} m/s, as a treadmill does: feet "
        "that move with it stand",
        "grounds that go by under the feet",
    ),
    "guide": NoticeKind(
        {
            "hinge": f"{_HINGE}, open by up to {{opened_deg:.0f}} degrees{_OFF}",
            "rail": f"{_RAIL}, open by up to {{opened_mm:.0f}} mm{_OFF}",
            "pivot": f"{_HINGE}, by up to {{opened_deg:.0f}} degrees{_OFF}{_UNCLOSED}",
            "track": f"{_RAIL}, by up to {{opened_mm:.0f}} mm{_OFF}{_UNCLOSED}",
        },
        by="kind",
    ),
    "pivot-distance": NoticeKind(
        "{0!r} and {1!r} count as touching while their origins are within {distance_mm:.0f} mm",
        "pairs that touch by the distance of their origins",
        of_pair=True,
    ),
    "touch-estimated": NoticeKind(
        "{0!r} and {1!r} count as touching within {touch_mm:.0f} mm of how they were in {frames} "
        "frames of {found}",
        "pairs that touch by a distance estimated from the recording",
        of_pair=True,
    ),
    "distance-contradicted": NoticeKind(
        "{0!r} and {1!r} are stated to touch within {touch_mm:.0f} mm, but {frames} frames of sure "
        "contact show {shown_mm:.0f} mm; state that, or leave distance_m out",
        "stated distances that the recording contradicts",
        fault=True,
    ),
    "mount-gap": NoticeKind(
        "{0!r} carries {1!r} steadily in {frames} frames with a gap of {shown_mm:.0f} mm, but "
        "surfaces touch within {touch_mm:.0f} mm: a mount, a mesh or a fit is off",
        "bodies carried with a gap",
        fault=True,
    ),
    "no-mover": NoticeKind(
        {
            "nobody": UNMOVED + "nothing that is recorded was near and went with it: is a sensor "
            "missing, is the unit of a file wrong, or was it tracked wrongly?",
            "beyond_reach": UNMOVED + "something went with it beyond reach: is a mount, a distance "
            "or a unit wrong?",
            "left_behind": UNMOVED + "what touched it rested meanwhile: is a distance of contact "
            "too large, or a sensor missing?",
        },
        "objects that move and nothing moves them",
        fault=True,
        by="why",
    ),
    "contact-gap": NoticeKind(
        "{0!r} moves, and no contact of {1!r} with it was found from {start_s:.2f} to "
        "{end_s:.2f} s",
        "times without contact in which something was moved",
    ),
    "up-contradicted": NoticeKind(
        _up_contradicted, "falls and rests against the upward axis", fault=True
    ),
    "unit-contradicted": NoticeKind(
        {
            "person": "{0!r} and {1!r} of one person are {size_m:g} m apart at most" + UNIT,
            "speed": "{0!r} is faster than {speed_mps:g} m/s for a tenth of the time" + UNIT,
            "fall": "{0!r} falls with {acceleration_mps2:g} m/s2 from {start_s:.2f} to "
            "{end_s:.2f} s, not with 9.81" + UNIT,
        },
        "sizes that no person has",
        fault=True,
        by="shown",
    ),
    "order-contradicted": NoticeKind(
        "{0} and {1} turn as one, but with quaternions read as {declared} {1} strays by "
        "{stray_m:g} m in the frame of {0}, as in {stretches} stretches of a second; as {order} it "
        'does not: state order = "{order}"',
        "quaternions in another order than declared",
        fault=True,
    ),
    "fall-rate": NoticeKind(
        "{0!r} falls with {acceleration_mps2:g} m/s2 from {start_s:.2f} to {end_s:.2f} s, not with "
        "9.81: frames came at {rate_hz:g} a second, not at {declared_hz:g}; state rate_hz = "
        "{rate_hz:g} for its file, or correct its time stamps",
        "falls at another rate",
        fault=True,
    ),
    "shape-size": NoticeKind(
        "the shape of {0!r}, {shape}, is {size_m:g} m long, and {0!r} is moved by hand: state "
        'unit = "{unit}" in its shape',
        "shapes of a size that nobody handles",
        fault=True,
    ),
    "sides-exchanged": NoticeKind(
        "{0!r} is on the left of {1!r} as {2!r} looks, in {share:.0%} of what shows their sides: "
        'exchange the names, correct the gaze of {2!r}, or state handedness = "left" if the file '
        "has a left-handed world (the other way round if it is stated)",
        "pairs of right and left that are exchanged",
        fault=True,
    ),
    "nothing-acts": NoticeKind(
        'no sensor acts, so no action is told; state role = "acts" for the hands and feet that do'
    ),
    "contact-tolerance": NoticeKind(
        {
            "True": "bodies count as touching within {tolerance_mm:.1f} mm, as is stated",
            "False": "bodies count as touching within {tolerance_mm:.1f} mm, from noise at rest",
        },
        by="stated",
    ),
    "doubled-stamps": NoticeKind("{samples} samples repeat a stamp; the last of each is kept"),
    "flicker": NoticeKind(
        "{all}: {length_s:.2f} s at {start_s:.2f} s taken for {taken}, not as measured: so the "
        "fewest changes explain it"
    ),
    "no-unit": NoticeKind("the file states no unit; lengths are shown as if it were metres"),
    "offset-and-position": NoticeKind(
        "{all}: OFFSET and position channels both given; a root adds them, any other joint takes "
        "the channels alone"
    ),
    "rate-mistyped": NoticeKind(
        "rate_hz = {stated_hz:g}, but the files have {recorded_hz} frames a second; is it mistyped?"
    ),
    "rate-contradicted": NoticeKind(
        "the header states {stated_hz:g} frames a second, the time stamps {rate_hz:.4g}; "
        "the time stamps are taken"
    ),
    "frames-missing": NoticeKind(
        "the header states {stated} frames, the file holds {frames}; was it cut short?"
    ),
    "end-effector-unknown": NoticeKind(
        "{0}: end_effector {stated!r} is none of {known}, which rules know; did you mean {near!r}?"
    ),
    "sensors-grouped": NoticeKind(
        '{0!r} is one end-effector of several sensors: {sensors}; parts = "apart" tells each'
    ),
    "mesh-not-closed": NoticeKind("{0}: the mesh {mesh} is not closed, it has {edges} open edges"),
    "rule-violation": NoticeKind("{violation}"),
}
