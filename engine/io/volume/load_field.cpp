// SPDX-License-Identifier: MIT
#include "engine/io/volume/load_field.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <new>

#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/base/threads.h"
#include "engine/field/bricks/paged_grid.h"
#include "engine/field/field_display_range.h"
#include "engine/io/formats.h"
#include "engine/io/stores/load_store.h"
#include "engine/io/volume/crop.h"
#include "engine/io/volume/downsample.h"
#include "engine/io/volume/transform.h"
#include "engine/io/volume/unsupported_formats.h"

namespace catena::field {
namespace {

std::atomic<std::uint64_t> files{0}, grids{0}, masks{0};

/// Converts the exceptions of libraries to Errors: none leaves this module.
template <class T, class Body>
Result<T> guarded(const std::string& path, const Body& body) {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    if (resource_limit(RLIMIT_AS)) return Error{path + ": there is not enough memory to read the file: " + describe_errno(ENOMEM), true};
    return Error{fmt::format("{}: there is not enough memory to read the file, or the file is damaged", path)};
  } catch (const std::exception& e) {
    if (is_thread_start_failure(e)) return Error{path + ": no other thread can be started: " + describe_errno(thread_start_errno()), true};
    return Error{fmt::format("{}: the file is damaged or its type is unknown ({})", path, one_line(e.what()))};
  } catch (...) {
    return Error{fmt::format("{}: the file is damaged or its type is unknown", path)};
  }
}

/// Returns whether all corners of the grid are finite; they may be infinite even if each number of the transform is finite.
bool has_finite_box(const Field& field) {
  bool finite = std::isfinite(field.domain_length());
  for (int i = 0; i < 8; ++i) finite = finite && is_finite(field.corner(i));
  return finite;
}

/// Returns a message fragment on the probable cause if the largest magnitude is outside of 1e-30 .. 1e30.
std::string magnitude_hint(const AnyField& field) {
  const GridStats* stats = field.scalar && field.scalar->grid()   ? &field.scalar->grid()->stats()
                           : field.vector && field.vector->grid() ? &field.vector->grid()->stats()
                                                                  : nullptr;
  if (stats == nullptr) return {};
  const double max_magnitude = std::max(std::fabs(stats->min), std::fabs(stats->max));
  constexpr double kSmallest = 1e-30, kLargest = 1e30;
  if (max_magnitude == 0 || (max_magnitude >= kSmallest && max_magnitude <= kLargest)) return {};
  return fmt::format(
      "the values range from {:.3g} to {:.3g}: unless this is intended, the number type or the byte order is wrong, or a special value "
      "marks missing data",
      stats->min, stats->max);
}

/// Leaves out the finest level, with a note.
void leave_paged(AnyField& field, const std::string& cause) {
  if (field.paged) field.notes.push_back(fmt::format("with {}, links feel this level too, not the finest one", cause));
  field.paged.reset();
}

Error unknown_kind(const std::string& path) {
  if (const std::string conversion = conversion_hint(path); !conversion.empty())
    return Error{fmt::format("{}: this is {}", path, conversion)};
  return Error{fmt::format("{}: unknown file type, expected {}", path, io::describe_expected(io::DataKind::volume))};
}

}  // namespace

Result<AnyField> with_cubic_interpolation(AnyField field, const std::string& path) {
  const auto with_path = [&](const Error& e) { return Error{fmt::format("{}: {}", path, e.message)}; };
  if (field.scalar && field.scalar->grid()) {
    auto cubic = field.scalar->grid()->as_cubic();
    if (!cubic) return with_path(cubic.error());
    field.scalar = *cubic;
    leave_paged(field, "cubic interpolation");
  }
  if (field.vector && field.vector->grid()) {
    auto cubic = field.vector->grid()->as_cubic();
    if (!cubic) return with_path(cubic.error());
    field.vector = *cubic;
  }
  return field;
}

Result<AnyField> load_dense(const DenseFile& file) {
  AnyField field;
  if (file.components == 3) {
    CATENA_TRY(field.vector, make_dense_grid<VectorGrid>(file.name, file.mapping, file.source, file.prefix));
  } else {
    CATENA_TRY(field.scalar, make_dense_grid<ScalarGrid>(file.name, file.mapping, file.source, file.prefix));
  }
  field.times = file.times;
  field.time_unit = file.time_unit;
  field.newest_mtime_ns = file.newest_mtime_ns;
  field.notes = file.notes;
  if (file.rounding)
    for (std::string& note : rounding_notes(*file.rounding, file.type)) field.notes.push_back(std::move(note));
  count_file();
  count_grid();
  return field;
}

Result<std::vector<GridInfo>> describe_by_loading(const std::string& path, int step) {
  LoadRequest request;
  request.path = path;
  request.step = step;
  const VolumeReader& reader = io::find_reader(path, io::DataKind::volume)->volume;
  std::string type;
  Result<AnyField> loaded = Error{};
  if (reader.open != nullptr) {
    CATENA_TRY(const DenseFile file, reader.open(request));
    type = file.type;
    loaded = load_dense(file);
  } else {
    loaded = reader.load(request);
  }
  CATENA_TRY(const AnyField field, std::move(loaded));
  const Field& any = *field.get();
  GridInfo info;
  info.name = any.name();
  info.type = !type.empty() ? type : field.scalar ? "float" : "vec3s";
  info.stats = field.scalar ? field.scalar->grid()->stats() : field.vector->grid()->stats();
  info.display_range = display_range(field);
  const Vec3 size = any.index_box().hi - any.index_box().lo;
  info.size = {std::llround(size.x) + 1, std::llround(size.y) + 1, std::llround(size.z) + 1};
  info.mapping = any.mapping();
  info.bytes = field.scalar ? field.scalar->grid()->bytes() : field.vector->grid()->bytes();
  info.is_usable = true;
  info.is_vector = field.vector != nullptr;
  return std::vector<GridInfo>{info};
}

