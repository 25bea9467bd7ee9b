/// What catena-read does once it is shut in: one answer to one request.
#pragma once
#include <span>

#include "engine/reader/answer_file.h"

namespace catena::vdb {

/// Nothing is thrown: what is wrong with the file is the reply's error, a whole sentence.
field::ReadReply answer(const field::ReadRequest& request, std::span<const std::byte> file, reader::AnswerFile& out);

}  // namespace catena::vdb
