#include "engine/field/reader_exchange.h"

#include <cstring>
#include <type_traits>

namespace catena::field {
namespace {

class Encoder {
 public:
  template <class T>
  void number(T v) {
    static_assert(std::is_trivially_copyable_v<T>);
    text_.append(reinterpret_cast<const char*>(&v), sizeof v);
  }
  void flag(bool v) { number<std::uint8_t>(v ? 1 : 0); }
  void words(const std::string& s) {
    number<std::uint64_t>(s.size());
    text_ += s;
  }
  void vector(const Vec3& v) {
    for (int a = 0; a < 3; ++a) number<double>(v[a]);
  }
  void mapping(const Mapping& m) {
    for (int a = 0; a < 3; ++a) vector(m.world_from_index_linear[a]);
    vector(m.origin);
  }
  void piece(const Piece& p) {
    number(p.offset);
    number(p.bytes);
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

/// Remembers the first read beyond the end, and gives zeros from then on.
class Decoder {
 public:
  explicit Decoder(std::span<const std::byte> bytes) : left_(bytes) {}
  template <class T>
  T number() {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_same_v<T, bool>);
    T v{};
    if (left_.size() < sizeof v) {
      ok_ = false;
      return v;
    }
    std::memcpy(&v, left_.data(), sizeof v);
    left_ = left_.subspan(sizeof v);
    return v;
  }
  bool flag() { return number<std::uint8_t>() != 0; }
  std::string words() {
    const auto size = number<std::uint64_t>();
    if (!ok_ || size > left_.size()) {
      ok_ = false;
      return {};
    }
    std::string s(reinterpret_cast<const char*>(left_.data()), size);
    left_ = left_.subspan(size);
    return s;
  }
  Vec3 vector() {
    Vec3 v;
    for (int a = 0; a < 3; ++a) v[a] = number<double>();
    return v;
  }
  Mapping mapping() {
    Mat3 linear;
    for (int a = 0; a < 3; ++a) linear[a] = vector();
    return Mapping::from_linear(linear, vector());
  }
  Piece piece() {
    Piece p;
    p.offset = number<std::uint64_t>();
    p.bytes = number<std::uint64_t>();
    return p;
  }
  /// A count of items of at least so many bytes each.
  std::uint64_t count(std::size_t least_bytes) {
    const auto n = number<std::uint64_t>();
    if (n > left_.size() / least_bytes) ok_ = false;
    return ok_ ? n : 0;
  }
  bool ok() const { return ok_; }
  bool finished() const { return ok_ && left_.empty(); }

 private:
  std::span<const std::byte> left_;
  bool ok_ = true;
};

void put(Encoder& e, const DisplayRange& range) {
  for (const double v : {range.lo, range.hi, range.least, range.most}) e.number(v);
  e.number(range.count);
  for (const DisplayRange::Beyond* beyond : {&range.below, &range.above}) {
    e.number(beyond->count);
    e.number(beyond->nearest);
    e.number(beyond->farthest);
  }
}

DisplayRange get_range(Decoder& d) {
  DisplayRange range;
  for (double* v : {&range.lo, &range.hi, &range.least, &range.most}) *v = d.number<double>();
  range.count = d.number<std::uint64_t>();
  for (DisplayRange::Beyond* beyond : {&range.below, &range.above}) {
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
  for (const std::int32_t n : {g.lowest.x, g.lowest.y, g.lowest.z}) e.number(n);
  e.mapping(g.mapping);
  e.number(g.stats.active_voxels);
  e.number(g.stats.nan_count);
  e.number(g.stats.min);
  e.number(g.stats.max);
  e.vector(g.stats.component_min);
  e.vector(g.stats.component_max);
  put(e, g.shown);
  e.number<std::uint64_t>(g.bytes);
  e.flag(g.usable);
  e.flag(g.is_vector);
  e.number(static_cast<std::uint8_t>(g.counted));
  e.words(g.number);
  e.number(g.images);
}

GridInfo get_info(Decoder& d) {
  GridInfo g;
  g.name = d.words();
  g.type = d.words();
  for (std::int64_t* n : {&g.size.x, &g.size.y, &g.size.z}) *n = d.number<std::int64_t>();
  for (std::int32_t* n : {&g.lowest.x, &g.lowest.y, &g.lowest.z}) *n = d.number<std::int32_t>();
  g.mapping = d.mapping();
  g.stats.active_voxels = d.number<std::uint64_t>();
  g.stats.nan_count = d.number<std::uint64_t>();
  g.stats.min = d.number<double>();
  g.stats.max = d.number<double>();
  g.stats.component_min = d.vector();
  g.stats.component_max = d.vector();
  g.shown = get_range(d);
  g.bytes = d.number<std::uint64_t>();
  g.usable = d.flag();
  g.is_vector = d.flag();
  const auto counted = d.number<std::uint8_t>();
  g.counted = counted > static_cast<std::uint8_t>(Counted::cells) ? Counted::voxels : static_cast<Counted>(counted);
  g.number = d.words();
  g.images = d.number<std::int32_t>();
  return g;
}

}  // namespace

std::string_view counted_word(Counted counted) {
  constexpr std::string_view words[] = {"voxels", "points", "cells"};
  return words[static_cast<std::size_t>(counted)];
}

std::string encode(const ReadRequest& r) {
  Encoder e;
  e.number(static_cast<std::uint8_t>(r.mode));
  e.words(r.what.path);
  e.words(r.what.grid);
  e.flag(r.what.valid_grid.has_value());
  e.words(r.what.valid_grid.value_or(std::string()));
  e.flag(r.what.valid_required);
  e.number(r.what.step);
  e.flag(r.what.axes_xyz);
  e.flag(r.what.crop.has_value());
  const Box crop = r.what.crop.value_or(Box{});
  e.vector(crop.lo);
  e.vector(crop.hi);
  e.number(r.memory_bytes);
  e.number(r.stated_memory);
  e.number(r.cpu_s);
  return e.take();
}

Result<ReadRequest> decode_request(std::span<const std::byte> bytes) {
  Decoder d(bytes);
  ReadRequest r;
  const auto mode = d.number<std::uint8_t>();
  r.what.path = d.words();
  r.what.grid = d.words();
  const bool has_valid = d.flag();
  std::string valid = d.words();
  r.what.valid_grid = has_valid ? std::optional(std::move(valid)) : std::nullopt;
  r.what.valid_required = d.flag();
  r.what.step = d.number<std::int32_t>();
  r.what.axes_xyz = d.flag();
  const bool has_crop = d.flag();
  const Vec3 lo = d.vector(), hi = d.vector();
  if (has_crop) r.what.crop = Box{lo, hi};
  r.memory_bytes = d.number<std::uint64_t>();
  r.stated_memory = d.number<std::uint64_t>();
  r.cpu_s = d.number<std::uint64_t>();
  if (!d.finished() || mode > static_cast<std::uint8_t>(ReadMode::shape)) return Error{"the request is incomplete"};
  r.mode = static_cast<ReadMode>(mode);
  return r;
}

std::string encode(const ReadReply& r) {
  Encoder e;
  e.words(r.error);
  e.words(r.name);
  e.flag(r.is_vector);
  e.flag(r.masked);
  e.flag(r.cells_masked);
  e.mapping(r.mapping);
  for (const Piece& p : {r.values, r.voxels, r.cells}) e.piece(p);
  e.number<std::uint64_t>(r.grids.size());
  for (const GridInfo& g : r.grids) put(e, g);
  for (const std::int64_t n : {r.dense.size.x, r.dense.size.y, r.dense.size.z}) e.number(n);
  e.number(r.dense.components);
  e.words(r.dense.type);
  for (const Piece& p : {r.dense.values, r.dense.valid, r.dense.cells, r.shape.points, r.shape.triangles, r.shape.lines, r.shape.ends,
                         r.shape.loose, r.shape.values})
    e.piece(p);
  e.flag(r.dense.has_range);
  put(e, r.dense.range);
  e.words(r.shape.value_name);
  e.number<std::uint64_t>(r.notes.size());
  for (const std::string& note : r.notes) e.words(note);
  e.number<std::uint64_t>(r.times.size());
  for (const double t : r.times) e.number(t);
  e.words(r.time_unit);
  e.words(r.units);
  e.words(r.unit_length);
  e.flag(r.patient);
  e.number<std::uint64_t>(r.words.size());
  for (const GridWords& w : r.words) {
    e.words(w.name);
    e.words(w.unit);
    e.words(w.unit_length);
    e.flag(w.level_set);
  }
  e.flag(r.shapes.triangles);
  e.flag(r.shapes.lines);
  e.number(r.confinement.landlock_version);
  e.flag(r.confinement.seccomp);
  e.number(r.newest_ns);
  e.number<std::uint64_t>(r.opened.size());
  for (const FileId& id : r.opened) {
    e.number(id.device);
    e.number(id.inode);
  }
  return e.take();
}

Result<ReadReply> decode_reply(std::span<const std::byte> bytes) {
  Decoder d(bytes);
  ReadReply r;
  r.error = d.words();
  r.name = d.words();
  r.is_vector = d.flag();
  r.masked = d.flag();
  r.cells_masked = d.flag();
  r.mapping = d.mapping();
  for (Piece* p : {&r.values, &r.voxels, &r.cells}) *p = d.piece();
  constexpr std::size_t kLeastInfo = 16, kLeastWords = 24;
  for (std::uint64_t n = d.count(kLeastInfo); n > 0 && d.ok(); --n) r.grids.push_back(get_info(d));
  for (std::int64_t* n : {&r.dense.size.x, &r.dense.size.y, &r.dense.size.z}) *n = d.number<std::int64_t>();
  r.dense.components = d.number<std::int32_t>();
  r.dense.type = d.words();
  for (Piece* p : {&r.dense.values, &r.dense.valid, &r.dense.cells, &r.shape.points, &r.shape.triangles, &r.shape.lines, &r.shape.ends,
                   &r.shape.loose, &r.shape.values})
    *p = d.piece();
  r.dense.has_range = d.flag();
  r.dense.range = get_range(d);
  r.shape.value_name = d.words();
  for (std::uint64_t n = d.count(sizeof(std::uint64_t)); n > 0 && d.ok(); --n) r.notes.push_back(d.words());
  for (std::uint64_t n = d.count(sizeof(double)); n > 0 && d.ok(); --n) r.times.push_back(d.number<double>());
  r.time_unit = d.words();
  r.units = d.words();
  r.unit_length = d.words();
  r.patient = d.flag();
  for (std::uint64_t n = d.count(kLeastWords); n > 0 && d.ok(); --n) {
    GridWords w;
    w.name = d.words();
    w.unit = d.words();
    w.unit_length = d.words();
    w.level_set = d.flag();
    r.words.push_back(std::move(w));
  }
  r.shapes.triangles = d.flag();
  r.shapes.lines = d.flag();
  r.confinement.landlock_version = d.number<std::uint32_t>();
  r.confinement.seccomp = d.flag();
  r.newest_ns = d.number<std::int64_t>();
  for (std::uint64_t n = d.count(2 * sizeof(std::uint64_t)); n > 0 && d.ok(); --n) {
    FileId id;
    id.device = d.number<std::uint64_t>();
    id.inode = d.number<std::uint64_t>();
    r.opened.push_back(id);
  }
  if (!d.finished()) return Error{"its reply is incomplete"};
  return r;
}

}  // namespace catena::field
