/// What went wrong, in two kinds: a bug, which ends the program (CATENA_ASSERT), and an error of the outside world (Result).
///
/// A bug in Catena itself: checked in every build type, prints the place and aborts.
#pragma once
#include <cerrno>
#include <string>
#include <utility>
#include <variant>

namespace catena {
[[noreturn]] void assertion_failed(const char* expression, const char* file, int line);
}

#define CATENA_ASSERT(expression) ((expression) ? static_cast<void>(0) : ::catena::assertion_failed(#expression, __FILE__, __LINE__))

/// The outside world's answer: a value, or one sentence that a person can act on. Never thrown, never used in a tick.
namespace catena {

struct Error {
  std::string message;   ///< one line: file, line, what, and what was expected
  bool machine = false;  ///< this machine does not give what is needed (a thread, memory): no fault of the input
};

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  explicit operator bool() const { return state_.index() == 0; }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(value()); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  T& value() {
    CATENA_ASSERT(state_.index() == 0);
    return std::get<0>(state_);
  }
  const T& value() const {
    CATENA_ASSERT(state_.index() == 0);
    return std::get<0>(state_);
  }
  const Error& error() const {
    CATENA_ASSERT(state_.index() == 1);
    return std::get<1>(state_);
  }

 private:
  std::variant<T, Error> state_;
};

/// An operation without a value: empty on success.
struct Done {};
using Outcome = Result<Done>;

}  // namespace catena

/// Takes the value out of a Result or returns its error from the function around it.
#define CATENA_CONCAT_(a, b) a##b
#define CATENA_CONCAT(a, b) CATENA_CONCAT_(a, b)
#define CATENA_TRY_(temporary, declaration, expression) \
  auto temporary = (expression);                        \
  if (!temporary) return temporary.error();             \
  declaration = std::move(*temporary)
#define CATENA_TRY(declaration, expression) CATENA_TRY_(CATENA_CONCAT(try_result_, __LINE__), declaration, expression)
#define CATENA_CHECK(expression) \
  if (auto check_result = (expression); !check_result) return check_result.error()

/// Whether a file cannot be opened because this process, or the machine, may have no more open: an error of the machine, not of the file.
namespace catena {

inline bool too_many_files(int code) { return code == EMFILE || code == ENFILE; }

}  // namespace catena
