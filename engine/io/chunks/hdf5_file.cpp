// SPDX-License-Identifier: MIT
#include "engine/io/chunks/hdf5_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "engine/base/text.h"
#include "engine/io/chunks/hdf5_filters.h"
#include "engine/io/stores/store_protocol.h"

namespace catena::chunks {
namespace {

constexpr std::size_t kMaxNames = 100'000;

/// Number type of a data set, and the type in memory. Returns an Error with a message fragment.
Outcome find_type(hid_t id, H5Data& data) {
  const H5Id type(::H5Dget_type(id));
  const H5T_class_t kind = ::H5Tget_class(type.get());
  const std::size_t bytes = ::H5Tget_size(type.get());
  const bool is_signed = ::H5Tget_sign(type.get()) == H5T_SGN_2;
  if (kind == H5T_FLOAT && bytes >= 1 && bytes <= 8) {
    // floats of 16 bits become floats of 32
    data.type = {bytes <= 4 ? "float32" : "float64", bytes <= 4 ? std::size_t{4} : 8, false};
    data.memory_type = bytes <= 4 ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE;
    return Done{};
  }
  if (kind != H5T_INTEGER || bytes < 1 || bytes > 8) return Error{"has no integers or floats of at most 8 bytes"};
  data.type.bytes = bytes > 4 ? 8 : bytes > 2 ? 4 : bytes;
  data.type.name = (is_signed ? "int" : "uint") + std::to_string(8 * data.type.bytes);
  const hid_t types[2][9] = {{0, H5T_NATIVE_UINT8, H5T_NATIVE_UINT16, 0, H5T_NATIVE_UINT32, 0, 0, 0, H5T_NATIVE_UINT64},
                             {0, H5T_NATIVE_INT8, H5T_NATIVE_INT16, 0, H5T_NATIVE_INT32, 0, 0, 0, H5T_NATIVE_INT64}};
  data.memory_type = types[is_signed ? 1 : 0][data.type.bytes];
  return Done{};
}

/// Checks layout and filters of a data set.
Outcome find_layout(hid_t id, H5Data& data) {
  const H5Id list(::H5Dget_create_plist(id));
  const H5D_layout_t layout = ::H5Pget_layout(list.get());
  if (layout == H5D_VIRTUAL) return Error{"is a virtual data set, expected the one that holds the data"};
  if (::H5Pget_external_count(list.get()) > 0) return Error{"is in another file, expected data in this file"};
  const std::size_t rank = data.size.size();
  data.chunk.assign(rank, 1);
  if (layout == H5D_CHUNKED) {
    std::vector<hsize_t> edges(rank);
    if (::H5Pget_chunk(list.get(), static_cast<int>(rank), edges.data()) != static_cast<int>(rank)) return Error{"has invalid chunks"};
    double bytes = static_cast<double>(data.type.bytes);
    for (std::size_t a = 0; a < rank; ++a) {
      bytes *= static_cast<double>(edges[a]);
      data.chunk[a] = static_cast<std::int64_t>(std::min<hsize_t>(edges[a], static_cast<hsize_t>(field::kMaxStoreAxis)));
    }
    if (bytes > static_cast<double>(kMaxChunkBytes))
      return Error{fmt::format("has chunks of {:.0f} bytes, expected at most {}", bytes, kMaxChunkBytes)};
  } else {
    for (std::size_t a = rank < 2 ? 0 : rank - 2; a < rank; ++a) data.chunk[a] = data.size[a];
  }
  const int filters = ::H5Pget_nfilters(list.get());
  for (int i = 0; i < filters; ++i) {
    unsigned flags = 0;
    std::size_t values = 0;
    char name[64] = {};
    const H5Z_filter_t filter =
        ::H5Pget_filter2(list.get(), static_cast<unsigned>(i), &flags, &values, nullptr, sizeof name, name, nullptr);
    if (filter < 0 || ::H5Zfilter_avail(filter) <= 0)
      return Error{
          fmt::format("is compressed by the filter {} {}, which is not supported; expected gzip, shuffle, szip, lz4, blosc or zstd",
                      static_cast<int>(filter), in_quotes(name))};
  }
  if (::H5Pget_fill_value(list.get(), H5T_NATIVE_DOUBLE, &data.fill_value) < 0) data.fill_value = 0;
  return Done{};
}

herr_t add_member(hid_t, const char* name, const H5L_info_t*, void* names) {
  auto& list = *static_cast<std::vector<std::string>*>(names);
  list.emplace_back(name);
  return list.size() < kMaxNames ? 0 : 1;
}

herr_t add_data_set(hid_t, const char* name, const H5O_info_t* info, void* names) {
  auto& list = *static_cast<std::vector<std::string>*>(names);
  if (info->type == H5O_TYPE_DATASET) list.emplace_back(name);
  return list.size() < kMaxNames ? 0 : 1;
}

/// An attribute, opened; of at most a million elements.
struct Attribute {
  H5Id id, type;
  std::size_t count = 0;
};
Attribute open_attribute(hid_t file, const std::string& object, const std::string& name) {
  Attribute found;
  if (::H5Aexists_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT) <= 0) return found;
  found.id = H5Id(::H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT));
  if (!found.id) return found;
  found.type = H5Id(::H5Aget_type(found.id.get()));
  const H5Id space(::H5Aget_space(found.id.get()));
  const hssize_t count = ::H5Sget_simple_extent_npoints(space.get());
  constexpr hssize_t kMaxCount = 1'000'000;
  found.count = count >= 1 && count <= kMaxCount ? static_cast<std::size_t>(count) : 0;
  return found;
}

}  // namespace

