# Installation and package files: filled in by the packaging step.
