"""From captures to observations, explanations and reports: one short function a stage."""
