// SPDX-License-Identifier: MIT
/// Helper programs of Catena, each of which does one task in a process of its own. They are installed next to the program that starts them
/// or in the libexec folder. They receive no environment (except a setting that makes VTK single-threaded) and no descriptors other than
/// the given ones, and end with the thread that started them (each helper requests that itself).
#pragma once
#include <sys/types.h>

#include <functional>
#include <span>
#include <string>
#include <utility>

#include "engine/base/result.h"

namespace catena {

/// Returns the path of the helper NAME. Searched folders: the folder of libcatena.so where a program uses it, then the folder of the
/// running program; of each, the folder itself, ../libexec/catena and ../../libexec/catena. Returns the first that is executable, else the
/// first path searched.
std::string helper_path(const std::string& name);

/// Returns "at most 6 files may be open at a time (ulimit -n), expected at least 128", for a system error.
std::string descriptor_limit_message();

/// End of a helper process: cause, exit code and CPU time.
struct ProcessExit {
  /// End of the process: by itself, by a signal, or killed by wait() at its time limit.
  enum class Cause { exited, killed, timed_out } cause = Cause::exited;
  int code = 0;      ///< exit code, or number of the signal that ended it
  double cpu_s = 0;  ///< CPU time used, seconds
};

/// A running helper process. Owned by one object, which kills it when destroyed.
class HelperProcess {
 public:
  /// Starts the program at `path`; it receives `descriptors` as 3, 4, ... in this order, and /dev/null as standard input and output. Error
  /// (a system failure): the program is missing or cannot be started, or there are too few descriptors, processes or memory.
  static Result<HelperProcess> start(const std::string& path, std::span<const int> descriptors);
  HelperProcess(HelperProcess&& other) noexcept;
  HelperProcess& operator=(HelperProcess&&) = delete;
  /// Kills the process if it is still running.
  ~HelperProcess();

  /// Waits until the process ends, at most `limit_s` seconds; then kills it. `while_waiting` is called about once per second with the
  /// seconds elapsed.
  ProcessExit wait(double limit_s, const std::function<void(double)>& while_waiting = {});

 private:
  explicit HelperProcess(pid_t pid) : pid_(pid) {}
  pid_t pid_;
};

/// File descriptor with a single owner, closed on destruction.
class FileDescriptor {
 public:
  explicit FileDescriptor(int fd = -1) : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(other.fd_) { other.fd_ = -1; }
  FileDescriptor& operator=(FileDescriptor&& other) noexcept;
  ~FileDescriptor() { close(); }
  void close();
  int get() const { return fd_; }
  /// Returns the descriptor, which the caller then owns.
  int release() { return std::exchange(fd_, -1); }
  explicit operator bool() const { return fd_ >= 0; }

 private:
  int fd_;
};

}  // namespace catena
