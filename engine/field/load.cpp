#include "engine/field/load.h"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <exception>
#include <new>

#include "engine/base/text.h"
#include "engine/field/formats.h"
#include "engine/field/crop.h"
#include "engine/field/level.h"

namespace catena::field {
namespace {

std::atomic<std::uint64_t> files{0}, grids{0}, masks{0};

/// Nothing that a library throws leaves this room.
template <class T, class Body>
Result<T> guarded(const std::string& path, const Body& body) {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return Error{fmt::format("{}: not enough memory to read it (or the file is damaged)", path)};
  } catch (const std::exception& e) {
    return Error{fmt::format("{}: the file is damaged or of an unknown kind ({})", path, one_line(e.what()))};
  } catch (...) {
    return Error{fmt::format("{}: the file is damaged or of an unknown kind", path)};
  }
}

/// Each number of a transform may be finite, and the box not.
bool has_finite_box(const Field& field) {
  bool finite = std::isfinite(field.length());
  for (int i = 0; i < 8; ++i) finite = finite && is_finite(field.corner(i));
  return finite;
}

Error unknown_kind(const std::string& path) {
  return Error{fmt::format("{}: unknown kind of file, expected {}", path, field_file_words())};
}

}  // namespace

Result<AnyField> smooth(AnyField field, const std::string& path) {
  const auto told = [&](const Error& e) { return Error{fmt::format("{}: {}", path, e.message)}; };
  if (field.scalar && field.scalar->grid()) {
    auto made = field.scalar->grid()->cubic();
    if (!made) return told(made.error());
    field.scalar = *made;
  }
  if (field.vector && field.vector->grid()) {
    auto made = field.vector->grid()->cubic();
    if (!made) return told(made.error());
    field.vector = *made;
  }
  return field;
}

Result<AnyField> load_dense(const DenseFile& file) {
  AnyField field;
  if (file.components == 3) {
    CATENA_TRY(field.vector, make_dense<VectorGrid>(file.name, file.mapping, file.source, file.prefix));
  } else {
    CATENA_TRY(field.scalar, make_dense<ScalarGrid>(file.name, file.mapping, file.source, file.prefix));
  }
  field.times = file.times;
  field.notes = file.notes;
  if (file.rounding)
    for (std::string& note : notes_of(*file.rounding, file.type)) field.notes.push_back(std::move(note));
  count_file();
  count_grid();
  return field;
}

Result<std::vector<GridInfo>> describe_loaded(const std::string& path) {
  LoadRequest request;
  request.path = path;
  const FileFormat* format = format_of(path);
  std::string type;
  Result<AnyField> loaded = Error{};
  if (format->open != nullptr) {
    CATENA_TRY(const DenseFile file, format->open(request));
    type = file.type;
    loaded = load_dense(file);
  } else {
    loaded = format->load(request);
  }
  CATENA_TRY(const AnyField field, std::move(loaded));
  const Field& any = *field.get();
  GridInfo info;
  info.name = any.name();
  info.type = !type.empty() ? type : field.scalar ? "float" : "vec3s";
  info.stats = field.scalar ? field.scalar->grid()->stats() : field.vector->grid()->stats();
  const Vec3 size = any.index_box().hi - any.index_box().lo;
  info.size = {std::llround(size.x) + 1, std::llround(size.y) + 1, std::llround(size.z) + 1};
  info.mapping = any.mapping();
  info.bytes = field.scalar ? field.scalar->grid()->bytes() : field.vector->grid()->bytes();
  info.usable = true;
  info.is_vector = field.vector != nullptr;
  return std::vector<GridInfo>{info};
}

void count_file() { ++files; }
void count_grid() { ++grids; }
void count_mask() { ++masks; }
LoadCounters load_counters() { return {files, grids, masks}; }

Result<AnyField> load(const LoadRequest& request) {
  const FileFormat* format = format_of(request.path);
  if (request.raw && (format == nullptr || !format->needs_layout))
    return Error{fmt::format("{}: shape, spacing, origin and type belong to .raw files only", request.path)};
  return guarded<AnyField>(request.path, [&]() -> Result<AnyField> {
    if (format == nullptr) {
      CATENA_CHECK(readable_file(request.path));
      return unknown_kind(request.path);
    }
    Result<AnyField> field = Error{};
    if (format->load != nullptr) {
      field = format->load(request);
    } else {
      CATENA_TRY(const DenseFile file, format->open(request));
      field = load_dense(file);
    }
    if (field && !has_finite_box(*field->get()))
      return Error{fmt::format("{}: the transform puts a corner of the data beyond all numbers, expected a finite box", request.path)};
    if (!field) return field;
    if (request.crop && !has_ending(request.path, ".vdb")) {  // of a .vdb nothing else was read
      CATENA_TRY(field, cropped(request.path, *field, *request.crop));
    }
    const bool nearest = request.interpolation == Interpolation::nearest;
    if (nearest && field->vector)
      return Error{fmt::format("{}: the grid \"{}\" holds vectors, expected numbers for the interpolation \"nearest\"", request.path,
                               field->get()->name())};
    if (const ScalarGrid* grid = nearest ? field->scalar->grid() : nullptr) field->scalar = grid->interpolated(request.interpolation);
    if (request.level > 0) return at_level(request.path, std::move(*field), request.level, request.interpolation == Interpolation::cubic);
    if (request.interpolation == Interpolation::cubic) return smooth(std::move(*field), request.path);
    return field;
  });
}

Result<std::vector<GridInfo>> describe(const std::string& path) {
  const FileFormat* format = format_of(path);
  return guarded<std::vector<GridInfo>>(path, [&]() -> Result<std::vector<GridInfo>> {
    if (format != nullptr) return format->describe(path);
    CATENA_CHECK(readable_file(path));
    return unknown_kind(path);
  });
}

}  // namespace catena::field
