"""Distances between a body and the objects of a scene, and keeping limbs out of them."""

import itertools
import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache

import mink
import mujoco
import numpy as np
import trimesh
from jaxtyping import Float, Int
from scipy.spatial import ConvexHull, KDTree
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import Human, body_spec
from capar.body.recording import HAND_SEGMENTS
from capar.body.scripts import SIDES
from capar.model.capture import Shape
from capar.regeneration.scenes import Scene
from capar.regeneration.solving import vectors

NEAR_M = 0.08  # Larger distances are not measured [m].
HOLLOW = 0.98  # An object that fills a smaller share of its hull is hollow [1].
DIFFERENCE_M = 1e-6  # Step of a difference quotient of a distance [m].

SAMPLES, SPACING_M, FINE_M, SHAPES = 4000, 0.008, 0.003, 32
"""Points on the surface of a hollow object, at least, how far apart they are on a large one, also
where fingers are measured [m], and how many surfaces are kept."""


@dataclass(frozen=True, order=True)
class Pair:
    """The distance between two bodies; negative where they cut [m]."""

    distance_m: float
    part: str
    thing: str


class Surroundings:
    """A body and the objects of a scene, to be posed and measured."""

    def __init__(self, human: Human, scene: Scene) -> None:
        self.scene = scene
        spec = body_spec(human.measures, fingers=human.fingers)
        for name, thing in scene.things.items():
            hull = trimesh.convex.convex_hull(np.array(thing.shape.vertices))
            mesh = spec.add_mesh(name=f"mesh_{name}")
            mesh.uservert = np.array(hull.vertices).ravel()
            mesh.userface = np.array(hull.faces).ravel()
            mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
            body = spec.worldbody.add_body(name=f"thing_{name}", mocap=True)
            kind = mujoco.mjtGeom.mjGEOM_MESH
            body.add_geom(type=kind, meshname=mesh.name, contype=0, conaffinity=0)
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.bodies = {n: self.model.body(f"thing_{n}").mocapid[0] for n in scene.things}
        self.geoms = {n: int(self.model.body(f"thing_{n}").geomadr[0]) for n in scene.things}
        things = set(self.geoms.values())
        self.parts = {
            geom: self.model.body(int(self.model.geom_bodyid[geom])).name
            for geom in range(self.model.ngeom)
            if geom not in things
        }
        stops = {
            (part, name)
            for part in set(self.parts.values())
            for name in scene.things
            if scene.stops(part, name)
        }
        self.pairs = [
            (geom, name)
            for geom, part in self.parts.items()
            for name in self.geoms
            if (part, name) in stops
        ]
        """Shapes of the body, each with an object that stops it."""

        self.looks = 0
        """How often points on the surface of a hollow object were looked up."""

        self.watched = self.shapes(self.pairs)
        spacing_m = FINE_M if human.fingers else SPACING_M
        self.hollow = {n: _surface_points(t.shape, spacing_m) for n, t in scene.things.items()}
        self.planes = {}  # normals and offsets of the faces of hulls, each in its geom's frame
        for geom in things:
            mesh = self.model.mesh(int(self.model.geom_dataid[geom]))
            first = int(mesh.vertadr[0])
            vertices = self.model.mesh_vert[first : first + int(mesh.vertnum[0])]
            self.planes[geom] = ConvexHull(vertices).equations

    def pose(
        self, posture: Float[np.ndarray, "posture"], things: Mapping[str, RigidTransform]
    ) -> None:
        """Put the body and the objects somewhere."""
        self.place(posture, {name: vectors(pose) for name, pose in things.items()})

    def place(
        self, posture: Float[np.ndarray, "posture"], things: Mapping[str, Float[np.ndarray, "7"]]
    ) -> None:
        """Likewise, of poses as quaternions and positions."""
        self.data.qpos[:] = posture
        for name, pose in things.items():
            self.data.mocap_quat[self.bodies[name]] = pose[:4]
            self.data.mocap_pos[self.bodies[name]] = pose[4:]
        mujoco.mj_kinematics(self.model, self.data)

    def near(self, parts: Iterable[str] | None = None, within_m: float = NEAR_M) -> list[Pair]:
        """Distances of parts of the body, or of all, from the objects near them."""
        wanted, out = None if parts is None else set(parts), []
        for row in np.flatnonzero(self.at_least(self.watched) < within_m):
            geom, name = self.pairs[row]
            if wanted is None or self.parts[geom] in wanted:
                found = self.gap(geom, name, within_m)
                if found < within_m:
                    out.append(Pair(found, self.parts[geom], name))
        return out

    def shapes(self, pairs: list[tuple[int, str]]) -> Int[np.ndarray, "pairs 2"]:
        """The shapes of some pairs."""
        geoms = [(geom, self.geoms[name]) for geom, name in pairs]
        return np.array(geoms, dtype=int).reshape(-1, 2)

    def at_least(self, shapes: Int[np.ndarray, "pairs 2"]) -> Float[np.ndarray, "pairs"]:
        """What pairs are apart at least: a sphere about the first, a box about the second [m]."""
        (first, second), spots = shapes.T, self.data.geom_xpos[shapes]
        turns = self.data.geom_xmat[second].reshape(-1, 3, 3)
        local = np.einsum("pi,pij->pj", spots[:, 0] - spots[:, 1], turns)
        middle, half = np.split(self.model.geom_aabb[second], 2, axis=1)
        off = np.maximum(np.abs(local - middle) - half, 0.0)
        return np.asarray(np.linalg.norm(off, axis=1) - self.model.geom_rbound[first])

    def gap(self, geom: int, name: str, most_m: float = NEAR_M) -> float:
        """How far a shape of the body is from an object; larger distances are not measured [m]."""
        found = self._distance(geom, self.geoms[name])
        return max(found, self._apart(geom, name, most_m)) if found < 0.0 else found

    def slope(self, geom: int, name: str, most_m: float = NEAR_M) -> Float[np.ndarray, "dofs"]:
        """How that distance, which is not larger [m], changes with the body's joints."""
        mujoco.mj_comPos(self.model, self.data)
        ends = np.zeros(6)
        found = mujoco.mj_geomDistance(self.model, self.data, geom, self.geoms[name], NEAR_M, ends)
        spot, normal = ends[:3], (ends[3:] - ends[:3]) * np.sign(found)
        if found < 0.0 and self._apart(geom, name, most_m) >= found:
            spot, normal = self._nearest(geom, name, most_m)
        moves = np.empty((3, self.model.nv))
        mujoco.mj_jac(self.model, self.data, moves, None, spot, self.model.geom_bodyid[geom])
        return np.asarray(-normal / max(float(np.linalg.norm(normal)), 1e-12) @ moves)

    def things_near(self) -> list[Pair]:
        """Distances between objects near each other, but for those on a hinge or a rail."""
        joined = {frozenset(pair) for pair in self.scene.fastened.items()}
        out = []
        for first, second in itertools.combinations(sorted(self.geoms), 2):
            if frozenset((first, second)) not in joined:
                found = self._distance(self.geoms[first], self.geoms[second])
                if found < 0.0:  # of hulls: one may be in the other, which is hollow
                    apart = self._apart(self.geoms[first], second, NEAR_M)
                    found = max(found, apart, self._apart(self.geoms[second], first, NEAR_M))
                if found < NEAR_M:
                    out.append(Pair(found, first, second))
        return out

    def _distance(self, first: int, second: int) -> float:
        # The bound of a geom's sphere; mj_geomDistance of what is far apart takes as long.
        apart_m = math.dist(self.data.geom_xpos[first], self.data.geom_xpos[second])
        if apart_m - self.model.geom_rbound[first] - self.model.geom_rbound[second] > NEAR_M:
            return NEAR_M
        return float(mujoco.mj_geomDistance(self.model, self.data, first, second, NEAR_M, None))

    def _apart(self, geom: int, name: str, most_m: float) -> float:
        """How far a hollow object's surface is from a part, negative where it is inside [m].

        Or from another object's hull. Minus infinity where the object is not hollow.
        """
        if self.hollow[name] is None:
            return -np.inf
        points = self._surface(geom, name, most_m)
        if not len(points):
            return most_m
        if geom in self.planes:
            normals, offsets = self.planes[geom][:, :3], self.planes[geom][:, 3]
            return float((points @ normals.T + offsets).max(axis=1).min())
        return float(_depths(points, self.model, geom).min())

    def _nearest(
        self, geom: int, name: str, most_m: float
    ) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
        """The point of a hollow object's surface next to a part, and the way out to it [m, 1]."""
        local = self._surface(geom, name, most_m)
        point = local[int(_depths(local, self.model, geom).argmin())]
        steps = point + DIFFERENCE_M * np.concatenate([np.eye(3), -np.eye(3)])
        ahead, back = _depths(steps, self.model, geom).reshape(2, 3)
        turn = self.data.geom_xmat[geom].reshape(3, 3)
        return turn @ point + self.data.geom_xpos[geom], turn @ (ahead - back)

    def _surface(self, geom: int, name: str, most_m: float) -> Float[np.ndarray, "points 3"]:
        """Points on a hollow object's surface near a part, in the frame of the part's shape [m]."""
        tree = self.hollow[name]
        assert tree is not None
        self.looks += 1
        mocap = self.bodies[name]
        quaternion = np.array(self.data.mocap_quat[mocap])
        thing = Rotation.from_quat(quaternion, scalar_first=True).as_matrix()
        middle = (self.data.geom_xpos[geom] - self.data.mocap_pos[mocap]) @ thing
        near = tree.query_ball_point(middle, self.model.geom_rbound[geom] + most_m)
        turn = self.data.geom_xmat[geom].reshape(3, 3)
        return np.asarray((tree.data[near] - middle) @ (thing.T @ turn))


