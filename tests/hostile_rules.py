"""Rule files that are malformed or mean harm: made by hand, and by mutation with a fixed seed."""

import random
from collections.abc import Iterator
from pathlib import Path

SOUND = """%* Hoist: a possessed object is lifted with a turn. *%
primitive("Hoist").
specialises("Hoist", "Lift").
verb("Hoist", "hoist").
fits(Segment, "Hoist") :-
    fits(Segment, "Lift"),
    rises(Segment, Object),
    from_rest(Segment),
    spins(Segment, Object).
"""

_HEAD = '%* Bad: bad. *%\nprimitive("Bad").\n'

BY_HAND = {
    "script_python": '#script (python)\nimport os\nos.system("touch HARMED")\n#end.\n',
    "script_lua": '#script (lua)\nos.execute("touch HARMED")\n#end.\n',
    "script_later": _HEAD + "a.\n#script(python)\nopen('HARMED','w')\n#end.\n",
    "at_function": _HEAD + 'fits(S, "Bad") :- segment(S, _, _), X = @run("touch HARMED").\n',
    "at_in_head": _HEAD + "p(@run(1)).\n",
    "include_passwd": '#include "/etc/passwd".\n',
    "include_above": _HEAD + '#include "../../secret.lp".\n',
    "include_device": '#include "/dev/zero".\n',
    "include_library": "#include <incmode>.\n",
    "include_odd": '#include\n"/dev/zero"\n.\n',
    "include_self": '#include "include_self.lp".\n' + _HEAD,
    "include_hidden": '%*x*%#include "/etc/passwd".%*y*%\n',
    "explodes": _HEAD + "p(1..1000000).\nq(X,Y,Z) :- p(X), p(Y), p(Z).\n",
    "explodes_in_body": _HEAD + 'fits(S, "Bad") :- segment(S,_,_), X = 1..2000000000, X * X = 7.\n',
    "endless": _HEAD + "p(0).\np(X + 1) :- p(X).\n",
    "endless_terms": _HEAD + "p(a).\np(f(X)) :- p(X).\n",
    "endless_text": _HEAD + "p((X, X)) :- p(X).\np(1).\n",
    "hard": _HEAD + "n(1..9).\n{ at(P, H) : n(H) } = 1 :- n(P).\n:- at(P, H), at(Q, H), P < Q.\n",
    "choice": _HEAD + "{ p }.\n",
    "choice_of_names": _HEAD + '{ fits(S, "Bad") } :- segment(S, _, _).\n',
    "disjunction": _HEAD + "p ; q.\n",
    "constraint": _HEAD + ":- segment(_, _, _).\n",
    "weak_constraint": _HEAD + ":~ segment(S, _, _). [1, S]\n",
    "minimize": _HEAD + "#minimize { 1, S : segment(S, _, _) }.\n",
    "even_loop": _HEAD + "p :- not q.\nq :- not p.\n",
    "odd_loop": _HEAD + "p :- not p.\n",
    "loop_through_names": _HEAD + 'fits(S, "Bad") :- segment(S, _, _), not named(S, "Reach").\n',
    "loop_through_unknown": _HEAD + 'fits(S, "Bad") :- unknown(S).\n',
    "loop_through_count": _HEAD
    + 'fits(S, "Bad") :- segment(S,_,_), 0 = #count { N : fits(S, N) }.\n',
    "external": _HEAD + "#external p.\n",
    "hides": _HEAD + "#show.\n",
    "shows": _HEAD + "#show segment/3.\n",
    "projects": _HEAD + "#project segment/3.\n",
    "steers": _HEAD + "#heuristic p. [1, true]\n",
    "edge": _HEAD + "#edge (1, 2).\n",
    "program_part": _HEAD + "#program check(t).\np(t).\n",
    "theory": "#theory t { x { - : 1, unary }; &a/0 : x, any }.\n" + _HEAD,
    "theory_atom": _HEAD + "p :- &sum { 1 } <= 2.\n",
    "const_taken": _HEAD + "#const merge_ms = 0.\n",
    "redefines": _HEAD + "reads(a, b, c, d, e).\n",
    "redefines_input": _HEAD + "touching(a, b, 1, 2).\n",
    "redefines_named": _HEAD + 'named(S, "Bad") :- segment(S, _, _).\n',
    "renames_reach": 'primitive("Reach").\nfits(S, "Reach") :- segment(S, _, _).\n',
    "speaks_for_others": _HEAD + 'fits(S, "Reach") :- segment(S, _, _).\n',
    "any_name": _HEAD + "fits(S, Name) :- segment(S, _, _), primitive(Name).\n",
    "circle": _HEAD + 'specialises("Bad", "Bad").\n',
    "unsafe": _HEAD + 'fits(S, "Bad") :- not known(S).\n',
    "unknown_word": _HEAD + 'fits(S, "Bad") :- featurs(S, _, _, _, _).\n',
    "wrong_arity": _HEAD + 'fits(S, "Bad") :- features(S, "1").\n',
    "wrong_bits": _HEAD + 'feature_row("Bad", any, "10", "1", "1", "0").\n',
    "no_bits": _HEAD + 'feature_row("Bad", any, "a", "b", "c", "d").\n',
    "variables_in_row": _HEAD + "feature_row(A, B, C, D, E, F) :- feature_row(A, B, C, D, E, F).\n",
    "always": _HEAD + 'fits(S, "Bad") :- segment(S, _, _).\n',
    "never": _HEAD + 'fits(S, "Bad") :- segment(S, X, _), X < 0, X > 0.\n',
    "no_full_stop": _HEAD + 'fits(S, "Bad") :- segment(S, _, _)',
    "open_string": _HEAD + 'verb("Bad", "bad).\n',
    "open_comment": "%* never closed\n" + _HEAD,
    "empty": "",
    "spaces": " \n\t\n",
    "only_comment": "% nothing\n",
    "zero_byte": _HEAD + "p\0.\n",
    "long_line": _HEAD + "p(" + "1," * 50_000 + "1).\n",
    "long_name": _HEAD + "p" * 100_000 + ".\n",
    "deep_brackets": _HEAD + "p(" * 20_000 + "1" + ")" * 20_000 + ".\n",
    "deep_minus": _HEAD + "p(" + "-" * 50_000 + "1).\n",
    "deep_not": _HEAD + "p :- " + "not " * 2_000 + "segment(a, b, c).\n",
    "long_sum": _HEAD + "p(" + "1+" * 20_000 + "1).\n",
    "big_number": _HEAD + "p(99999999999999999999999999).\n",
    "division_by_zero": _HEAD + 'fits(S, "Bad") :- segment(S, X, _), Y = X / 0, Y > 0.\n',
    "power": _HEAD + 'fits(S, "Bad") :- segment(S, _, _), X = 9 ** 9 ** 9 ** 9, X > 0.\n',
    "many_rules": _HEAD + "".join(f"p({n}) :- p({n + 1}).\n" for n in range(5_000)),
    "classical_negation": _HEAD + "-p :- p.\np.\n-p.\n",
    "bom": "\ufeff" + SOUND,
    "windows_lines": SOUND.replace("\n", "\r\n"),
    "not_a_program": "Lift is when the mug goes up.\n",
    "html": "<html><body>404</body></html>\n",
}
"""Each by what it tries."""

