// SPDX-License-Identifier: MIT
// Loads OpenVDB files from the response of the program catena-read, which is untrusted and validated here.
#include <fmt/format.h>

#include "engine/field/grid/grid_factory.h"
#include "engine/field/nanovdb/nano_statistics.h"
#include "engine/io/client.h"
#include "engine/io/formats.h"
#include "engine/io/volume/write_field.h"

namespace catena::field {
namespace {

/// Returns one buffer of the response, validated.
template <class T>
Result<NanoMemory> buffer_at(const NanoMemory& memory, const BufferRange& piece) {
  if (piece.offset % kBufferAlignment != 0 || piece.offset > memory.size() || piece.bytes > memory.size() - piece.offset)
    return Error{"the position of a buffer is invalid"};
  NanoMemory part = memory.slice(piece.offset, piece.bytes);
  CATENA_CHECK(validate_nano<T>({part.data(), part.size()}));
  return part;
}

template <class T>
Result<NanoBuffers> buffers_of(const MappedResponse& answer) {
  NanoBuffers buffers;
  CATENA_TRY(buffers.values, buffer_at<T>(answer.memory, answer.response.values));
  if (!answer.response.has_mask) return buffers;
  CATENA_TRY(buffers.valid_voxels, buffer_at<nanovdb::ValueMask>(answer.memory, answer.response.valid_voxels));
  CATENA_TRY(buffers.valid_cells, buffer_at<nanovdb::ValueMask>(answer.memory, answer.response.valid_cells));
  buffers.has_cell_mask = answer.response.has_cell_mask;
  return buffers;
}

template <class Grid>
Result<std::shared_ptr<const Grid>> grid_of(const std::string& path, const MappedResponse& answer) {
  const ReadResponse& reply = answer.response;
  if (!reply.mapping.is_invertible()) return damaged_response_error(path, "the transform cannot be inverted");
  auto buffers = buffers_of<typename GridValue<Grid>::Type>(answer);
  if (!buffers) return damaged_response_error(path, buffers.error().message);
  auto made = grid_from_buffers<Grid>(reply.name, reply.mapping, std::move(*buffers));
  if (!made) return Error{fmt::format("{}: grid \"{}\" {}", path, reply.name, made.error().message)};
  count_file();
  count_grid();
  if (reply.has_mask) count_mask();
  return made;
}

Result<AnyField> load_vdb(const LoadRequest& request) {
  CATENA_TRY(const MappedResponse answer, run_reader(ReadMode::load, request));
  AnyField field;
  if (answer.response.is_vector) {
    CATENA_TRY(field.vector, grid_of<VectorGrid>(request.path, answer));
  } else {
    CATENA_TRY(field.scalar, grid_of<ScalarGrid>(request.path, answer));
  }
  return field;
}

Outcome write_one_grid(const std::string& path, const AnyField& field, const std::string& name, const Units&) {
  return write_vdb(path, {{field, name}});
}

}  // namespace
}  // namespace catena::field

namespace catena::io {

Format vdb_format() {
  return {.name = "VDB grids",
          .extensions = {".vdb"},
          .volume = {.load = field::load_vdb, .describe = field::describe_with_reader, .units = field::read_vdb_units},
          .write_volume = field::write_one_grid,
          .has_cell_mask = true};
}

}  // namespace catena::io
