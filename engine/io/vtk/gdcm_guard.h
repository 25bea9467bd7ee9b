// SPDX-License-Identifier: MIT
/// Private to this module: guarded calls of GDCM on untrusted files. Packaged GDCM validates its input by assertions, which would end the
/// reader at the first damaged file of a folder; here they end the call only. One thread.
#pragma once
#include <functional>

namespace catena::vtk {

/// Runs `call`. Returns false when it ended by an exception or an assertion; std::bad_alloc is rethrown. After an assertion no destructor
/// has run: the objects in use must not be touched and are leaked. The reader process is short-lived, and its memory is limited.
bool call_gdcm(const std::function<void()>& call);

}  // namespace catena::vtk
