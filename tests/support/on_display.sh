# SPDX-License-Identifier: MIT
# Runs a command on a new virtual display: sh on_display.sh SCREEN COMMAND...
# The server chooses its display number, so that concurrent tests never share one, and keeps running after its last client.
screen=$1
shift
number=$(mktemp)
Xvfb -displayfd 3 -screen 0 "$screen" -nolisten tcp -noreset $CATENA_XVFB 3> "$number" 2> /dev/null &
server=$!
for i in $(seq 200); do test -s "$number" && break; sleep 0.05; done
DISPLAY=:$(cat "$number") "$@"
result=$?
kill $server
wait $server 2> /dev/null
rm -f "$number"
exit $result
