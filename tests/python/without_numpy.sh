#!/bin/sh
# A Python that has no numpy.
exec /usr/bin/python3 -S "$@"
