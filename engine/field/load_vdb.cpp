// OpenVDB files, as the program catena-read hands them over. What it wrote is believed as far as it is checked here.
#include <fmt/format.h>

#include "engine/field/formats.h"
#include "engine/field/grid_make.h"
#include "engine/field/nano_stats.h"
#include "engine/field/reader.h"

namespace catena::field {
namespace {

/// One buffer of the answer, checked.
template <class T>
Result<NanoMemory> buffer_at(const NanoMemory& memory, const Piece& piece) {
  if (piece.offset % kPieceAlignment != 0 || piece.offset > memory.size() || piece.bytes > memory.size() - piece.offset)
    return Error{"the place of a buffer is not what it must be"};
  NanoMemory part = memory.part(piece.offset, piece.bytes);
  CATENA_CHECK(check_nano<T>({part.data(), part.size()}));
  return part;
}

template <class T>
Result<NanoBuffers> buffers_of(const ReaderAnswer& answer) {
  NanoBuffers buffers;
  CATENA_TRY(buffers.values, buffer_at<T>(answer.memory, answer.reply.values));
  if (!answer.reply.masked) return buffers;
  CATENA_TRY(buffers.voxels, buffer_at<nanovdb::ValueMask>(answer.memory, answer.reply.voxels));
  CATENA_TRY(buffers.cells, buffer_at<nanovdb::ValueMask>(answer.memory, answer.reply.cells));
  buffers.cells_masked = answer.reply.cells_masked;
  return buffers;
}

template <class Grid>
Result<std::shared_ptr<const Grid>> grid_of(const std::string& path, const ReaderAnswer& answer) {
  const ReadReply& reply = answer.reply;
  if (!reply.mapping.is_sound()) return damaged_answer(path, "the transform cannot be inverted");
  auto buffers = buffers_of<typename GridValue<Grid>::Type>(answer);
  if (!buffers) return damaged_answer(path, buffers.error().message);
  auto made = grid_from_buffers<Grid>(reply.name, reply.mapping, std::move(*buffers));
  if (!made) return Error{fmt::format("{}: grid \"{}\" {}", path, reply.name, made.error().message)};
  count_file();
  count_grid();
  if (reply.masked) count_mask();
  return made;
}

}  // namespace

static Result<AnyField> load_vdb(const LoadRequest& request) {
  CATENA_TRY(const ReaderAnswer answer, ask_reader(ReadMode::load, request));
  AnyField field;
  if (answer.reply.is_vector) {
    CATENA_TRY(field.vector, grid_of<VectorGrid>(request.path, answer));
  } else {
    CATENA_TRY(field.scalar, grid_of<ScalarGrid>(request.path, answer));
  }
  return field;
}

FileFormat vdb_format() { return {.endings = {".vdb"}, .load = load_vdb, .describe = describe_answered, .units = vdb_units}; }

}  // namespace catena::field
