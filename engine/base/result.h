/// What went wrong, in two kinds: a bug, which ends the program (CATENA_ASSERT), and an error of the outside world (Result).
///
/// A bug in Catena itself: checked in every build type, prints the place and aborts.
#pragma once
#include <cerrno>
#include <string>
#include <utility>
#include <variant>

namespace catena {
/// Prints the expression and its place to stderr and aborts. Called by CATENA_ASSERT.
[[noreturn]] void assertion_failed(const char* expression, const char* file, int line);
}  // namespace catena

/// Prints the place and aborts unless the expression holds, in every build type. For bugs in Catena, never for what comes from outside.
#define CATENA_ASSERT(expression) ((expression) ? static_cast<void>(0) : ::catena::assertion_failed(#expression, __FILE__, __LINE__))

namespace catena {

/// Why something could not be done.
struct Error {
  std::string message;          ///< one line: file, line, what, and what was expected
  bool system_failure = false;  ///< this machine does not give what is needed (a thread, memory): no fault of the input
};

/// The outside world's answer: a value, or one sentence that a person can act on. Never thrown, never used in a tick. Asking for the one
/// that is not there is a bug and aborts.
template <class T>
class [[nodiscard]] Result {
 public:
  /// Success.
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  /// Failure.
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  /// Whether there is a value.
  explicit operator bool() const { return state_.index() == 0; }
  /// The value.
  T& operator*() & { return value(); }
  /// The value.
  const T& operator*() const& { return value(); }
  /// The value, moved out.
  T&& operator*() && { return std::move(value()); }
  /// A member of the value.
  T* operator->() { return &value(); }
  /// A member of the value.
  const T* operator->() const { return &value(); }
  /// The value; aborts where there is an error.
  T& value() {
    CATENA_ASSERT(state_.index() == 0);
    return std::get<0>(state_);
  }
  /// The value; aborts where there is an error.
  const T& value() const {
    CATENA_ASSERT(state_.index() == 0);
    return std::get<0>(state_);
  }
  /// The error; aborts where there is a value.
  const Error& error() const {
    CATENA_ASSERT(state_.index() == 1);
    return std::get<1>(state_);
  }

 private:
  std::variant<T, Error> state_;
};

/// An operation without a value: empty on success.
struct Done {};
/// Success without a value (`return Done{};`), or an Error.
using Outcome = Result<Done>;

}  // namespace catena

// how CATENA_TRY is made
#define CATENA_CONCAT_(a, b) a##b
#define CATENA_CONCAT(a, b) CATENA_CONCAT_(a, b)
#define CATENA_TRY_(temporary, declaration, expression) \
  auto temporary = (expression);                        \
  if (!temporary) return temporary.error();             \
  declaration = std::move(*temporary)
/// CATENA_TRY(const double x, read_number(text)): takes the value out of a Result, or returns its error from the function around it.
#define CATENA_TRY(declaration, expression) CATENA_TRY_(CATENA_CONCAT(try_result_, __LINE__), declaration, expression)
/// Goes on where an Outcome or Result is a success, or returns its error from the function around it.
#define CATENA_CHECK(expression) \
  if (auto check_result = (expression); !check_result) return check_result.error()

namespace catena {

/// Whether a file cannot be opened because this process, or the machine, may have no more open (EMFILE, ENFILE of errno): an error of the
/// machine, not of the file.
inline bool is_too_many_open_files(int code) { return code == EMFILE || code == ENFILE; }

}  // namespace catena
