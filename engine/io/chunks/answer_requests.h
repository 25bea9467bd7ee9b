// SPDX-License-Identifier: MIT
/// The loop of the reader process: receives requests, answers each, and ends with the connection.
#pragma once
#include <string>

namespace catena::chunks {

/// Answers requests until the connection closes. Returns the exit code.
int answer_requests();

}  // namespace catena::chunks
