// SPDX-License-Identifier: MIT
// The program catena-read-chunks: reads a store of chunks for catena, box by box (engine/io/stores/store_protocol.h). Descriptor 3 is the
// shared memory, 4 the socket. The sandbox restricts it to the folder of the store.
#include <unistd.h>

#include "engine/io/chunks/answer_requests.h"

int main() {
  const int code = catena::chunks::answer_requests();
  static constexpr char kWho[] = "catena-read-chunks: reads stores for catena, which starts this program\n";
  if (code != 0 && ::write(STDERR_FILENO, kWho, sizeof kWho - 1) < 0) ::_exit(1);
  ::_exit(code);
}
