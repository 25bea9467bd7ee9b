// SPDX-License-Identifier: MIT
#include "engine/io/protocol.h"

#include "engine/io/message.h"

namespace catena::field {
namespace {

void put(Encoder& e, const DisplayRange& range) {
  for (const double v : {range.lo, range.hi, range.data_min, range.data_max}) e.number(v);
  e.number(range.count);
  for (const DisplayRange::Outliers* beyond : {&range.below, &range.above}) {
    e.number(beyond->count);
    e.number(beyond->nearest);
    e.number(beyond->farthest);
  }
}

DisplayRange get_range(Decoder& d) {
  DisplayRange range;
  for (double* v : {&range.lo, &range.hi, &range.data_min, &range.data_max}) *v = d.number<double>();
  range.count = d.number<std::uint64_t>();
  for (DisplayRange::Outliers* beyond : {&range.below, &range.above}) {
    beyond->count = d.number<std::uint64_t>();
    beyond->nearest = d.number<double>();
    beyond->farthest = d.number<double>();
  }
  return range;
}

void put(Encoder& e, const GridInfo& g) {
  e.words(g.name);
  e.words(g.type);
  for (const std::int64_t n : {g.size.x, g.size.y, g.size.z}) e.number(n);
  for (const std::int32_t n : {g.first_index.x, g.first_index.y, g.first_index.z}) e.number(n);
  e.mapping(g.mapping);
  e.number(g.stats.active_voxels);
  e.number(g.stats.nan_count);
  e.number(g.stats.min);
  e.number(g.stats.max);
  e.vector(g.stats.component_min);
  e.vector(g.stats.component_max);
  put(e, g.display_range);
  e.number<std::uint64_t>(g.bytes);
  e.flag(g.is_usable);
  e.flag(g.is_vector);
  e.number(static_cast<std::uint8_t>(g.element_kind));
  e.words(g.series_number);
  e.number(g.image_count);
}

GridInfo get_info(Decoder& d) {
  GridInfo g;
  g.name = d.words();
  g.type = d.words();
  for (std::int64_t* n : {&g.size.x, &g.size.y, &g.size.z}) *n = d.number<std::int64_t>();
  for (std::int32_t* n : {&g.first_index.x, &g.first_index.y, &g.first_index.z}) *n = d.number<std::int32_t>();
  g.mapping = d.mapping();
  g.stats.active_voxels = d.number<std::uint64_t>();
  g.stats.nan_count = d.number<std::uint64_t>();
  g.stats.min = d.number<double>();
  g.stats.max = d.number<double>();
  g.stats.component_min = d.vector();
  g.stats.component_max = d.vector();
  g.display_range = get_range(d);
  g.bytes = d.number<std::uint64_t>();
  g.is_usable = d.flag();
  g.is_vector = d.flag();
  const auto counted = d.number<std::uint8_t>();
  g.element_kind = counted > static_cast<std::uint8_t>(ElementKind::cells) ? ElementKind::voxels : static_cast<ElementKind>(counted);
  g.series_number = d.words();
  g.image_count = d.number<std::int32_t>();
  return g;
}

}  // namespace

std::string_view to_string(ElementKind counted) {
  constexpr std::string_view words[] = {"voxels", "points", "cells"};
  return words[static_cast<std::size_t>(counted)];
}

std::string encode(const ReadRequest& r) {
  Encoder e;
  e.number(static_cast<std::uint8_t>(r.mode));
  e.words(r.load_request.path);
  e.words(r.load_request.grid);
  e.flag(r.load_request.mask_grid.has_value());
  e.words(r.load_request.mask_grid.value_or(std::string()));
  e.flag(r.load_request.mask_required);
  e.number(r.load_request.step);
  e.flag(r.load_request.axes_xyz);
  e.flag(r.load_request.crop.has_value());
  const Box crop = r.load_request.crop.value_or(Box{});
  e.vector(crop.lo);
  e.vector(crop.hi);
  e.number(r.memory_bytes);
  e.number(r.user_memory_limit);
  e.number(r.cpu_s);
  return e.take();
}

Result<ReadRequest> decode_request(std::span<const std::byte> bytes) {
  Decoder d(bytes);
  ReadRequest r;
  const auto mode = d.number<std::uint8_t>();
  r.load_request.path = d.words();
  r.load_request.grid = d.words();
  const bool has_valid = d.flag();
  std::string valid = d.words();
  r.load_request.mask_grid = has_valid ? std::optional(std::move(valid)) : std::nullopt;
  r.load_request.mask_required = d.flag();
  r.load_request.step = d.number<std::int32_t>();
  r.load_request.axes_xyz = d.flag();
  const bool has_crop = d.flag();
  const Vec3 lo = d.vector(), hi = d.vector();
  if (has_crop) r.load_request.crop = Box{lo, hi};
  r.memory_bytes = d.number<std::uint64_t>();
  r.user_memory_limit = d.number<std::uint64_t>();
  r.cpu_s = d.number<std::uint64_t>();
  if (!d.finished() || mode > static_cast<std::uint8_t>(ReadMode::geometry)) return Error{"the request is incomplete"};
  r.mode = static_cast<ReadMode>(mode);
  return r;
}

std::string encode(const ReadResponse& r) {
  Encoder e;
  e.words(r.error);
  e.words(r.name);
  e.flag(r.is_vector);
  e.flag(r.has_mask);
  e.flag(r.has_cell_mask);
  e.mapping(r.mapping);
  for (const BufferRange& p : {r.values, r.valid_voxels, r.valid_cells}) e.piece(p);
  e.number<std::uint64_t>(r.grids.size());
  for (const GridInfo& g : r.grids) put(e, g);
  for (const std::int64_t n : {r.dense.size.x, r.dense.size.y, r.dense.size.z}) e.number(n);
  e.number(r.dense.components);
  e.words(r.dense.type);
  for (const BufferRange& p : {r.dense.values, r.dense.valid, r.dense.cells, r.geometry.points, r.geometry.triangles, r.geometry.lines,
                               r.geometry.line_ends, r.geometry.loose_points, r.geometry.values})
    e.piece(p);
  e.flag(r.dense.has_range);
  put(e, r.dense.range);
  e.words(r.geometry.value_name);
  e.number<std::uint64_t>(r.notes.size());
  for (const std::string& note : r.notes) e.words(note);
  e.number<std::uint64_t>(r.times.size());
  for (const double t : r.times) e.number(t);
  e.words(r.time_unit);
  e.words(r.units);
  e.words(r.unit_length);
  e.flag(r.is_patient_space);
  e.number<std::uint64_t>(r.grid_metadata.size());
  for (const GridMetadata& w : r.grid_metadata) {
    e.words(w.name);
    e.words(w.unit);
    e.words(w.unit_length);
    e.flag(w.is_level_set);
  }
  e.flag(r.primitives.triangles);
  e.flag(r.primitives.lines);
  e.number(r.sandbox.landlock_version);
  e.flag(r.sandbox.seccomp);
  e.number(r.newest_mtime_ns);
  e.number<std::uint64_t>(r.opened_files.size());
  for (const FileId& id : r.opened_files) {
    e.number(id.device);
    e.number(id.inode);
  }
  return e.take();
}

Result<ReadResponse> decode_response(std::span<const std::byte> bytes) {
  Decoder d(bytes);
  ReadResponse r;
  r.error = d.words();
  r.name = d.words();
  r.is_vector = d.flag();
  r.has_mask = d.flag();
  r.has_cell_mask = d.flag();
  r.mapping = d.mapping();
  for (BufferRange* p : {&r.values, &r.valid_voxels, &r.valid_cells}) *p = d.piece();
  constexpr std::size_t kMinInfo = 16, kMinWords = 24;
  for (std::uint64_t n = d.count(kMinInfo); n > 0 && d.ok(); --n) r.grids.push_back(get_info(d));
  for (std::int64_t* n : {&r.dense.size.x, &r.dense.size.y, &r.dense.size.z}) *n = d.number<std::int64_t>();
  r.dense.components = d.number<std::int32_t>();
  r.dense.type = d.words();
  for (BufferRange* p : {&r.dense.values, &r.dense.valid, &r.dense.cells, &r.geometry.points, &r.geometry.triangles, &r.geometry.lines,
                         &r.geometry.line_ends, &r.geometry.loose_points, &r.geometry.values})
    *p = d.piece();
  r.dense.has_range = d.flag();
  r.dense.range = get_range(d);
  r.geometry.value_name = d.words();
  for (std::uint64_t n = d.count(sizeof(std::uint64_t)); n > 0 && d.ok(); --n) r.notes.push_back(d.words());
  for (std::uint64_t n = d.count(sizeof(double)); n > 0 && d.ok(); --n) r.times.push_back(d.number<double>());
  r.time_unit = d.words();
  r.units = d.words();
  r.unit_length = d.words();
  r.is_patient_space = d.flag();
  for (std::uint64_t n = d.count(kMinWords); n > 0 && d.ok(); --n) {
    GridMetadata w;
    w.name = d.words();
    w.unit = d.words();
    w.unit_length = d.words();
    w.is_level_set = d.flag();
    r.grid_metadata.push_back(std::move(w));
  }
  r.primitives.triangles = d.flag();
  r.primitives.lines = d.flag();
  r.sandbox.landlock_version = d.number<std::uint32_t>();
  r.sandbox.seccomp = d.flag();
  r.newest_mtime_ns = d.number<std::int64_t>();
  for (std::uint64_t n = d.count(2 * sizeof(std::uint64_t)); n > 0 && d.ok(); --n) {
    FileId id;
    id.device = d.number<std::uint64_t>();
    id.inode = d.number<std::uint64_t>();
    r.opened_files.push_back(id);
  }
  if (!d.finished()) return Error{"the message is incomplete"};
  return r;
}

}  // namespace catena::field
