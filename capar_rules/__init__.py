"""From facts to PARs: rules in logic, and the engine that asks the solver."""
