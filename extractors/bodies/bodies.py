"""Every body of a capture with its geometry and poses, by sensor and by object."""

from dataclasses import dataclass, replace

from capar.model.calibration import Calibration
from capar.model.capture import Capture, TagType
from extractors.bodies.body_geometry import BodyGeometry, geometry_of
from extractors.bodies.poses import Poses
from extractors.thresholds import Thresholds


@dataclass(frozen=True, eq=False)
class Bodies:
    """The bodies of one capture; an object that is also a sensor is in both."""

    sensors: dict[str, BodyGeometry]
    objects: dict[str, BodyGeometry]
    parts: dict[str, tuple[str, ...]]
    """Names of the sensors on each end-effector that several ride on, its own first."""

    def on_end_effector(self, name: str) -> tuple[BodyGeometry, ...]:
        """What rides on the end-effector that a sensor acts for: its own body, then its parts."""
        return tuple(self.sensors[part] for part in self.parts.get(name, (name,)))

    @property
    def poses(self) -> dict[str, Poses]:
        """The poses of every body by name; of an object that is also a sensor, the object's."""
        return {name: body.poses for name, body in (self.sensors | self.objects).items()}

    def without_caches(self) -> "Bodies":
        """The same bodies without what was computed of them, which takes more memory than poses."""
        return Bodies(
            {name: replace(body) for name, body in self.sensors.items()},
            {name: replace(body) for name, body in self.objects.items()},
            self.parts,
        )

    def forget_smooth_poses(self) -> None:
        """Keep no low-passed poses until they are asked for again."""
        for poses in self.poses.values():
            poses.forget()

    def named(self, name: str) -> BodyGeometry:
        """The object of that name, or else the sensor."""
        return self.objects[name] if name in self.objects else self.sensors[name]


def bodies_of(
    capture: Capture, thresholds: Thresholds, calibration: Calibration | None = None
) -> Bodies:
    """The bodies of a capture, gaps filled and noise taken out.

    Raises:
        UnknownNameError: The calibration lacks one of them.
    """
    sensors, objects = {}, {}
    for sensor in capture.sensors:
        known = calibration.sensor(sensor.name) if calibration else None
        sensors[sensor.name] = geometry_of(sensor, thresholds, known)
    for thing in capture.objects:
        known = calibration.tag_object(thing.name) if calibration else None
        sensor_of_it = next((one for one in capture.sensors if one.stream is thing.stream), None)
        if sensor_of_it and thing.tag is not TagType.FIXED:
            poses = sensors[sensor_of_it.name].poses
            objects[thing.name] = BodyGeometry(thing.name, thing.shape, poses)
        else:
            objects[thing.name] = geometry_of(thing, thresholds, known)
    wholes = {sensor.part_of for sensor in capture.sensors if sensor.part_of}
    parts = {name: tuple(part.name for part in capture.parts_of(name)) for name in sorted(wholes)}
    return Bodies(sensors, objects, parts)
