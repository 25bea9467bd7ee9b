// SPDX-License-Identifier: MIT
#include "haptics/servo/log/rewrite.h"

#include <unistd.h>

#include "haptics/servo/log/reader.h"

namespace catena::haptics::log {
namespace {

/// Returns the payload of a block with new scene texts.
Result<std::string> rewrite_payload(const BlockReader& block, const std::string& file, const RewriteText& rewrite) {
  const std::string_view payload = block.payload();
  if (block.type() == BlockType::header) {
    auto header = parse_header(payload);
    if (!header) return Error{file + ": the header is damaged; a complete recording was expected"};
    CATENA_TRY(header->scene_text, rewrite(header->scene_text));
    return to_bytes(*header);
  }
  if (block.type() == BlockType::program) {
    auto program = parse_program(payload);
    if (!program) return Error{file + ": a program is damaged; a complete recording was expected"};
    if (!program->scene_text) return std::string(payload);
    CATENA_TRY(program->scene_text, rewrite(*program->scene_text));
    return to_bytes(*program);
  }
  return std::string(payload);
}

Outcome copy_blocks(BlockReader& blocks, const std::string& file, BlockFile& out, const RewriteText& rewrite) {
  using Read = BlockReader::ReadResult;
  for (Read read = blocks.next(); read != Read::end && read != Read::truncated; read = blocks.next()) {
    if (read == Read::damaged) return Error{file + ": blocks are damaged; a complete recording was expected"};
    CATENA_TRY(const std::string payload, rewrite_payload(blocks, file, rewrite));
    if (!out.write(blocks.type(), payload)) return out.error();
  }
  return out.sync() && out.close() ? Outcome(Done{}) : out.error();
}

}  // namespace

Outcome rewrite_scene_texts(const std::string& from, const std::string& to, const RewriteText& rewrite) {
  CATENA_CHECK(LogReader::open(from));  // checks the preamble and the header
  CATENA_TRY(std::unique_ptr<ByteSource> source, open_file_source(from));
  CATENA_TRY(BlockFile out, BlockFile::create(to));
  BlockReader blocks(std::move(source));
  const Outcome copied = copy_blocks(blocks, from, out, rewrite);
  if (!copied) ::unlink(to.c_str());
  return copied;
}

}  // namespace catena::haptics::log
