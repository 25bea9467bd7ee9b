# SPDX-License-Identifier: MIT
# A command on a virtual display of its own: sh on_display.sh SCREEN COMMAND...
# The server chooses its own number, so that two tests at once never take the same, and stays when its last program has ended.
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
