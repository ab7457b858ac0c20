"""Figures of the wave benchmark; see scripts/plot_wave.py."""
