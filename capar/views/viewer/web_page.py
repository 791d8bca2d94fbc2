"""A capture as one HTML file that needs no network: bodies in three dimensions over a timeline."""

import json
from base64 import b64encode
from html import escape
from importlib import resources
from typing import Any

import numpy as np
import trimesh
from trimesh.exchange.gltf import export_glb

from capar.model.facts import LookingAt, Touching
from capar.model.observation import Observation
from capar.views.picture import COLOURS, CONTACT, MOTION, OTHERS, PALE, Kind, rows
from capar.views.viewer.stage import Stage, intervals


def surfaces_glb(shown: Stage) -> bytes:
    """The surfaces [m], z up as in the world; a body without one has no node."""
    scene = trimesh.Scene()
    for body in shown.bodies:
        if body.shape is not None:
            mesh = trimesh.Trimesh(
                np.array(body.shape.vertices), np.array(body.shape.faces), process=False
            )
            scene.add_geometry(mesh, node_name=body.name, geom_name=body.name)
    if not scene.geometry:
        # A file without a surface would be none: this one is too small to be seen.
        corners = np.array([[0.0, 0.0, 0.0], [1e-9, 0.0, 0.0], [0.0, 1e-9, 0.0]])
        mesh = trimesh.Trimesh(corners, np.array([[0, 1, 2]]), process=False)
        scene.add_geometry(mesh, node_name="nothing", geom_name="nothing")
    return bytes(export_glb(scene))  # type: ignore[no-untyped-call]


BARS = {Kind.MOTION: MOTION, Kind.BARS: CONTACT}


def web_page(shown: Stage, observation: Observation | None = None) -> str:
    """The page.

    Args:
        shown: The bodies and their ways.
        observation: What was found in the capture; None leaves the timeline empty.
    """
    place = resources.files("capar.views.viewer")
    parts = {
        "title": escape(shown.title),
        "data": json.dumps(_data(shown, observation)).replace("<", "\\u003c"),
        "glb": b64encode(surfaces_glb(shown)).decode("ascii"),
        "three": (place / "three" / "three.min.js").read_text(encoding="utf-8"),
        "style": (place / "viewer.css").read_text(encoding="utf-8"),
        "script": (place / "viewer.js").read_text(encoding="utf-8"),
    }
    page = (place / "viewer.html").read_text(encoding="utf-8")
    # Each part once, in turn, so that nothing inside of one is taken for the place of another.
    head, *rest = page.split("{{")
    return head + "".join(
        parts[name] + text for name, text in (each.split("}}", 1) for each in rest)
    )


def _data(shown: Stage, observation: Observation | None) -> dict[str, Any]:
    """What the page's script reads: times [s], places [m] and turns as 32-bit floats."""
    return {
        "times": _packed(shown.times),
        "bodies": [
            {
                "name": body.name,
                "kind": body.kind,
                "colour": body.colour,
                "label": body.label,
                "faint": body.faint,
                "positions": _packed(body.positions),
                "orientations": _packed(body.orientations),
            }
            for body in shown.bodies
        ],
        "rows": [] if observation is None else _rows(observation),
        "contacts": _pairs(observation, Touching),
        "looks": _pairs(observation, LookingAt),
    }


def _packed(values: np.ndarray) -> str:
    return b64encode(np.ascontiguousarray(values, dtype="<f4").tobytes()).decode("ascii")


def _rows(observation: Observation) -> list[dict[str, Any]]:
    """The rows of the timeline: as in pictures, without curves and marks of single frames."""
    out: list[dict[str, Any]] = []
    for row in rows(observation, {}):
        if row.kind is Kind.HEADING:
            out.append({"heading": row.label})
        elif row.spans:
            seen = sorted({each.label for each in row.spans})
            spans = []
            for each in row.spans:
                colour = COLOURS.get(each.kind, OTHERS[len(each.kind) % len(OTHERS)])
                if row.kind in BARS:
                    colour = BARS[row.kind]
                elif row.kind is Kind.NAMES:
                    colour = PALE[seen.index(each.label) % len(PALE)]
                start, end = round(each.start_s, 4), round(each.end_s, 4)
                spans.append({"start": start, "end": end, "label": each.label, "colour": colour})
            out.append({"label": row.label, "spans": spans})
    return out


def _pairs(
    observation: Observation | None, kind: type[Touching] | type[LookingAt]
) -> list[list[Any]]:
    """Each contact or look: both bodies, begin and end [s]."""
    found = intervals(observation, kind)
    spans = zip(found.pairs, found.starts_s.tolist(), found.ends_s.tolist(), strict=True)
    return [[*pair, start_s, end_s] for pair, start_s, end_s in spans]