def things_apart(scene: Scene, names: tuple[str, str], human: Human) -> float:
    """The distance between two objects as they stand, no more than ``NEAR_M`` [m]."""
    around = Surroundings(human, scene)
    around.pose(human.posture(), {name: thing.pose for name, thing in scene.things.items()})
    found = (pair for pair in around.things_near() if {pair.part, pair.thing} == set(names))
    return min((pair.distance_m for pair in found), default=NEAR_M)


def _depths(
    points: Float[np.ndarray, "points 3"], model: mujoco.MjModel, geom: int
) -> Float[np.ndarray, "points"]:
    """Signed distances of points from a primitive in its own frame [m]."""
    size, kind = model.geom_size[geom], model.geom_type[geom]
    if kind == mujoco.mjtGeom.mjGEOM_BOX:
        off = np.abs(points) - size
        outside = np.linalg.norm(np.maximum(off, 0.0), axis=1)
        return np.asarray(outside + np.minimum(off.max(axis=1), 0.0))
    if kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
        axis = np.clip(points[:, 2], -size[1], size[1])
        apart = points - np.stack([0 * axis, 0 * axis, axis], axis=1)
        return np.asarray(np.linalg.norm(apart, axis=1) - size[0])
    # To first order: the implicit function over the length of its gradient.
    scaled = np.linalg.norm(points / size, axis=1)
    slope = np.linalg.norm(points / size**2, axis=1)
    return np.asarray(scaled * (scaled - 1.0) / np.maximum(slope, 1e-9))


