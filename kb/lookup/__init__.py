"""What the Actionary's methods do, one file a concern; each asks or changes a store."""