bool has_dicom_magic(std::string_view path) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code)) return false;
  char head[132] = {};
  std::ifstream(std::string(path), std::ios::binary).read(head, sizeof head);
  return std::string_view(head + 128, 4) == "DICM";
}

Result<std::uint64_t> readable_file_size(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return Error{fmt::format("{}: there is no such file", path)};
  if (std::filesystem::is_directory(status)) return Error{fmt::format("{}: this is a folder, expected a file", path)};
  if (!std::filesystem::is_regular_file(status)) return Error{fmt::format("{}: this is not a regular file", path)};
  const std::uint64_t size = std::filesystem::file_size(path, error);
  errno = 0;
  if (error || !std::ifstream(path, std::ios::binary)) {
    const int code = errno;
    return Error{fmt::format("{}: cannot be opened ({})", path, describe_errno(code)), is_system_failure(code)};
  }
  if (size == 0) return Error{fmt::format("{}: the file is empty", path)};
  return size;
}

void count_file() { ++files; }
void count_grid() { ++grids; }
void count_mask() { ++masks; }
LoadCounters load_counters() { return {files, grids, masks}; }

/// Returns the reader of the file; nullptr for a folder with the extension of a format that is not read.
static const VolumeReader* reader_of(const std::string& path) {
  const io::Format* format = io::find_reader(path, io::DataKind::volume);
  const bool by_contents = format != nullptr && io::find_format(path) == nullptr;
  return format == nullptr || (by_contents && !conversion_hint(path).empty()) ? nullptr : &format->volume;
}

Result<AnyField> load(const LoadRequest& request) {
  const VolumeReader* reader = reader_of(request.path);
  if (request.raw && (reader == nullptr || !reader->needs_layout))
    return Error{fmt::format("{}: shape, spacing, origin and type apply to .raw files only", request.path)};
  return guarded<AnyField>(request.path, [&]() -> Result<AnyField> {
    if (reader == nullptr) {
      if (!std::filesystem::is_directory(request.path)) CATENA_CHECK(readable_file_size(request.path));
      return unknown_kind(request.path);
    }
    Result<AnyField> field = Error{};
    const bool in_bricks = reader->is_array && is_read_in_bricks(request), reads_parts = in_bricks || reader->reads_parts;
    // a .vdb and a store are cropped by their readers, unless it is transformed first
    const bool crops = request.crop && (request.transform || !(has_extension(request.path, ".vdb") || reads_parts));
    if (in_bricks || reader->load != nullptr) {
      LoadRequest whole = request;
      if (crops) whole.crop.reset();
      field = in_bricks ? load_stored(whole) : reader->load(whole);
    } else {
      CATENA_TRY(const DenseFile file, reader->open(request));
      field = load_dense(file);
    }
    if (field && !has_finite_box(*field->get()))
      return Error{fmt::format("{}: the transform places a corner of the data at infinity, expected a finite box", request.path)};
    if (!field) return field;
    const auto is_hinted = [](const std::string& note) { return note.find("bytes") != std::string::npos; };
    if (const std::string hint = magnitude_hint(*field); !hint.empty() && std::ranges::none_of(field->notes, is_hinted))
      field->notes.push_back(hint);
    if (request.transform) {
      CATENA_TRY(field, transform_field(request.path, std::move(*field), *request.transform));
    }
    if (crops) {
      CATENA_TRY(field, crop_field(request.path, *field, *request.crop));
      leave_paged(*field, "\"transform\" with \"crop\"");
    }
    const bool nearest = request.interpolation == Interpolation::nearest;
    if (nearest && field->vector)
      return Error{fmt::format("{}: the grid \"{}\" contains vectors, expected scalars for the interpolation \"nearest\"", request.path,
                               field->get()->name())};
    if (nearest && field->scalar->grid() != nullptr) field = with_interpolation(std::move(*field), request.interpolation);
    if (request.level > 0 && !reads_parts)
      return downsample_to_level(request.path, std::move(*field), request.level, request.interpolation == Interpolation::cubic);
    if (request.interpolation == Interpolation::cubic) return with_cubic_interpolation(std::move(*field), request.path);
    return field;
  });
}

Result<std::vector<GridInfo>> describe_grids(const std::string& path, int step) {
  const VolumeReader* reader = reader_of(path);
  return guarded<std::vector<GridInfo>>(path, [&]() -> Result<std::vector<GridInfo>> {
    if (reader != nullptr) return reader->describe(path, step);
    if (!std::filesystem::is_directory(path)) CATENA_CHECK(readable_file_size(path));
    return unknown_kind(path);
  });
}

}  // namespace catena::field