@lru_cache(maxsize=SHAPES)
def _surface_points(shape: Shape, spacing_m: float = SPACING_M) -> KDTree | None:
    """Points on a hollow shape's surface; None where its hull is its shape."""
    mesh = trimesh.Trimesh(np.array(shape.vertices), np.array(shape.faces), process=False)
    if abs(mesh.volume) > HOLLOW * mesh.convex_hull.volume:
        return None
    points, _ = trimesh.sample.sample_surface(
        mesh, max(SAMPLES, round(mesh.area / spacing_m**2)), seed=0
    )
    return KDTree(np.concatenate([np.array(shape.vertices), np.array(points)]))


CLEAR_M = 0.001  # How far the surface of a limb is kept from that of an object [m].

HEAD = ("head", "right_eye", "left_eye")
HEAD_CLEAR_M = 0.015  # Likewise the head, whose contacts are observed from 5 mm on [m].
HAND_CLEAR_M = (
    0.01  # Likewise a hand that is not led: five fingers stick out further than here [m].
)

CLEAR_COST = 100.0
"""Weight of a metre by which a limb is nearer [1/m]; two thirds of that of a palm's place."""


class ClearTask(mink.Task):
    """Pushes every part of the body but the hands that have paths of their own out of objects.

    A part that is far enough from an object adds nothing.
    """

    def __init__(
        self, around: Surroundings, met: Collection[str] = (), led: Collection[str] = SIDES
    ) -> None:
        """Watch all parts and objects, but for hands that are led and what the head meets."""
        self.around = around
        parts = (*HAND_SEGMENTS, "thumb")
        hands = {f"{side}_{part}" for side in led for part in parts}
        clear_m = dict.fromkeys(HEAD, HEAD_CLEAR_M)
        clear_m |= {f"{side}_{part}": HAND_CLEAR_M for side in SIDES for part in parts}
        self.pairs = [
            (geom, name)
            for geom, name in around.pairs
            if (part := around.parts[geom]) not in hands and not (part in HEAD and name in met)
        ]
        self.clear_m = np.array([clear_m.get(around.parts[g], CLEAR_M) for g, _ in self.pairs])
        self.geoms = around.shapes(self.pairs)
        super().__init__(cost=np.full(len(self.pairs), CLEAR_COST))
        self.things = {name: vectors(thing.pose) for name, thing in around.scene.things.items()}
        self.active = True
        """Whether anything is pushed at all."""

        self.measured: np.ndarray | None = None
        self.gaps = np.full(len(self.pairs), np.inf)
        self.slopes = np.zeros((len(self.pairs), self.around.model.nv))

    def place(self, things: Mapping[str, Float[np.ndarray, "7"]]) -> None:
        """Take where objects are from now on, as ``vectors`` has it; others stay."""
        self.things |= things
        self.measured = None

    def compute_error(self, configuration: mink.Configuration) -> Float[np.ndarray, "rows"]:
        """How much nearer each part is to an object than it may be, negative [m]."""
        self._measure(configuration)
        short = np.minimum(self.gaps - self.clear_m, 0.0)
        return short if self.active else np.zeros(len(short))

    def compute_jacobian(
        self, configuration: mink.Configuration
    ) -> Float[np.ndarray, "pairs dofs"]:
        """How the distances of those that are too near change with the joints."""
        self._measure(configuration)
        self.slopes[:] = 0.0
        for row in np.flatnonzero(self.gaps < self.clear_m) if self.active else ():
            self.slopes[row] = self.around.slope(*self.pairs[row], HEAD_CLEAR_M)
        return self.slopes

    def _measure(self, configuration: mink.Configuration) -> None:
        known = self.measured is not None and np.array_equal(self.measured, configuration.q)
        if known or not self.active:
            return
        self.measured = np.array(configuration.q)
        self.around.place(self.measured, self.things)
        self.gaps[:] = np.inf
        for row in np.flatnonzero(self.around.at_least(self.geoms) < HEAD_CLEAR_M):
            self.gaps[row] = self.around.gap(*self.pairs[row], HEAD_CLEAR_M)