Result<H5File> H5File::open(const std::string& path) {
  ::setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);
  ::H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  register_hdf5_filters();
  H5File opened;
  opened.file_ = H5Id(::H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  if (!opened.file_) return Error{"is not an HDF5 file, or is damaged or truncated"};
  return opened;
}

bool H5File::exists(const std::string& path) const {
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    if (::H5Lexists(file_.get(), path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return ::H5Oexists_by_name(file_.get(), path.c_str(), H5P_DEFAULT) > 0;
  }
}

std::vector<std::string> H5File::members(const std::string& group) const {
  std::vector<std::string> names;
  const H5Id opened(::H5Gopen2(file_.get(), group.c_str(), H5P_DEFAULT));
  if (opened) ::H5Literate(opened.get(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add_member, &names);
  return names;
}

std::vector<std::string> H5File::data_sets() const {
  std::vector<std::string> names;
  ::H5Ovisit(file_.get(), H5_INDEX_NAME, H5_ITER_NATIVE, add_data_set, &names);
  return names;
}

std::vector<std::string> H5File::texts(const std::string& object, const std::string& attribute) const {
  const Attribute found = open_attribute(file_.get(), object, attribute);
  std::vector<std::string> texts;
  if (found.count == 0 || ::H5Tget_class(found.type.get()) != H5T_STRING) return texts;
  if (::H5Tis_variable_str(found.type.get()) > 0) {
    const H5Id memory(::H5Tcopy(found.type.get()));
    std::vector<char*> pointers(found.count, nullptr);
    if (::H5Aread(found.id.get(), memory.get(), pointers.data()) < 0) return texts;
    const H5Id space(::H5Aget_space(found.id.get()));
    for (const char* text : pointers) texts.emplace_back(text != nullptr ? text : "");
    ::H5Dvlen_reclaim(memory.get(), space.get(), H5P_DEFAULT, pointers.data());
    return texts;
  }
  const std::size_t bytes = ::H5Tget_size(found.type.get());
  constexpr std::size_t kMaxBytes = 16 << 20;
  if (bytes < 1 || bytes > kMaxBytes / found.count) return texts;
  std::string all(bytes * found.count, '\0');
  if (::H5Aread(found.id.get(), found.type.get(), all.data()) < 0) return texts;
  for (std::size_t i = 0; i < found.count; ++i) texts.emplace_back(all.substr(i * bytes, bytes).c_str());
  return texts;
}

std::string H5File::text(const std::string& object, const std::string& attribute) const {
  std::string all;
  for (const std::string& one : texts(object, attribute)) all += one;
  return all;
}

std::vector<double> H5File::numbers(const std::string& object, const std::string& attribute) const {
  const Attribute found = open_attribute(file_.get(), object, attribute);
  std::vector<double> numbers(found.count);
  const H5T_class_t kind = found.count == 0 ? H5T_NO_CLASS : ::H5Tget_class(found.type.get());
  if ((kind != H5T_INTEGER && kind != H5T_FLOAT) || ::H5Aread(found.id.get(), H5T_NATIVE_DOUBLE, numbers.data()) < 0) return {};
  return numbers;
}

Result<const H5Data*> H5File::data(const std::string& path) {
  for (auto at = opened_.begin(); at != opened_.end(); ++at)
    if (at->first == path) {
      opened_.splice(opened_.begin(), opened_, at);
      return &opened_.front().second;
    }
  H5Data data;
  // the cache of decoded chunks
  const H5Id access(::H5Pcreate(H5P_DATASET_ACCESS));
  constexpr std::size_t kSlots = 12421, kCacheBytes = 64 << 20;
  constexpr double kFullyReadFirst = 0.75;  // with 1, chunks that were read in part would never leave
  ::H5Pset_chunk_cache(access.get(), kSlots, kCacheBytes, kFullyReadFirst);
  data.id = H5Id(::H5Dopen2(file_.get(), path.c_str(), access.get()));
  if (!data.id) return Error{"cannot be opened: it is missing or damaged"};
  const H5Id space(::H5Dget_space(data.id.get()));
  constexpr int kMaxRank = 8;
  const int rank = ::H5Sget_simple_extent_ndims(space.get());
  if (rank < 1 || rank > kMaxRank) return Error{fmt::format("has {} axes, expected 1 to {}", rank, kMaxRank)};
  std::vector<hsize_t> size(static_cast<std::size_t>(rank));
  if (::H5Sget_simple_extent_dims(space.get(), size.data(), nullptr) != rank) return Error{"has no size"};
  for (const hsize_t n : size) {
    if (n < 1 || n > static_cast<hsize_t>(field::kMaxStoreAxis))
      return Error{fmt::format("has {} values along an axis, expected 1 to {}", n, field::kMaxStoreAxis)};
    data.size.push_back(static_cast<std::int64_t>(n));
  }
  CATENA_CHECK(find_type(data.id.get(), data));
  CATENA_CHECK(find_layout(data.id.get(), data));
  constexpr std::size_t kMaxOpen = 2;  // each has a cache
  while (opened_.size() >= kMaxOpen) opened_.pop_back();
  opened_.emplace_front(path, std::move(data));
  return &opened_.front().second;
}

std::vector<double> H5File::values(const std::string& path) {
  const auto found = data(path);
  if (!found) return {};
  double count = 1;
  for (const std::int64_t n : (*found)->size) count *= static_cast<double>(n);
  constexpr double kMaxCount = 1e6;
  if (count > kMaxCount) return {};
  std::vector<double> values(static_cast<std::size_t>(count));
  if (::H5Dread((*found)->id.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) return {};
  return values;
}

/// Returns whether the last call of HDF5 failed for lack of memory.
static bool lacks_memory() {
  bool found = false;
  const auto inspect = [](unsigned, const H5E_error2_t* error, void* out) -> herr_t {
    if (error->maj_num == H5E_RESOURCE && (error->min_num == H5E_NOSPACE || error->min_num == H5E_CANTALLOC))
      *static_cast<bool*>(out) = true;
    return 0;
  };
  ::H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, inspect, &found);
  return found;
}

Outcome H5File::read(const std::string& path, const std::vector<std::int64_t>& first, const std::vector<std::int64_t>& count,
                     std::span<std::byte> out) {
  CATENA_TRY(const H5Data* data, this->data(path));
  if (data->size.size() != first.size()) return Error{"has another number of axes than at level 0 and step 0"};
  std::size_t bytes = data->type.bytes;
  for (std::size_t a = 0; a < first.size(); ++a) {
    if (first[a] + count[a] > data->size[a]) return Error{"is smaller than the other levels and steps state"};
    bytes *= static_cast<std::size_t>(count[a]);
  }
  if (bytes != out.size()) return Error{"has another type than at level 0 and step 0"};
  const std::vector<hsize_t> start(first.begin(), first.end()), extent(count.begin(), count.end());
  const H5Id space(::H5Dget_space(data->id.get()));
  const H5Id memory(::H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr));
  if (::H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr) < 0 ||
      ::H5Dread(data->id.get(), data->memory_type, memory.get(), space.get(), H5P_DEFAULT, out.data()) < 0)
    return Error{lacks_memory() ? "cannot be read: there is not enough memory (--memory MB allows more)"
                                : "cannot be read: a chunk is damaged or truncated, or the file is"};
  return Done{};
}

}  // namespace catena::chunks
