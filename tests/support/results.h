// SPDX-License-Identifier: MIT
/// Values, errors and texts in assertions.
#pragma once
#include <gtest/gtest.h>

#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>

#include "engine/base/result.h"

namespace catena::test {

/// Success if the text contains the part.
inline testing::AssertionResult has(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "\"" << part << "\" is not in: " << text;
}

/// The message of an error; empty for a value.
template <class R>
std::string message_of(const R& result) {
  return result ? std::string() : result.error().message;
}

/// The value; an error ends the test case with its message.
template <class T>
T value_of(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}
template <class T>
T value_of(std::optional<T> value) {
  if (!value) throw std::runtime_error("there is no value");
  return std::move(*value);
}

/// Success if the result is an error of one line that contains the part.
template <class R>
testing::AssertionResult fails(const R& result, const std::string& part) {
  if (result) return testing::AssertionFailure() << "a value, and no error with: " << part;
  if (message_of(result).find('\n') != std::string::npos) return testing::AssertionFailure() << "several lines: " << message_of(result);
  return has(message_of(result), part);
}

/// Expects an error of one line that contains all parts.
template <class R>
void expect_error(const R& result, std::initializer_list<std::string> parts) {
  for (const std::string& part : parts) EXPECT_TRUE(fails(result, part));
}

}  // namespace catena::test