BYTES = {
    "latin_1": "%* Bad: \xe9. *%\n".encode("latin-1"),
    "binary": bytes(range(256)) * 16,
    "too_large": b"% padding\n" * 40_000,
    "utf_16": SOUND.encode("utf-16"),
}

_TOKENS = [
    ":-", ".", ",", "(", ")", "not ", '"', "#", "@", "%", "%*", "*%", "{", "}", ";", "|", "_", "&",
    "#include ", "#script", "#sum", "#count { X : p(X) }", "1..9", "**", "-1", "Segment", "fits",
    "segment", "\n", "\\", "~", "#false", "#sup", "\x07", "é", "=", "<", ":~", "#const x = ",
]  # fmt: skip


def rule_files(count: int, *, seed: int = 7) -> Iterator[tuple[str, bytes]]:
    """So many files, those made by hand first; the same ones each time."""
    made = [(name, text.encode()) for name, text in sorted(BY_HAND.items())]
    made += sorted(BYTES.items())
    yield from made[:count]
    chance = random.Random(seed)
    for number in range(max(count - len(made), 0)):
        yield f"mutant_{number}", _mutant(chance).encode("utf-8", "surrogatepass")


def _mutant(chance: random.Random) -> str:
    text = chance.choice([SOUND, *BY_HAND_SHORT])
    for _ in range(chance.randint(3, 12)):
        at, end = sorted((chance.randrange(len(text) + 1), chance.randrange(len(text) + 1)))
        match chance.randrange(5):
            case 0:
                text = text[:at] + text[min(at + chance.randint(1, 8), len(text)) :]
            case 1:
                text = text[:at] + chance.choice(_TOKENS) + text[at:]
            case 2:
                text = text[:at] + text[at : min(end, at + 60)] * 2 + text[at:]
            case 3:
                text = text[:at] + chr(chance.randrange(32, 127)) + text[at + 1 :]
            case 4:
                other = chance.choice([SOUND, *BY_HAND_SHORT])
                begin = chance.randrange(len(other))
                text = text[:at] + other[begin : begin + chance.randint(1, 60)] + text[at:]
    return text


BY_HAND_SHORT = [each for _, each in sorted(BY_HAND.items()) if 0 < len(each) < 400]


def write_all(folder: Path, count: int) -> list[Path]:
    """The files in a folder, in order."""
    paths = []
    for name, content in rule_files(count):
        path = folder / f"{name}.lp"
        path.write_bytes(content)
        paths.append(path)
    return paths
