"""Tournaments: who plays whom, how a match went, who stands first, and the page that shows it."""
