"""Why a segment has its name, and why not another."""
