"""What moves what: a reason for every motion of every mobile object, or that there is none."""
