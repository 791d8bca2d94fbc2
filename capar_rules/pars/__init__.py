"""From atoms to segments, PARs and one complex PAR."""
