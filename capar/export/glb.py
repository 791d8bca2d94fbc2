"""GLB: the mannequin with a node for each segment, and its motion as an animation (glTF 2.0)."""

import json
import struct
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import trimesh
from jaxtyping import Float

from capar.body.anthropometry import table
from capar.body.human import Human, Poses, poses_of
from capar.body.shapes import Form, form_mesh, forms, joined

FLOAT, UNSIGNED = 5126, 5125
"""Kinds of numbers in glTF."""

VERTICES, INDICES = 34962, 34963
"""Uses of a buffer view in glTF."""

UP = [-float(np.sqrt(0.5)), 0.0, 0.0, float(np.sqrt(0.5))]
"""The rotation of the root that brings z up to glTF's y up, x y z w."""


@dataclass
class _Buffer:
    """The binary part and the tables that point into it."""

    data: bytearray = field(default_factory=bytearray)
    views: list[dict[str, Any]] = field(default_factory=list)
    accessors: list[dict[str, Any]] = field(default_factory=list)

    def add(self, values: np.ndarray, kind: str, *, target: int | None = None) -> int:
        """Append an array; the number of its accessor."""
        component = UNSIGNED if target == INDICES else FLOAT
        array = np.ascontiguousarray(values, "<u4" if component == UNSIGNED else "<f4")
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": array.nbytes}
        self.views.append(view | ({"target": target} if target else {}))
        self.data += array.tobytes()
        flat = array.reshape(len(array), -1)
        self.accessors.append(
            {
                "bufferView": len(self.views) - 1,
                "componentType": component,
                "count": len(array),
                "type": kind,
                "min": [each.item() for each in flat.min(axis=0)],
                "max": [each.item() for each in flat.max(axis=0)],
            }
        )
        return len(self.accessors) - 1


def glb_bytes(human: Human, times: Float[np.ndarray, "frames"], motion: np.ndarray) -> bytes:
    """A motion as a binary glTF file: metres, y up, an animation of every segment's rotation."""
    poses, buffer = poses_of(human, motion), _Buffer()
    meshes, materials, mesh_of = _meshes(human, buffer)
    document = {
        "asset": {"version": "2.0", "generator": "capar"},
        "scene": 0,
        "scenes": [{"nodes": [len(poses.names)]}],
        "nodes": _nodes(poses, mesh_of),
        "meshes": meshes,
        "materials": materials,
        "animations": [_animation(poses, times, buffer)],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.data)}],
    }
    return _packed(document, bytes(buffer.data))


def _nodes(poses: Poses, mesh_of: Mapping[str, int]) -> list[dict[str, Any]]:
    """A node a segment in the order of their numbers, then the root that turns them y up."""
    nodes: list[dict[str, Any]] = []
    for number, name in enumerate(poses.names):
        children = [each for each, parent in enumerate(poses.parents) if parent == number]
        at = poses.offsets[number] if number else poses.positions[0, 0]
        turn = np.roll(poses.turns[0, number], -1)
        node: dict[str, Any] = {
            "name": name,
            "translation": [float(each) for each in at],
            "rotation": [float(each) for each in turn],
        }
        node |= {"children": children} if children else {}
        node |= {"mesh": mesh_of[name]} if name in mesh_of else {}
        nodes.append(node)
    return [*nodes, {"name": "world", "rotation": UP, "children": [0]}]


def _animation(poses: Poses, times: Float[np.ndarray, "frames"], buffer: _Buffer) -> dict[str, Any]:
    clock = buffer.add(times - times[0], "SCALAR")
    outputs = [(0, "translation", buffer.add(poses.positions[:, 0], "VEC3"))]
    for number in range(len(poses.names)):
        turns = np.roll(poses.turns[:, number], -1, axis=1)
        outputs.append((number, "rotation", buffer.add(turns, "VEC4")))
    return {
        "name": "motion",
        "samplers": [
            {"input": clock, "output": output, "interpolation": "LINEAR"}
            for _, _, output in outputs
        ],
        "channels": [
            {"sampler": index, "target": {"node": node, "path": path}}
            for index, (node, path, _) in enumerate(outputs)
        ],
    }


def _meshes(
    human: Human, buffer: _Buffer
) -> tuple[list[dict[str, Any]], list[dict[str, Any]], dict[str, int]]:
    """The meshes, the materials, and which mesh each segment has."""
    colours = table("shapes")["colours"]
    numbers = {name: index for index, name in enumerate(colours)}
    materials = [
        {
            "name": name,
            "pbrMetallicRoughness": {
                "baseColorFactor": list(map(float, colour)),
                "metallicFactor": 0.0,
                "roughnessFactor": 0.9,
            },
        }
        for name, colour in colours.items()
    ]
    parts: dict[str, dict[str, list[Form]]] = {}
    for form in forms(human.measures, human.segments):
        parts.setdefault(form.body, {}).setdefault(form.colour, []).append(form)
    meshes = []
    for name, by_colour in parts.items():
        primitives = [
            _primitive([form_mesh(form) for form in group], numbers[colour], buffer)
            for colour, group in by_colour.items()
        ]
        meshes.append({"name": name, "primitives": primitives})
    return meshes, materials, {name: index for index, name in enumerate(parts)}


def _primitive(group: list[trimesh.Trimesh], material: int, buffer: _Buffer) -> dict[str, Any]:
    mesh = joined(group)
    normals = np.array(mesh.vertex_normals)
    return {
        "attributes": {
            "POSITION": buffer.add(np.array(mesh.vertices), "VEC3", target=VERTICES),
            "NORMAL": buffer.add(normals, "VEC3", target=VERTICES),
        },
        "indices": buffer.add(np.array(mesh.faces).reshape(-1), "SCALAR", target=INDICES),
        "material": material,
    }


def _packed(document: Mapping[str, Any], data: bytes) -> bytes:
    """The container: a header, the JSON chunk and the binary chunk, each padded to four bytes."""
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    size = 12 + 8 + len(text) + 8 + len(data)
    head = struct.pack("<4sII", b"glTF", 2, size)
    return b"".join(
        [head, struct.pack("<I4s", len(text), b"JSON"), text,
         struct.pack("<I4s", len(data), b"BIN\0"), data]
    )  # fmt: skip
