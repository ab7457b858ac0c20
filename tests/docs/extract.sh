#!/bin/bash
# extract.sh DOCUMENT FOLDER: writes the code of a Markdown document into FOLDER. A block after "<!-- file: NAME -->" goes to
# NAME; the blocks after "<!-- tested -->" go to commands.sh, in their order.
set -eu
mkdir -p "$2"
: > "$2/commands.sh"
awk -v folder="$2" '
  /^<!-- tested -->$/ { target = folder "/commands.sh"; next }
  /^<!-- file: .* -->$/ {
    target = folder "/" $3
    directory = target
    sub(/\/[^\/]*$/, "", directory)
    system("mkdir -p \"" directory "\"; : > \"" target "\"")
    next
  }
  /^```/ {
    if (inside) { inside = 0; target = ""; close(written) }
    else { inside = 1; written = target }
    next
  }
  inside && target != "" { print >> target }
' "$1"
