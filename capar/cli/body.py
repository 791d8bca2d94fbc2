"""Bodies: fit one to a capture, let a virtual one perform, map a performance to another."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer import Argument, Option

from capar.cli.options import Assume, Capture, Json, NewBundle
from capar.cli.output import answer, check_new_folder, save
from capar.model.errors import CaparError

if TYPE_CHECKING:
    from capar.body.sensor_fitting import Fit

AT_LIMIT = 0.01
"""From this share of the time on, a joint at the end of its range is printed [1]."""

OPEN_HAND = ("knuckle", "finger", "thumb")
"""Joints that are at the end of their range in an open hand."""


def fit(
    capture: Capture,
    json: Json = False,
    bvh: Annotated[Path | None, Option(help="Write its motion: BVH, y up, cm.")] = None,
    glb: Annotated[Path | None, Option(help="Write its surface: glTF, y up, m.")] = None,
    c3d: Annotated[Path | None, Option(help="Write its poses: C3D, z up, mm.")] = None,
    npz: Annotated[Path | None, Option(help="Write everything: NumPy arrays.")] = None,
    csv: Annotated[Path | None, Option(help="Write its joint angles as a table.")] = None,
    mjcf: Annotated[Path | None, Option(help="Write it for MuJoCo; --npz has qpos.")] = None,
) -> None:
    """Fit a human body to a capture, and print the residuals.

    It follows joints, markers or sensors. Where sensors need it, limb lengths come from the
    motion.
    """
    from capar.body.body_fitting import fit_body, fit_warnings
    from capar.body.grasping import fingered_fit
    from capar.export.bvh import bvh_text
    from capar.export.c3d import c3d_bytes
    from capar.export.glb import glb_bytes
    from capar.export.motion_tables import csv_text, mjcf_text, write_npz
    from capar.pipelines.observation import observe
    from extractors.readers.bundle.capture_toml import read_capture

    recorded = read_capture(capture)
    made = fit_body(capture, recorded)
    warnings = fit_warnings(capture, recorded, made)
    if any((bvh, glb, c3d, npz, csv, mjcf)):
        hands = any(sensor.end_effector == "hand" for sensor in recorded.acting)
        shaped = any(thing.shape is not None for thing in recorded.objects)
        found = observe(recorded).facts if hands and shaped else ()
        shown = fingered_fit(made, recorded, found)
        motion = (shown.human, shown.times, shown.motion)
    if bvh:
        save(bvh, bvh_text(*motion))
    if glb:
        save(glb, glb_bytes(*motion))
    if c3d:
        save(c3d, c3d_bytes(*motion))
    if npz:
        save(npz, lambda draft: write_npz(draft, *motion))
    if csv:
        save(csv, csv_text(*motion))
    if mjcf:
        save(mjcf, mjcf_text(shown.human))
    value = _residuals(made)
    answer({**value, "warnings": warnings}, json=json)


def _residuals(made: "Fit") -> dict[str, Any]:
    """Residuals by sensor, joint or marker, shares of time at joint limits, and the time taken."""
    import numpy as np

    sensors = {}
    for place, metres in made.residuals_m.items():
        turned = made.residuals_rad.get(place)  # None for joints and markers, which are points
        sensors[place] = {
            "median_mm": round(1e3 * float(np.nanmedian(metres)), 3),
            "p95_mm": round(1e3 * float(np.nanpercentile(metres, 95)), 3),
            "median_deg": None
            if turned is None
            else round(float(np.degrees(np.nanmedian(turned))), 4),
            "lost_frames": int(made.bridged[place].sum()),
        }
    shares = zip(made.human.joints, made.at_limit.mean(axis=0), strict=True)
    at_limit = {
        name: round(float(share), 4)
        for name, share in sorted(shares, key=lambda row: (-round(float(row[1]), 4), row[0]))
        if share >= AT_LIMIT and not any(part in name for part in OPEN_HAND)
    }
    return {
        "sensors": sensors,
        "median_mm": round(1e3 * float(np.nanmedian([*made.residuals_m.values()])), 3),
        "stature_m": round(made.human.measures["stature"], 4),
        "at_limit": at_limit,
        "measures_given": sorted(made.human.measures.given),
        "frames": len(made.times),
        "motion_s": round(float(made.times[-1] - made.times[0]), 4),
        "seconds": round(made.seconds, 3),
    }


def perform(
    action: Annotated[
        str,
        Argument(
            help="drink, drink_from_mug, sip, touch, touch_from_rest, slide, carry, carry_tray, "
            "carry_two, pick_up, turn, push, pour, door, drawer, wipe or toss; of two bodies "
            "hand_over."
        ),
    ],
    output: Annotated[Path, Option("--output", "-o", help="A new folder for the capture.")],
    agent: Annotated[str, Option(help="man, woman or child; for two such as man+woman.")] = "man",
    rate: Annotated[float, Option(help="Frames a second.", min=10.0, max=480.0)] = 60.0,
    noisy: Annotated[bool, Option("--noisy", help="As of a magnetic tracker.")] = False,
    seed: Annotated[int, Option(help="The draw of the noise.", min=0)] = 3,
    rig: Annotated[
        str, Option(help="hands: hands, head and eyes; thesis: and eight more over the body.")
    ] = "hands",
) -> None:
    """Let a virtual body perform an action, and write the capture.

    The capture bundle has sensors on hands and head, the things that are handled, and what
    is exactly so beside it (truth.toml): it serves to try every other command.
    """
    from capar.body.recording import truth_of, truth_together, write_bundle
    from capar.body.scripted_actions import (
        JOINT_ACTIONS,
        action_capture,
        joint_capture,
        performed,
        performed_together,
    )

    check_new_folder(output)
    if action in JOINT_ACTIONS:
        if rig != "hands":
            raise CaparError(f"--rig is of one performer, and {action} is of two; leave it out")
        one, other, *_ = (*agent.split("+"), *agent.split("+"))
        made = performed_together(action, (one, other), rate_hz=rate)
        capture = joint_capture(action, (one, other), rate_hz=rate, noisy=noisy, seed=seed)
        truth, who = truth_together(made), f"a {one} and a {other}"
    else:
        capture = action_capture(action, agent, rate_hz=rate, noisy=noisy, seed=seed, rig=rig)
        truth, who = truth_of(performed(action, agent, rate_hz=rate)), f"a {agent}"
    write_bundle(capture, truth, output)
    typer.echo(
        f"wrote {output}: {action} by {who}, {capture.times[-1]:.1f} s at {rate:g} Hz, "
        f"{len(capture.sensors)} sensors and {len(capture.objects)} objects",
        err=True,
    )


def map_(
    capture: Capture,
    agent: Annotated[str, Option(help="man, woman, child, or same (as recorded).")] = "same",
    output: NewBundle = None,
    cutoff: Annotated[
        float,
        Option(min=0.0, help="Cutoff of the low-pass filter of recorded paths [Hz]; 0 for none."),
    ] = 0.0,
    assume: Assume = None,
    json: Json = False,
) -> None:
    """Map a capture directly to another body, without planning.

    It stays in the recorded scene, and is the baseline of `capar regenerate`.

    Hands and things go where they were recorded; what met the performer's head meets the new one's.
    Nothing is planned: no grip is fitted to the hand, and no obstacle is avoided. Every gate is
    printed, and how far hands and things are from their recorded ways.
    """
    from capar.cli.regenerate import quality_value
    from capar.pipelines.round_trips import SAME, body, observed_source
    from capar.regeneration import map_directly
    from capar.regeneration.captures import capture_of, write_motion
    from capar.regeneration.direct_mapping import departures

    if output:
        check_new_folder(output)
    source = observed_source(capture, assume, cutoff_hz=cutoff or None)
    motion, quality = map_directly(source, body(agent, source))
    quality = replace(quality, told=(*quality.told, *departures(motion)))
    if output:
        name = agent if agent != SAME else source.capture.agent.name
        write_motion(motion, capture_of(motion, name=source.capture.name, agent=name), output)
    answer(quality_value(motion, quality), json=json)
    if output and not json:
        typer.echo(f"wrote {output}", err=True)
