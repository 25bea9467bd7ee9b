// SPDX-License-Identifier: MIT
#include "engine/io/stores/store_protocol.h"

#include <cmath>

#include "engine/field/number_type.h"
#include "engine/io/message.h"

namespace catena::field {
namespace {

void put_index(Encoder& e, const Index3& n) {
  for (const std::int32_t v : {n.x, n.y, n.z}) e.number(v);
}

Index3 get_index(Decoder& d) {
  Index3 n{0, 0, 0};
  for (std::int32_t* v : {&n.x, &n.y, &n.z}) *v = d.number<std::int32_t>();
  return n;
}

bool is_size(const Index3& n) {
  for (const std::int32_t v : {n.x, n.y, n.z})
    if (v < 1 || v > kMaxStoreAxis) return false;
  return true;
}

/// Returns what is wrong with a grid; empty: nothing.
std::string find_problem(const StoreGrid& grid) {
  if (!find_number_type(grid.type)) return "a number type is unknown";
  if (grid.levels.empty()) return "a grid has no level";
  if (grid.steps < 1) return "a grid has no time step";
  if (grid.has_window && !(std::isfinite(grid.window[0]) && std::isfinite(grid.window[1]) && grid.window[0] <= grid.window[1]))
    return "a display range is invalid";
  for (const StoreLevel& level : grid.levels) {
    if (!is_size(level.size) || !is_size(level.chunk)) return "a size is out of range";
    if (!level.mapping.is_invertible()) return "a transform cannot be inverted";
  }
  return {};
}

}  // namespace

std::string encode(const StoreDescription& store) {
  Encoder e;
  e.number<std::uint64_t>(store.grids.size());
  for (const StoreGrid& grid : store.grids) {
    for (const std::string* text : {&grid.name, &grid.type, &grid.length_unit, &grid.value_unit}) e.words(*text);
    e.flag(grid.is_label_map);
    e.flag(grid.has_window);
    for (const double v : {grid.window[0], grid.window[1], grid.fill_value}) e.number(v);
    e.number(grid.color);
    e.number(grid.steps);
    e.number<std::uint64_t>(grid.levels.size());
    for (const StoreLevel& level : grid.levels) {
      put_index(e, level.size);
      put_index(e, level.chunk);
      e.mapping(level.mapping);
    }
  }
  e.number<std::uint64_t>(store.times.size());
  for (const double t : store.times) e.number(t);
  e.words(store.time_unit);
  e.number<std::uint64_t>(store.notes.size());
  for (const std::string& note : store.notes) e.words(note);
  e.number<std::uint64_t>(store.opened_files.size());
  for (const FileId& id : store.opened_files) {
    e.number(id.device);
    e.number(id.inode);
  }
  e.number(store.newest_mtime_ns);
  return e.take();
}

Result<StoreDescription> decode_store(std::span<const std::byte> bytes) {
  Decoder d(bytes);
  StoreDescription store;
  constexpr std::size_t kMinGrid = 64, kMinLevel = 120;
  for (std::uint64_t n = d.count(kMinGrid); n > 0 && d.ok(); --n) {
    StoreGrid grid;
    for (std::string* text : {&grid.name, &grid.type, &grid.length_unit, &grid.value_unit}) *text = d.words();
    grid.is_label_map = d.flag();
    grid.has_window = d.flag();
    for (double* v : {&grid.window[0], &grid.window[1], &grid.fill_value}) *v = d.number<double>();
    grid.color = d.number<std::int32_t>();
    grid.steps = d.number<std::int32_t>();
    for (std::uint64_t levels = d.count(kMinLevel); levels > 0 && d.ok(); --levels) {
      StoreLevel& level = grid.levels.emplace_back();
      level.size = get_index(d);
      level.chunk = get_index(d);
      level.mapping = d.mapping();
    }
    if (const std::string problem = find_problem(grid); d.ok() && !problem.empty()) return Error{problem};
    store.grids.push_back(std::move(grid));
  }
  for (std::uint64_t n = d.count(sizeof(double)); n > 0 && d.ok(); --n) store.times.push_back(d.number<double>());
  store.time_unit = d.words();
  for (std::uint64_t n = d.count(sizeof(std::uint64_t)); n > 0 && d.ok(); --n) store.notes.push_back(d.words());
  for (std::uint64_t n = d.count(sizeof(FileId)); n > 0 && d.ok(); --n) {
    FileId& id = store.opened_files.emplace_back();
    id.device = d.number<std::uint64_t>();
    id.inode = d.number<std::uint64_t>();
  }
  store.newest_mtime_ns = d.number<std::int64_t>();
  if (!d.finished()) return Error{"the message is incomplete"};
  if (store.grids.empty()) return Error{"the description has no grid"};
  return store;
}

}  // namespace catena::field
