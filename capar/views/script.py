"""PARs as Python scripts in the thesis's form (thesis 4.6): written here, never executed.

Parameters are bare names, as in the thesis; everything that was observed is a quoted literal, so
that nothing in a capture can become code. The functions that a script calls (``contact``,
``posture``, ``elapsed``, ``checkCapability``) are those of the system that would run it.
"""

from collections.abc import Iterable, Mapping, Sequence
from functools import singledispatch
from keyword import iskeyword

from capar.model.errors import ParError
from capar.model.observation import Observation
from capar.model.par import ComplexPar, Condition, Step, Upar
from capar.views.tables import performers

INDENT = "    "
TESTED = (
    "def {name}({parameters}):\n    if {test}:\n        return 1\n    else:\n        return 0\n"
)


@singledispatch
def script(par: object) -> str:
    """The PAR as a Python script.

    A UPAR has the four functions of thesis 4.6.1; a complex PAR has its execution steps, whose
    parts prove their own conditions (thesis 4.6.2). Of an observation it is its complex PAR, in
    which each step names its own agent where several act.

    Raises:
        ParError: A parameter of a UPAR is no Python name.
    """
    raise TypeError(f"{type(par).__name__} has no script form")


@script.register
def _upar(par: Upar) -> str:
    names = ("self", par.agent, *par.objects)
    for name in names:
        if not name.isidentifier() or iskeyword(name):
            raise ParError(
                f"UPAR {par.name!r}: parameter {name!r} is no Python name; a script needs names "
                "such as agent, obj1"
            )
    parameters = ", ".join(names)
    prepared = ""
    for each in par.preparation:
        objects = _tuple(_term(name, names) for name in each.action.objects)
        fields = {"agents": par.agent, "objects": objects}
        if each.action.purpose:
            fields["purpose"] = repr(each.action.purpose)
        body = _indented(_indented(_returned("PRIMITIVE", _action(each.action.action, fields))))
        prepared += f"{INDENT}if not ({_test(each.condition, names)}):\n{body}"
    action = _action(par.name, {"agents": par.agent, "objects": _tuple(par.objects)})
    able = " and ".join(_test(each, names) for each in par.applicability) or "True"
    ended = " and ".join(_test(each, names) for each in par.core.termination) or "True"
    return "\n\n".join(
        [
            f"# {par.name!r}\n",
            TESTED.format(name="applicability_condition", parameters=parameters, test=able),
            f"def preparatory_spec({parameters}):\n{prepared}{INDENT}return 1\n",
            TESTED.format(name="termination_conditions", parameters=parameters, test=ended),
            f"def execution_steps({parameters}):\n{_indented(_returned('PRIMITIVE', action))}",
        ]
    )


@script.register
def _complex(par: ComplexPar) -> str:
    return _execution(par, {}, {})


@script.register
def _observed(observation: Observation) -> str:
    par, acting = observation.complex_par, performers(observation)
    if len(acting) < 2:
        return script(par)
    agents = {name: f"agent{index + 1}" for index, name in enumerate(acting)}
    whose = {each.ee: agents[observation.performer(each.ee)] for each in par.links}
    return _execution(par, agents, whose)


def _execution(par: ComplexPar, agents: Mapping[str, str], whose: Mapping[str, str]) -> str:
    """A complex PAR's script.

    Args:
        par: The PAR.
        agents: Of several agents the parameter for each; empty where there is one.
        whose: The parameter for the agent of each end-effector.
    """
    names = {name: f"obj{index + 1}" for index, name in enumerate(par.objects)}
    everyone = _tuple(agents.values()) if agents else "agent"

    def written(step: Step) -> str:
        return _step(step, names, par.name, whose.get(step.ee, everyone))

    sequences = [_nest("SEQUENCE", list(map(written, link.steps))) for link in par.links]
    whole = sequences[0] if len(sequences) == 1 else _nest("PARALLEL", sequences)
    if par.common:
        last = written(par.common)
        if len(par.links) == 1:
            whole = _nest("SEQUENCE", [*map(written, par.links[0].steps), last])
        else:
            whole = _nest("SEQUENCE", [whole, last])
    parameters = ", ".join(["self", *(agents.values() or ["agent"]), *names.values()])
    body = f"complex = {whole}\n{_returned('COMPLEX', 'complex')}"
    known = [*agents.items(), *names.items()]
    legend = "".join(f"# {new} was {old!r}\n" for old, new in known)
    head = f"from actionDef import *\n\n# {par.name!r}\n{legend}"
    return f"{head}\n\ndef execution_steps({parameters}):\n{_indented(body)}"


def _returned(kind: str, action: str) -> str:
    return f"actions = {{{kind!r}: {action}}}\nreturn actions\n"


def _step(step: Step, names: Mapping[str, str], parent: str, agents: str) -> str:
    fields = {
        "agents": agents,
        "objects": _tuple(names[each] for each in step.objects),
        "duration": repr(step.share),
        "purpose": repr(step.purpose),
        "EE": repr(step.ee),
        "ComplexParent": repr(parent),
    }
    if step.posture:
        fields["Posture"] = _tuple([repr(step.posture), repr(f"{step.posture}.post")])
    return _action(step.action, fields)


def _test(condition: Condition, names: Sequence[str]) -> str:
    """A condition as an expression; an odd kind is passed as a literal."""
    terms = ", ".join(_term(each, names) for each in condition.arguments)
    kind, action = condition.kind, condition.arguments[-1:]
    if kind == "capable":
        able = repr(action[0]) if action else "self.name"
        text = f"checkCapability({names[1]}, {able}, [{names[1]}])"
    elif kind == "duration":
        text = "elapsed(self) >= self.duration"
    else:
        plain = kind.isidentifier() and not iskeyword(kind)
        text = f"{kind if plain else f'holds({kind!r})'}({terms})"
    return text if condition.holds else f"not {text}"


def _term(argument: str, names: Iterable[str]) -> str:
    """A parameter by its name; everything else as a literal."""
    return argument if argument in names or argument == "EE" else repr(argument)


def _tuple(terms: Iterable[str]) -> str:
    listed = list(terms)
    return f"({', '.join(listed)}{',' if len(listed) == 1 else ''})"


def _action(name: str, fields: Mapping[str, str]) -> str:
    inner = ",\n".join(f"{key!r}: {value}" for key, value in fields.items())
    return f"({name!r}, {{\n{_indented(inner)}\n}})"


def _nest(kind: str, parts: Sequence[str]) -> str:
    inner = ",\n".join(parts)
    return f"({kind},\n{_indented(inner)},\n)" if parts else f"({kind},)"


def _indented(text: str) -> str:
    return "".join(f"{INDENT}{line}" for line in text.splitlines(keepends=True))
