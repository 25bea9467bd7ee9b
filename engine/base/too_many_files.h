/// Whether a file cannot be opened because this process, or the machine, may have no more open: an error of the machine, not of the file.
#pragma once
#include <cerrno>

namespace catena {

inline bool too_many_files(int code) { return code == EMFILE || code == ENFILE; }

}  // namespace catena
