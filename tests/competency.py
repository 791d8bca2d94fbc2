"""What knowledge engineers ask, as SPARQL of at most eight lines, beside the named questions."""

HELD_WHILE_TILTED = """
SELECT ?capture ?from ?to { ?o capar:fact ?h , ?t ; rdfs:label ?capture .
?h a capar:Touching ; capar:body/capar:side "right" ; capar:other/capar:name "whisk" .
?h capar:start ?a ; capar:end ?b .
?t a capar:Leaning ; capar:body/capar:name "bottle" ; capar:start ?c ; capar:end ?d .
BIND(IF(?a > ?c, ?a, ?c) AS ?from) BIND(IF(?b < ?d, ?b, ?d) AS ?to) FILTER(?from < ?to) }
"""
"""When did the right hand hold the whisk while the bottle was tilted?"""

INSIDE = """
SELECT DISTINCT ?capture ?name { ?o rdfs:label ?capture .
{ ?o capar:fact ?in . ?in a capar:Arrangement ; capar:arrangement "inside" }
UNION { ?o capar:segment/capar:placement ?in . ?in capar:preposition "in" }
?in capar:body/capar:name ?name ; capar:other/capar:kind/capar:isA/capar:name "container" }
"""
"""Which objects were ever inside a container?"""

TOUCHED_AND_UNMOVED = """
SELECT DISTINCT ?capture { ?o capar:segment ?s ; rdfs:label ?capture .
?s capar:action/capar:name "Touch" ; capar:dominant ?x ; capar:start ?a ; capar:end ?b .
FILTER NOT EXISTS { ?o capar:fact ?m . ?m a capar:Moving ; capar:body ?x .
?m capar:start ?c ; capar:end ?d . FILTER(?c <= ?b && ?a <= ?d) } }
"""
"""Which captures have a Touch that ended without the touched object having moved?"""

IN_TOUCH = """
SELECT ?capture ?a ?b { ?o capar:fact ?t ; rdfs:label ?capture .
?t a capar:Touching ; capar:body/capar:name "bottle" ; capar:other/capar:name "table" .
?t capar:start ?a ; capar:end ?b }
"""
"""When did bottle and table touch?"""

LOOKED_BEFORE = """
SELECT ?who ?object (MAX(?t - ?l) AS ?before) { ?o capar:fact ?look , ?grasp .
?look a capar:LookingAt ; capar:seen ?x ; capar:start ?l .
?grasp a capar:Touching ; capar:body ?hand ; capar:other ?x ; capar:start ?t .
?hand capar:effectorType "hand" ; capar:agent/rdfs:label ?who .
?x capar:name ?object . FILTER(?l < ?t) } GROUP BY ?o ?who ?object
"""
"""Who looked at an object before grasping it, and how long before at most?"""

REACHING_SPEEDS = """
SELECT ?address (capar:highestSpeed(?o, ?hand, ?a, ?b) AS ?speed) { ?o capar:segment ?s .
?s capar:action/capar:name "Reach" ; capar:address ?address ; capar:ofLink ?hand .
?hand capar:side "right" . ?s capar:start ?a ; capar:end ?b }
"""
"""Highest speed of the right hand in each Reach."""

QUERIES = {
    "held while tilted": HELD_WHILE_TILTED,
    "inside": INSIDE,
    "touched and unmoved": TOUCHED_AND_UNMOVED,
    "in touch": IN_TOUCH,
    "looked before": LOOKED_BEFORE,
    "reaching speeds": REACHING_SPEEDS,
}
