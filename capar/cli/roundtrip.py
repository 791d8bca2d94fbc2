"""The command that observes, performs on other bodies, and observes again."""

from typing import TYPE_CHECKING, Annotated

import typer

from capar.cli._options import Assume

if TYPE_CHECKING:
    from capar.pipelines.round_trips import Trip

app = typer.Typer()

HEADING = "agent  scene  same PAR  contacts  relations  gates  where not"


@app.command()
def roundtrip(
    capture: Annotated[
        str,
        typer.Argument(help="A capture bundle's folder or capture.toml; FOLDER:TAKE for a take."),
    ],
    agents: Annotated[
        str,
        typer.Option(
            help="Who performs, parted by commas: man, woman, child, same. Of several performers "
            "man+child and so on, in their order; one alone is all of them."
        ),
    ] = "man,woman,child",
    scenes: Annotated[
        int, typer.Option(min=0, help="How many scenes to draw; 0 performs in the recorded one.")
    ] = 0,
    seed: Annotated[int, typer.Option(min=0, help="Of the drawn scenes.")] = 0,
    assume: Assume = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON for machines.")] = False,
) -> None:
    """Observe CAPTURE, perform it on other bodies, observe that, and compare."""
    from capar.cli._round_trips import tell_trips
    from capar.cli._several_performers import check_no_others, tell_joint_trips
    from capar.pipelines.round_trips import body, observed_source, round_trips
    from capar.pipelines.trials import trial_of
    from capar.regeneration.completing import read_completion

    trial = trial_of(capture)
    if trial.others:
        check_no_others({"--assume": assume})
        casts = [cast.strip() for cast in agents.split(",")]
        tell_joint_trips(trial, casts, scenes=scenes, seed=seed, json=json)
        return
    source = observed_source(trial, read_completion(assume) if assume else None)
    names = tuple(each.strip() for each in agents.split(","))
    for name in names:
        body(name, source)  # a misspelt one is refused before anything is computed
    trips = round_trips(source, names, scenes=scenes, seed=seed)
    tell_trips(trips, _row, heading=HEADING, json=json)


def _row(trip: "Trip") -> str:
    if trip.refused:
        return f"{trip.agent:6} {trip.scene:5}  not performed: {trip.refused}"
    assert trip.quality is not None
    where = [
        f"{gate.name} {gate.value:.2f} {gate.unit} {gate.bodies}".strip()
        for gate in trip.quality.gates
        if not gate.passed
    ]
    where += [trip.names] if trip.names else []
    cells = (trip.same_par, trip.same_contacts, trip.same_relations, trip.quality.passed)
    words = ["yes" if each else "NO" for each in cells]
    return (
        f"{trip.agent:6} {trip.scene:5}  {words[0]:8}  {words[1]:8}  {words[2]:9}  {words[3]:5}  "
        f"{'; '.join(where)}"
    ).rstrip()
