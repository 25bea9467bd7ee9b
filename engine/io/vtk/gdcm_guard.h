/// Private to this room: calls of GDCM on foreign files. Packaged GDCM checks its input by assertions, which would end the reader on the
/// first damaged file of a folder; here they end the call. One thread.
#pragma once
#include <functional>

namespace catena::vtk {

/// False: `call` ended by an exception or an assertion. After an assertion nothing that it made is destroyed: what it works on has to be
/// left alone, and is lost. The reader process is short-lived, and its memory is limited.
bool call_gdcm(const std::function<void()>& call);

}  // namespace catena::vtk
