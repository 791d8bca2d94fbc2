"""Bodies: fit one to a capture, let a virtual one perform, map a performance to another."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from capar.cli.options import Assume, Capture, Json, NewBundle
from capar.cli.output import check_new_folder, print_json, written

if TYPE_CHECKING:
    from collections.abc import Mapping

    from capar.body.sensor_fitting import Fit

AT_LIMIT = 0.01
"""From this share of the time on, a joint at the end of its range is printed [1]."""

OPEN_HAND = ("knuckle", "finger", "thumb")
"""Joints that are at the end of their range in an open hand."""


def fit(
    capture: Capture,
    json: Json = False,
    bvh: Annotated[
        Path | None, typer.Option(help="Write the skeleton's motion: BVH, y up, centimetres.")
    ] = None,
    glb: Annotated[
        Path | None, typer.Option(help="Write the moving mannequin: binary glTF, y up, metres.")
    ] = None,
    c3d: Annotated[
        Path | None, typer.Option(help="Write the segments' poses: C3D, ROTATION data, z up, mm.")
    ] = None,
    npz: Annotated[
        Path | None, typer.Option(help="Write postures, joint angles and poses as NumPy arrays.")
    ] = None,
    csv: Annotated[
        Path | None, typer.Option(help="Write the pelvis's pose and joint angles as a table.")
    ] = None,
    mjcf: Annotated[
        Path | None, typer.Option(help="Write the body as a MuJoCo model; --npz has its qpos.")
    ] = None,
) -> None:
    """Fit a human body to a capture, and print the residuals.

    It follows joints, markers or sensors. Where sensors need it, limb lengths come from the
    motion.
    """
    from capar.body.body_fitting import fit_body, fit_warnings
    from extractors.readers.bundle.capture_toml import read_capture

    recorded = read_capture(capture)
    made = fit_body(capture, recorded)
    warnings = fit_warnings(capture, recorded, made)
    _write(made, {"bvh": bvh, "glb": glb, "c3d": c3d, "npz": npz, "csv": csv, "mjcf": mjcf})
    if json:
        print_json({**_answer(made), "warnings": warnings})
    else:
        _print_fit(made)
        for warning in warnings:
            typer.echo(f"warning: {warning}")


def _write(made: "Fit", wanted: "Mapping[str, Path | None]") -> None:
    """Write the files that are wanted, each whole or not at all."""
    from capar.export.bvh import bvh_text
    from capar.export.c3d import c3d_bytes
    from capar.export.glb import glb_bytes
    from capar.export.motion_tables import csv_text, mjcf_text, write_npz

    motion = (made.human, made.times, made.motion)
    makers = {
        "bvh": lambda: bvh_text(*motion).encode(),
        "glb": lambda: glb_bytes(*motion),
        "c3d": lambda: c3d_bytes(*motion),
        "csv": lambda: csv_text(*motion).encode(),
        "mjcf": lambda: mjcf_text(made.human).encode(),
    }
    for form, path in wanted.items():
        if path is not None:
            with written(path) as draft:
                if form == "npz":
                    write_npz(draft, *motion)
                else:
                    draft.write_bytes(makers[form]())
            typer.echo(f"wrote {path}", err=True)


def _answer(made: "Fit") -> dict[str, Any]:
    """Residuals by sensor, joint or marker, shares of time at joint limits, and the time taken."""
    import numpy as np

    def median_deg(place: str) -> float | None:
        """Median angle from a sensor; None for joints and markers, which are points."""
        turned = made.residuals_rad.get(place)
        return None if turned is None else round(float(np.degrees(np.nanmedian(turned))), 4)

    shares = dict(zip(made.human.joints, made.at_limit.mean(axis=0), strict=True))
    at_limit = {
        name: round(float(share), 4)
        for name, share in shares.items()
        if share >= AT_LIMIT and not any(part in name for part in OPEN_HAND)
    }
    return {
        "sensors": {
            place: {
                "median_mm": round(1e3 * float(np.nanmedian(metres)), 3),
                "p95_mm": round(1e3 * float(np.nanpercentile(metres, 95)), 3),
                "median_deg": median_deg(place),
                "lost_frames": int(made.bridged[place].sum()),
            }
            for place, metres in made.residuals_m.items()
        },
        "median_mm": round(1e3 * float(np.nanmedian([*made.residuals_m.values()])), 3),
        "stature_m": round(made.human.measures["stature"], 4),
        "at_limit": dict(sorted(at_limit.items(), key=lambda row: (-row[1], row[0]))),
        "measures_given": sorted(made.human.measures.given),
        "frames": len(made.times),
        "motion_s": round(float(made.times[-1] - made.times[0]), 4),
        "seconds": round(made.seconds, 3),
    }


def _print_fit(made: "Fit") -> None:
    """Print the same for people."""
    answer = _answer(made)
    wide = max(14, *map(len, answer["sensors"]))
    typer.echo(f"{'followed':{wide}}  median [mm]  95 % [mm]  median [deg]  lost [frames]")
    for place, row in answer["sensors"].items():
        angle = "-" if row["median_deg"] is None else f"{row['median_deg']:.2f}"
        typer.echo(
            f"{place:{wide}}  {row['median_mm']:11.1f}  {row['p95_mm']:9.1f}"
            f"  {angle:>12}  {row['lost_frames']:13}"
        )
    typer.echo(f"median of all: {answer['median_mm']:.1f} mm, stature {answer['stature_m']:.2f} m")
    for joint, share in answer["at_limit"].items():
        typer.echo(f"{joint} is at its limit for {share:.0%} of the time")
    given = ", ".join(answer["measures_given"]) or "none"
    typer.echo(f"measures given: {given}; the others are estimated")
    span, took = answer["motion_s"], answer["seconds"]
    typer.echo(f"{answer['frames']} frames, {span:.1f} s of motion, fitted in {took:.1f} s")


def perform(
    action: Annotated[
        str,
        typer.Argument(
            help="drink, sip, touch, touch_from_rest, slide, carry, carry_tray, carry_two, "
            "pick_up, turn, push, pour, door, drawer, wipe or toss; of two bodies hand_over."
        ),
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="A new folder for the capture.")],
    agent: Annotated[
        str,
        typer.Option(help="Who performs: man, woman or child; of two bodies such as man+woman."),
    ] = "man",
    rate: Annotated[float, typer.Option(help="Frames a second.", min=10.0, max=480.0)] = 60.0,
    noisy: Annotated[
        bool, typer.Option("--noisy", help="With the noise and the mounts of a magnetic tracker.")
    ] = False,
    seed: Annotated[int, typer.Option(help="The draw of the noise.", min=0)] = 3,
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
        pair = (*agent.split("+"), *agent.split("+"))[:2]
        made = performed_together(action, (pair[0], pair[1]), rate_hz=rate)
        both = joint_capture(action, (pair[0], pair[1]), rate_hz=rate, noisy=noisy, seed=seed)
        write_bundle(both, truth_together(made), output)
        typer.echo(
            f"wrote {output}: {action} by a {pair[0]} and a {pair[1]}, {both.times[-1]:.1f} s at "
            f"{rate:g} Hz",
            err=True,
        )
        return
    capture = action_capture(action, agent, rate_hz=rate, noisy=noisy, seed=seed)
    write_bundle(capture, truth_of(performed(action, agent, rate_hz=rate)), output)
    typer.echo(
        f"wrote {output}: {action} by a {agent}, {capture.times[-1]:.1f} s at {rate:g} Hz, "
        f"{len(capture.sensors)} sensors and {len(capture.objects)} objects",
        err=True,
    )


def map_command(
    capture: Capture,
    agent: Annotated[
        str, typer.Option(help="Who performs: man, woman, child, or same for the one recorded.")
    ] = "same",
    output: NewBundle = None,
    cutoff: Annotated[
        float,
        typer.Option(
            help="Cutoff of the low-pass filter that takes noise from the recorded paths [Hz]; "
            "0 follows them as they are.",
            min=0.0,
        ),
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
    from dataclasses import replace

    from capar.cli.regenerate import print_quality, quality_answer
    from capar.pipelines.round_trips import SAME, body, observed_source
    from capar.regeneration import map_directly
    from capar.regeneration.captures import capture_of, read_completion, write_motion
    from capar.regeneration.direct_mapping import departures

    if output:
        check_new_folder(output)
    completion = read_completion(assume) if assume else None
    source = observed_source(capture, completion, cutoff_hz=cutoff or None)
    motion, quality = map_directly(source, body(agent, source))
    quality = replace(quality, told=(*quality.told, *departures(motion)))
    if output:
        name = agent if agent != SAME else source.capture.agent.name
        write_motion(motion, capture_of(motion, name=source.capture.name, agent=name), output)
    if json:
        print_json(quality_answer(motion, quality))
        return
    print_quality(motion, quality)
    if output:
        typer.echo(f"wrote {output}", err=True)
