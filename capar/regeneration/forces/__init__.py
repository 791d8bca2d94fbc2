"""Things that another body sets going: the force it gives them, and how they move on alone."""
