#!/bin/sh
# compile.sh OBJECT COMMAND...: runs a compiler and keeps what it warns of in OBJECT.warnings. So a user's build goes on
# whatever a compiler thinks, and ./check, which tests that very build, fails on a warning without compiling anew.
object=$1
shift
"$@" 2>"$object.said"
status=$?
cat "$object.said" >&2
if [ "$status" = 0 ] && [ -s "$object.said" ]; then
    mv -f "$object.said" "$object.warnings"
else
    rm -f "$object.said" "$object.warnings"
fi
exit "$status"
