"""Voronoi cells of robots within a region, and what is integrated over them."""

from __future__ import annotations
