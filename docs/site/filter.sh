#!/bin/sh
# What Doxygen reads instead of a header: filter.sh FILE. Its source pages show the header as it is.
cat "$NYSALT_SITE/staged/${1#"$PWD/"}"
