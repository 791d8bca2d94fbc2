"""The schema of an evaluation file: which captures are held against which labels, and how."""

# ruff: noqa: RUF012  (pydantic copies the defaults of fields)

from typing import Annotated, Literal

from extractors.readers.schema.bodies import Positive
from extractors.readers.schema.entry import Entry, key


class ContactArrays(Entry):
    """Labels of contact as an array of an NPZ file: a value for each frame and body."""

    labels: Annotated[str, key("Array of labels: (frames, bodies).")]
    bodies: Annotated[str, key("Array of the bodies' names.")]
    other: Annotated[str, key("What they touch; {...} stands for the take's words.")]
    touching: Annotated[int, key("The value of a frame in which a body touches it.")] = 1
    open: Annotated[int | None, key("The value of a frame that is not to be counted.")] = None


class CarryOptions(Entry):
    """How carries are found in what was observed, and what they are held against."""

    names: Annotated[
        list[str], key("Names of segments in which an object is carried, or what they specialise.")
    ] = ["MoveObj", "MoveObjTo"]
    within_s: Annotated[Positive, key("An end this near to the label is found.", unit="s")] = 0.1
    moves_m: Annotated[
        Positive, key("What moves less than this in its carry is excluded.", unit="m")
    ] = 0.001
    presence_of: Annotated[
        str,
        key(
            "Name under ``[files]`` of a recording that has each object while it is carried, and "
            "at no other time: its first and last pose are the labels."
        ),
    ] = ""
    hand: Annotated[
        str,
        key("The sensor that carries, where ``presence_of`` is given: it goes with the object."),
    ] = ""
    extend_s: Annotated[
        Positive,
        key("How long the object rests before its first and after its last pose.", unit="s"),
    ] = 2.0


class ContainerOptions(Entry):
    """Containers, into which objects are told to go or not."""

    names: Annotated[list[str], key("Objects that are containers.")]
    halves: Annotated[
        bool, key("Whether each is parted across its middle into two containers.")
    ] = False


class EvaluationFile(Entry):
    """Captures, labels, and what the labels are about."""

    kind: Annotated[
        Literal["actions", "contacts", "carries", "events", "containers"],
        key("What the labels are about."),
    ]
    capture: Annotated[str, key("A bundle, relative to this file.")] = "capture.toml"
    takes: Annotated[list[str], key("Patterns of the takes' names.")] = ["*"]
    labels: Annotated[
        str | None,
        key(
            "The label file, relative to this one; {take} and other words of the take are filled "
            "in, ${NAME} is an environment variable."
        ),
    ] = None
    mapping: Annotated[str | None, key("Actions: the mapping file, relative to this one.")] = None
    frames_of: Annotated[str, key("File of the capture whose frames the labels count.")] = ""
    contradictions: Annotated[
        Literal["refuse", "leave-out"],
        key("What to do about marks that end before they start or overlap."),
    ] = "refuse"
    events: Annotated[
        list[str], key("Events: what counts if found and not labelled; else what is labelled.")
    ] = []
    names: Annotated[dict[str, str], key("The label files' name of a body = ours.")] = {}
    groups: Annotated[
        dict[str, list[str]], key("Patterns of takes that are also scored on their own, by name.")
    ] = {}
    contacts: Annotated[
        ContactArrays | None, key("Contacts: labels that are arrays of an NPZ file.")
    ] = None
    carries: Annotated[CarryOptions | None, key("Carries: how they are found.")] = None
    containers: Annotated[
        ContainerOptions | None, key("Containers: which; the poses of objects are the labels.")
    ] = None
