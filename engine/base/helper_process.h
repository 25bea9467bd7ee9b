/// ProgramLookup of Catena that do one thing in a process of their own. They lie beside the program that starts them or in the libexec
/// folder of what is installed, get no environment and no descriptors but the ones that they are given, and die with the thread that
/// started them (they ask for that themselves).
#pragma once
#include <sys/types.h>

#include <functional>
#include <span>
#include <string>
#include <utility>

#include "engine/base/result.h"

namespace catena {

/// NAME in the folder of libcatena.so where a program uses that, or of the running program, or in ../libexec/catena or ../../libexec/catena
/// seen from there: the first that can be started, else the first of these places.
std::string helper_path(const std::string& name);

/// "at most 6 files may be open at a time (ulimit -n), expected at least 128": for an error of the machine.
std::string descriptor_limit_message();

struct ProcessExit {
  enum class Cause { exited, killed, timed_out } cause = Cause::exited;
  int code = 0;      ///< of the exit, or the signal's number
  double cpu_s = 0;  ///< processor time that it took
};

class HelperProcess {
 public:
  /// Starts the program at `path`; it finds `descriptors` as 3, 4, ... in this order. An error says why it cannot be started: an error of
  /// the machine where it gives too few descriptors, processes or memory.
  static Result<HelperProcess> start(const std::string& path, std::span<const int> descriptors);
  HelperProcess(HelperProcess&& other) noexcept;
  HelperProcess& operator=(HelperProcess&&) = delete;
  ~HelperProcess();  ///< kills what still runs

  /// Waits for its end, at most so long; then it is killed. `while_waiting` is called about once a second with the seconds so far.
  ProcessExit wait(double limit_s, const std::function<void(double)>& while_waiting = {});

 private:
  explicit HelperProcess(pid_t pid) : pid_(pid) {}
  pid_t pid_;
};

/// A descriptor with one owner.
class FileDescriptor {
 public:
  explicit FileDescriptor(int fd = -1) : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(other.fd_) { other.fd_ = -1; }
  FileDescriptor& operator=(FileDescriptor&& other) noexcept;
  ~FileDescriptor() { close(); }
  void close();
  int get() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }
  explicit operator bool() const { return fd_ >= 0; }

 private:
  int fd_;
};

}  // namespace catena
