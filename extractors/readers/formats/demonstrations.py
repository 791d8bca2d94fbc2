"""HDF5 demonstrations of robomimic and robosuite: MuJoCo states and the model that they are of."""

import hashlib
import json
import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cached_property
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree.ElementTree import ParseError

import numpy as np
from defusedxml import DefusedXmlException
from defusedxml.ElementTree import fromstring
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model import geometry
from capar.model.capture import Shape, Source
from capar.model.errors import CaptureError, FileError, UnknownNameError
from extractors.readers.file_access import EXPANDED_LIMIT
from extractors.readers.names import constant_name, side_of
from extractors.readers.recording import Recording, track, uniform_clock

if TYPE_CHECKING:
    import mujoco

OPTIONS = frozenset({"demo"})
"""``demo``: the name of the demonstration; the first if not given."""

ASSETS = "CAPAR_ASSETS"
"""The environment variable that names folders with the meshes of models."""

WITH_FILES = {"mesh", "texture", "hfield", "skin"}
"""Elements of a model whose files are read, or left out, when it is compiled, and not before."""

REFUSED = {"include", "plugin", "extension", "composite", "flexcomp", "replicate"}
"""Elements of a model that read other files, run other code, or stand for any number of bodies."""

PLANE_M = 5.0  # Half the length of an infinite plane [m].
THICK_M = 0.05  # Half the thickness of a plane, which ends at its upper side [m].


def recognises(path: Path, head: bytes) -> bool:
    """Whether the file opens as HDF5 does."""
    return head.startswith(b"\x89HDF\r\n\x1a\n")


def read(path: Path, options: Mapping[str, Any]) -> Recording:
    """The bodies of a demonstration that collide with others, as the simulator places them.

    What is welded together is one body, with the surfaces that collide: of a mesh its convex hull.

    Raises:
        FileError: States or model are missing or do not fit, or a mesh is not found.
        UnknownNameError: There is no such demonstration.
    """
    scene = _Scene.of(path, options.get("demo"))
    times, positions, orientations = scene.motion()
    shapes = {scene.name(link): scene.shape(link) for link in scene.geoms}
    return Recording(
        source=Source(str(path), "hdf5", scene.digest),
        bodies={
            scene.name(link): track(
                scene.name(link), times, positions[:, max(link, 0)], orientations[:, max(link, 0)]
            )
            for link, _ in scene.entries()
        },
        shapes={name: shape for name, shape in shapes.items() if shape},
        unit_m=1.0,
        up="z",
    )


def draft(path: Path, shown: str, demo: str = "") -> str:
    """The capture.toml that a file amounts to: its model says what is what.

    Trees of bodies with motors are the agent's, and its end-effectors are the last links from which
    others branch, with these as their fingers, or else the last links. What moves freely is MOBILE,
    what hangs on it or on something FIXED by a joint is a part.

    Args:
        path: The file.
        shown: Its path as the text is to state it.
        demo: The demonstration whose model is described; of several none is, if it is not given.
    """
    names = demonstrations(path)
    several = len(names) > 1
    lines = [f"name = {json.dumps(constant_name(path.stem))}"]
    lines += [f"takes = {json.dumps(names)}"] if several else []
    take = "{take}" if several else names[0]
    lines += ["", f"files.motion = {{ path = {json.dumps(shown)}, demo = {json.dumps(take)} }}"]
    lines += ["", "contact.tolerance_m = 0.001   # a simulator knows where surfaces are"]
    if several and not demo:
        return "\n".join(lines) + "\n"
    scene = _Scene.of(path, demo or None)
    lines += ["", "[agent]", 'name = "robot"', 'kind = "robot"']
    used: dict[int, str] = {}
    for link, keys in scene.entries():
        stem = constant_name(str(keys.get("name", scene.name(link).removesuffix("_main"))))
        numbered = (f"{stem}_{n}" for n in range(2, len(used) + 3))
        used[link] = next(each for each in (stem, *numbered) if each not in used.values())
        table = {**keys, "name": used[link], "body": scene.name(link)}
        if "part_of" in keys:
            table["part_of"] = used[keys["part_of"]]
        lines += ["", "[[object]]" if "tag" in keys else "[[sensor]]"]
        lines += [f"{key} = {json.dumps(value)}" for key, value in table.items()]
    return "\n".join(lines) + "\n"


