"""Figures of the cantilever benchmark; see scripts/plot_cantilever.py."""
