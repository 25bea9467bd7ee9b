// SPDX-License-Identifier: MIT
// Replaces catena-read as a compromised reader, controlled by the requested "file": a file that begins with HANG, SPIN, EXIT, ABORT or
// KEEP (ends, but leaves a process that could write) is a command; any other content is returned unchanged as the response.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "engine/io/sandbox/response_file.h"

namespace {
constexpr int kAnswer = 3;

void copy(const std::string& text) {
  if (::ftruncate(kAnswer, 0) != 0 || ::pwrite(kAnswer, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size())) std::_Exit(4);
}
}  // namespace

int main() {
  const auto request = catena::sandbox::ResponseFile(kAnswer).read_request();
  if (!request) return 2;
  std::ifstream in(request->load_request.path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (text.starts_with("HANG"))
    for (;;) ::pause();
  if (text.starts_with("SPIN"))
    for (;;) ::getppid();
  if (text.starts_with("EXIT")) return 7;
  if (text.starts_with("ABORT")) std::abort();
  if (text.starts_with("KEEP")) {
    if (::mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, kAnswer, 0) == MAP_FAILED) return 4;
    if (::fork() == 0) {
      ::alarm(5);
      for (;;) ::pause();
    }
    return 0;
  }
  copy(text);
  return 0;
}
