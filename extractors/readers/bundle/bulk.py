"""Many sensors declared at once: every body of a file, shaped by one rule."""

from collections.abc import Mapping
from dataclasses import dataclass

from scipy.spatial.transform import RigidTransform

from capar.model.capture import Role, Sensor, Shape, Source, Stream
from capar.model.errors import CaptureError, UnknownNameError
from extractors.readers.bundle.bodies import Body, skeleton_frame
from extractors.readers.bundle.names import constant_name
from extractors.readers.bundle.shapes import read_shape
from extractors.readers.bundle.toml_table import Table
from extractors.readers.bundle.world import WorldRecording


@dataclass(frozen=True)
class Bulk:
    """One of many sensors: what it is, before it has a clock."""

    name: str
    end_effector: str
    side: str
    role: Role
    body: Body
    shape: Shape | None

    def sensor(self, stream: Stream) -> Sensor:
        """The sensor with its stream; each is a link of its own."""
        return Sensor(
            name=self.name,
            end_effector=self.end_effector,
            side=self.side,
            link=self.name,
            stream=stream,
            shape=self.shape,
            role=self.role,
        )


def bulk_sensors(
    table: Table, files: Mapping[str, WorldRecording], sources: list[Source]
) -> list[Bulk]:
    """The sensors of a ``[[sensors_from]]``: names are the bodies' own, in lower case.

    ``bodies`` is ``"*"`` or a list; ``sides`` gives the beginnings of names that tell sides;
    ``attends`` lists bodies that attend; ``end_effectors`` gives bodies another type.

    Raises:
        UnknownNameError: A file or body that is not there.
    """
    file = table.choice("file", files)
    recording = files[file]
    wanted = table.raw("bodies", "*")
    names = list(recording.bodies) if wanted == "*" else table.texts("bodies")
    types, sides = _words(table, "end_effectors"), _words(table, "sides")
    attends = table.texts("attends")
    for name in [*names, *types, *attends]:
        if name not in recording.bodies:
            where = table.where("bodies")
            raise UnknownNameError("body", name, recording.bodies, where=where)
    out = []
    for name in names:
        side = next((s for s, start in sorted(sides.items()) if name.startswith(start)), "none")
        stem = name.removeprefix(sides.get(side, ""))
        body = _body(recording, name)
        out.append(
            Bulk(
                name=constant_name(name),
                end_effector=types.get(name, constant_name(stem)),
                side=side,
                role=Role.ATTENDS if name in attends else Role.ACTS,
                body=body,
                shape=_shape(table, body, sources),
            )
        )
    table.raw("extend")
    table.close()
    return out


def _body(recording: WorldRecording, name: str) -> Body:
    stream = recording.bodies[name]
    frame = skeleton_frame(recording, name, stream, RigidTransform.identity())
    return Body(stream, frame)


def _shape(table: Table, body: Body, sources: list[Source]) -> Shape | None:
    shape = table.table("shape")
    if shape is None:
        return None
    out = read_shape(shape, body.frame)
    sources += body.frame.sources
    return out


def _words(table: Table, key: str) -> dict[str, str]:
    inner = table.table(key)
    if inner is None:
        return {}
    out = {each: inner.text(each) for each in inner.given()}
    if key == "sides" and set(out) - {"left", "right"}:
        raise CaptureError(f"{table.where(key)}: sides are left and right, not {sorted(out)}")
    return out