def demonstrations(path: Path) -> list[str]:
    """The names of a file's demonstrations, by their numbers.

    Raises:
        FileError: There is none.
    """
    with _opened(path) as file:
        names = [name for name in file["data"] if name.startswith("demo")]
    if not names:
        raise FileError(path, "holds no demonstrations.", "They are groups data/demo_0, ...")
    return sorted(names, key=lambda name: [int(n) for n in re.findall(r"\d+", name)] + [0])


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    """The file, in which there is a group ``data``.

    Raises:
        FileError: It is no such file, or h5py is not installed.
    """
    try:
        import h5py
    except ImportError as error:
        remedy = "Install it: pip install 'capar[hdf5]'."
        raise FileError(path, "is HDF5, which needs the package h5py.", remedy) from error
    try:
        with h5py.File(path, "r") as file:
            if not isinstance(file.get("data"), h5py.Group):
                remedy = "The layout of robomimic is read: data/demo_0/states, ..."
                raise FileError(path, "is HDF5 without a group 'data'.", remedy)
            yield file
    except OSError as error:
        raise FileError(path, f"is damaged: {error}.", "Copy it again.") from error


Entry = tuple[int, dict[str, Any]]
"""A link and what its table states; ``part_of`` is a link."""


@dataclass(frozen=True, eq=False)
class _Scene:
    """A demonstration: its model, and its states."""

    model: "mujoco.MjModel"
    states: Float[np.ndarray, "frames width"]
    rate_hz: float | None
    """The rate of control that the file states."""

    digest: str
    """SHA-256 of states and model: others of the file do not matter."""

    @classmethod
    def of(cls, path: Path, demo: str | None) -> "_Scene":
        """The demonstration of that name, or the first."""
        names = demonstrations(path)
        demo = names[0] if demo is None else demo
        if demo not in names:
            raise UnknownNameError("demonstration", demo, names, where=str(path))
        where = f"{path}:{demo}"
        with _opened(path) as file:
            group = _own(where, file["data"], demo)
            xml = group.attrs.get("model_file")
            if not isinstance(xml, str | bytes):
                remedy = "It is the model's XML, which robosuite writes: convert the file again."
                raise FileError(where, "has no attribute 'model_file'.", remedy)
            if "states" not in group:
                remedy = "Poses come from MuJoCo's states; observations alone do not have them."
                raise FileError(where, "has no data set 'states'.", remedy)
            table = _own(where, group, "states")
            if table.external or table.is_virtual:
                raise FileError(where, "has states in another file, which is not read.")
            if table.ndim != 2 or table.dtype.kind != "f" or table.nbytes > EXPANDED_LIMIT:
                raise FileError(where, f"has states {table.dtype} {table.shape}, no table.")
            states = np.asarray(table[()], dtype=float)
            rate_hz = _rate(file["data"].attrs.get("env_args"))
        text = xml.decode("utf-8", "replace") if isinstance(xml, bytes) else xml
        model = _compiled(path, where, text)
        width = 1 + model.nq + model.nv
        if states.shape[1] not in {width, width + model.na}:
            raise FileError(
                where,
                f"has {states.shape[1]} numbers a state, and its model {width}: the time, "
                f"{model.nq} positions, {model.nv} velocities.",
                "'model_file' and 'states' must be of one demonstration.",
            )
        digest = hashlib.sha256(text.encode() + states.tobytes()).hexdigest()
        return cls(model, states, rate_hz, digest)

    def motion(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Times [s], and positions [m] and orientations of every body of the model."""
        import mujoco

        data = mujoco.MjData(self.model)
        places, turns = [], []
        for state in self.states:
            data.qpos[:] = state[1 : 1 + self.model.nq]
            mujoco.mj_kinematics(self.model, data)
            places.append(data.xpos.copy())
            turns.append(data.xquat.copy())
        times = self.states[:, 0]
        if not (np.diff(times) > 0.0).all():
            if self.rate_hz is None:
                raise CaptureError("the time in its states does not increase, nor is a rate stated")
            times = uniform_clock(len(times), self.rate_hz)
        return times - times[0], np.array(places), np.array(turns)

    @cached_property
    def geoms(self) -> Mapping[int, list[int]]:
        """What collides, by links: bodies welded together, known by the first of them.

        What never moves is a link for each tree of bodies; each geom of the world itself is one of
        its own, by its number below zero.
        """
        out: dict[int, list[int]] = {}
        for geom, body in enumerate(self.model.geom_bodyid):
            link = int(self.model.body_weldid[body]) or int(self.model.body_rootid[body])
            out.setdefault(link or -1 - geom, []).append(geom)
        return out

    def name(self, link: int) -> str:
        """The model's name of a link, or one by its number."""
        named = self.model.body(link) if link >= 0 else self.model.geom(-1 - link)
        return named.name or f"body_{abs(link)}"

    def shape(self, link: int) -> Shape | None:
        """The surface of a link in the frame of its body; None of what is only seen."""
        import mujoco

        data = mujoco.MjData(self.model)
        mujoco.mj_kinematics(self.model, data)
        body = max(link, 0)
        frame = geometry.transforms(data.xpos[body], data.xquat[body]).inv()
        corners, faces, count = [], [], 0
        for geom in self.geoms[link]:
            mesh = _mesh(self.model, geom)
            if mesh is None:
                continue
            turn = Rotation.from_matrix(data.geom_xmat[geom].reshape(3, 3))
            place = frame * RigidTransform.from_components(data.geom_xpos[geom], turn)
            corners.append(place.apply(np.asarray(mesh.vertices)))
            faces.append(np.asarray(mesh.faces) + count)
            count += len(mesh.vertices)
        if not corners:
            return None
        description = f"the simulator's {self.name(link)}"
        return Shape(np.concatenate(corners), np.concatenate(faces), description=description)

    def entries(self) -> list[Entry]:
        """Sensors and objects as the model has them: see ``draft``."""
        import mujoco

        model = self.model
        joints = (mujoco.mjtTrn.mjTRN_JOINT, mujoco.mjtTrn.mjTRN_JOINTINPARENT)
        hinged = (mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE)
        moving = [b for b in range(1, model.nbody) if model.body_weldid[b] == b]
        above = {link: int(model.body_weldid[model.body_parentid[link]]) for link in moving}
        motors = [
            joint
            for kind, (joint, _) in zip(model.actuator_trntype, model.actuator_trnid, strict=True)
            if int(kind) in joints
        ]
        agents = {int(model.body_rootid[model.jnt_bodyid[joint]]) for joint in motors}
        limbs = [link for link in moving if model.body_rootid[link] in agents]
        out: list[Entry] = []
        for palm in _palms({link: above[link] for link in limbs}):
            out += self._gripper(palm, [each for each in limbs if palm in _chain(each, above)])
        if not out:
            raise CaptureError("its model has no motor that moves a joint, so nobody acts")
        for link in self.geoms:
            if link < 0 or (link not in above and link not in agents):
                out.append((link, {"tag": "fixed"}))
        for link in moving:
            if link not in limbs and link in self.geoms:
                keys: dict[str, Any] = {"tag": "mobile"}
                base = next(
                    (each for each in _chain(link, above) if each in self.geoms),
                    int(model.body_rootid[link]),
                )
                joint = int(model.body_jntadr[link])
                alone = model.body_jntnum[link] == 1 and int(model.jnt_type[joint]) in hinged
                if alone and base in self.geoms and base != link:
                    keys["part_of"] = base
                out.append((link, keys))
        return out

    def _gripper(self, palm: int, fingers: Sequence[int]) -> Iterator[Entry]:
        """A sensor for a palm, and one for each finger."""
        model = self.model
        names = [model.body(b).name for b in range(model.nbody) if model.body_weldid[b] == palm]
        sides = {side_of(name) for name in names} - {"none"}
        side = sides.pop() if len(sides) == 1 else "none"
        name = f"{side}_gripper".removeprefix("none_")
        yield palm, {"name": name, "end_effector": "hand", "side": side}
        for finger in fingers:
            yield finger, {"end_effector": "jaw", "side": side, "part_of": palm}


def _chain(link: int, above: Mapping[int, int]) -> Iterator[int]:
    """The moving links that a link hangs on, the nearest first."""
    while (link := above.get(link, 0)) in above:
        yield link


def _palms(above: Mapping[int, int]) -> list[int]:
    """The last links from which others branch; or the last ones, where none branches."""
    parents = list(above.values())
    branching = [link for link in above if parents.count(link) > 1]
    inner = {each for link in branching for each in _chain(link, above)}
    return [link for link in branching if link not in inner] or [
        link for link in above if link not in parents
    ]


def _mesh(model: "mujoco.MjModel", geom: int) -> Any:
    """A geom's surface in its own frame, of a mesh its hull; None if it has none of triangles."""
    import mujoco
    import trimesh
    from trimesh import creation

    half, kind = model.geom_size[geom], mujoco.mjtGeom(int(model.geom_type[geom]))
    if kind == mujoco.mjtGeom.mjGEOM_MESH:
        mesh = model.mesh(int(model.geom_dataid[geom]))
        first, count = int(mesh.vertadr[0]), int(mesh.vertnum[0])
        start, faces = int(mesh.faceadr[0]), int(mesh.facenum[0])
        corners = model.mesh_vert[first : first + count]
        return trimesh.Trimesh(corners, model.mesh_face[start : start + faces]).convex_hull
    level = np.where(half[:2] > 0.0, half[:2], PLANE_M)
    makers: Mapping[Any, Callable[[], Any]] = {
        mujoco.mjtGeom.mjGEOM_PLANE: lambda: creation.box(
            bounds=np.array([[*-level, -2.0 * THICK_M], [*level, 0.0]])
        ),
        mujoco.mjtGeom.mjGEOM_SPHERE: lambda: creation.icosphere(2, half[0]),
        mujoco.mjtGeom.mjGEOM_ELLIPSOID: lambda: creation.icosphere(2).apply_scale(half),
        mujoco.mjtGeom.mjGEOM_CAPSULE: lambda: creation.capsule(2.0 * half[1], half[0]),
        mujoco.mjtGeom.mjGEOM_CYLINDER: lambda: creation.cylinder(half[0], 2.0 * half[1]),
        mujoco.mjtGeom.mjGEOM_BOX: lambda: creation.box(extents=2.0 * half),
    }
    return makers[kind]() if kind in makers else None


def _own(where: str, group: Any, name: str) -> Any:
    """A member of a group that is in the file itself."""
    import h5py

    if not isinstance(group.get(name, getlink=True), h5py.HardLink):
        raise FileError(where, f"has {name!r} by a link, which is not followed.")
    return group[name]


def _rate(env_args: Any) -> float | None:
    """The rate of control that robomimic's arguments of the environment state [Hz]."""
    with suppress(TypeError, ValueError, KeyError):
        return float(json.loads(env_args)["env_kwargs"]["control_freq"])
    return None


def _compiled(path: Path, where: str, xml: str) -> "mujoco.MjModel":
    """The model without what is only seen: of all its files those of colliding meshes are read.

    Raises:
        FileError: The XML is none, names files that a model need not have, or a mesh is missing.
    """
    import mujoco

    try:
        for element in fromstring(xml, forbid_dtd=True).iter():
            if element.tag in REFUSED or (
                "file" in element.attrib and element.tag not in WITH_FILES
            ):
                raise FileError(where, f"has a model with <{element.tag}>, which is not read.")
        spec = mujoco.MjSpec.from_string(xml)
        for geom in list(spec.geoms):
            geom.material = ""
            if not (geom.contype or geom.conaffinity) or geom.type == mujoco.mjtGeom.mjGEOM_HFIELD:
                spec.delete(geom)
        for site in spec.sites:
            site.material = ""
        shown = (spec.materials, spec.textures, spec.skins, spec.hfields)
        for each in [each for some in (*shown, spec.sensors, spec.pairs) for each in some]:
            spec.delete(each)
        wanted = {geom.meshname for geom in spec.geoms}
        for number, mesh in enumerate(list(spec.meshes)):
            if mesh.name not in wanted:
                spec.delete(mesh)
            elif mesh.file:
                found = _asset(path, where, str(Path(spec.meshdir, mesh.file)))
                mesh.file = f"{number}{found.suffix.lower()}"
                spec.assets[mesh.file] = found.read_bytes()
        spec.meshdir = ""
        spec.compiler.boundmass = spec.compiler.boundinertia = 1e-6  # shown geoms had mass too
        return spec.compile()
    except (ParseError, DefusedXmlException) as error:
        raise FileError(where, f"has a model that is no plain XML: {error!r}.") from error
    except ValueError as error:
        raise FileError(where, f"has a model that MuJoCo refuses: {error}.") from error


def _asset(path: Path, where: str, stated: str) -> Path:
    """The file of a mesh, by the longest end of its path that is in a folder which may be read.

    Raises:
        FileError: There is none in any of them.
    """
    robosuite = find_spec("robosuite")
    own = [
        Path(each) / "models" / "assets"
        for each in (robosuite and robosuite.submodule_search_locations) or []
    ]
    folders = [
        path.parent,
        *map(Path, filter(None, os.environ.get(ASSETS, "").split(os.pathsep))),
        *own,
    ]
    parts = [each for each in re.split(r"[/\\]+", stated) if each not in {"", ".", ".."}]
    for first in range(len(parts)):
        for folder in folders:
            found = folder.joinpath(*parts[first:])
            if found.is_file() and found.resolve().is_relative_to(folder.resolve()):
                return found
    raise FileError(
        where,
        f"needs the mesh {stated!r}, which is in none of {', '.join(map(str, folders))}.",
        f"Put it beside the file, or set {ASSETS} to the folder of the model's assets: "
        "robosuite/models/assets where robosuite is installed.",
    )
