"""What an explanation claims, as curves of the recording: a panel for each quantity."""
