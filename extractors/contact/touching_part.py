"""Which part of an end-effector it touches something with, where several sensors ride on it."""

from extractors.bodies.bodies import Bodies
from extractors.bodies.body_geometry import BodyGeometry
from extractors.contact.proximity import distance
from extractors.contact.touch_distances import touchable_at


def touching_part(bodies: Bodies, ee: str, other: BodyGeometry, frame: int) -> BodyGeometry:
    """The part of an end-effector that is nearest to a body at a frame; of equals the first.

    Its own body, where no part is known and has a shape at that frame.
    """
    parts = bodies.on_end_effector(ee)
    known = [each for each in parts if each.shape is not None and not each.poses.lost[frame]]
    if len(parts) == 1 or not known or other.poses.lost[frame]:
        return parts[0]
    there = touchable_at(other, frame)
    return min(known, key=lambda each: distance(touchable_at(each, frame), there, 0))
