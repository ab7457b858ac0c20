"""Both programs of scripts/compare-peers on the same scenes."""
