// SPDX-License-Identifier: MIT
/// Two kinds of failure: a bug in Catena, which aborts the program (CATENA_ASSERT), and an error caused by input or by the system (Result).
#pragma once
#include <cerrno>
#include <string>
#include <utility>
#include <variant>

#include "engine/base/export.h"

namespace catena {
/// Prints the failed expression with its file and line to stderr and aborts. Called by CATENA_ASSERT.
[[noreturn]] CATENA_EXPORT void assertion_failed(const char* expression, const char* file, int line);
}  // namespace catena

/// Aborts with a message unless the expression holds, in every build type. For bugs in Catena only, never for invalid input.
#define CATENA_ASSERT(expression) ((expression) ? static_cast<void>(0) : ::catena::assertion_failed(#expression, __FILE__, __LINE__))

namespace catena {

/// Description of an error.
struct Error {
  std::string message;          ///< one line: file, line, what is wrong, and what was expected
  bool system_failure = false;  ///< true: the system does not provide a resource (a thread, memory, disk space); the input is not at fault
};

/// Result of an operation that can fail because of input or the system: a value, or an Error that the user can act on. Never thrown; not
/// used in a haptic tick. Access to the alternative that is not present is a bug and aborts.
template <class T>
class [[nodiscard]] Result {
 public:
  /// Success with a value.
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  /// Failure.
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  /// Returns true when there is a value.
  explicit operator bool() const { return state_.index() == 0; }
  /// Returns the value; aborts when there is an error.
  T& operator*() & { return value(); }
  /// Returns the value; aborts when there is an error.
  const T& operator*() const& { return value(); }
  /// Returns the value to be moved from; aborts when there is an error.
  T&& operator*() && { return std::move(value()); }
  /// Accesses a member of the value; aborts when there is an error.
  T* operator->() { return &value(); }
  /// Accesses a member of the value; aborts when there is an error.
  const T* operator->() const { return &value(); }
  /// Returns the value; aborts when there is an error.
  T& value() {
    CATENA_ASSERT(state_.index() == 0);
    return std::get<0>(state_);
  }
  /// Returns the value; aborts when there is an error.
  const T& value() const {
    CATENA_ASSERT(state_.index() == 0);
    return std::get<0>(state_);
  }
  /// Returns the error; aborts when there is a value.
  const Error& error() const {
    CATENA_ASSERT(state_.index() == 1);
    return std::get<1>(state_);
  }

 private:
  std::variant<T, Error> state_;
};

/// Value of an operation that returns nothing.
struct Done {};
/// Result of an operation that returns nothing: success (`return Done{};`) or an Error.
using Outcome = Result<Done>;

}  // namespace catena

// implementation of CATENA_TRY
#define CATENA_CONCAT_(a, b) a##b
#define CATENA_CONCAT(a, b) CATENA_CONCAT_(a, b)
#define CATENA_TRY_(temporary, declaration, expression) \
  auto temporary = (expression);                        \
  if (!temporary) return temporary.error();             \
  declaration = std::move(*temporary)
/// CATENA_TRY(const double x, read_number(text)): declares x with the value of a Result, or returns the Result's error from the enclosing
/// function.
#define CATENA_TRY(declaration, expression) CATENA_TRY_(CATENA_CONCAT(try_result_, __LINE__), declaration, expression)
/// Returns the error of an Outcome or Result from the enclosing function; continues on success.
#define CATENA_CHECK(expression) \
  if (auto check_result = (expression); !check_result) return check_result.error()

namespace catena {

/// Returns true when errno `code` means that this process or the system has too many open files (EMFILE, ENFILE): a system failure, not an
/// error of the file.
inline bool is_too_many_open_files(int code) { return code == EMFILE || code == ENFILE; }

}  // namespace catena
