"""Rules of users and what was observed with them: drafts, and what a change of rules does."""
