"""The ground floor: what knows no robot."""
