"""An Actionary over HTTP: the SPARQL 1.1 protocol and the named questions as JSON."""
