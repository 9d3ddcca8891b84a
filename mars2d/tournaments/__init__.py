"""Tournaments: schedule, matches, standings, and the page that shows them."""
