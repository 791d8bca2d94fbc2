"""What an Actionary knows: observations, actions, agents, objects, places and styles."""
