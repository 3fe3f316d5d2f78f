#!/bin/bash
# SPDX-License-Identifier: BSL-1.0
# usage: NYSALT=PROGRAM without_resume.sh ARGUMENT...; the program without --resume, which kills.py must find.
for argument; do
  shift
  [[ $argument == --resume ]] || set -- "$@" "$argument"
done
exec "$NYSALT" "$@"
