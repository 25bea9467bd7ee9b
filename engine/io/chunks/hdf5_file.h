// SPDX-License-Identifier: MIT
/// An open HDF5 file: attributes, data sets of numbers, boxes of them. The filters lz4, blosc and zstd are decoded here, those of HDF5
/// itself by the library; plug-ins are not loaded. One thread.
#pragma once
#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/result.h"
#include "engine/io/chunks/zarr_array.h"

namespace catena::chunks {

/// An identifier of HDF5, closed on destruction.
class H5Id {
 public:
  explicit H5Id(hid_t id = -1) : id_(id) {}
  H5Id(H5Id&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
  H5Id& operator=(H5Id&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~H5Id() {
    if (id_ >= 0) ::H5Idec_ref(id_);
  }
  hid_t get() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }

 private:
  hid_t id_;
};

/// A data set of numbers, or what keeps it from being one.
struct H5Data {
  std::vector<std::int64_t> size, chunk;  ///< Slowest axis first; chunk: of a contiguous data set one slice.
  StoredType type;
  hid_t memory_type = -1;  ///< Predefined type of HDF5 to which values are converted.
  double fill_value = 0;
  H5Id id;
};

/// Errors are message fragments.
class H5File {
 public:
  /// Opens a file.
  static Result<H5File> open(const std::string& path);

  /// Returns whether an object exists, with all groups of its path.
  bool exists(const std::string& path) const;
  /// Returns the names of the members of a group, in the order of the library, at most 100,000.
  std::vector<std::string> members(const std::string& group) const;
  /// Returns the paths of all data sets of a file, without following links to other files, at most 100,000.
  std::vector<std::string> data_sets() const;
  /// Returns an attribute as text, an array of characters included; empty: there is none, or of another type.
  std::string text(const std::string& object, const std::string& attribute) const;
  /// Returns an attribute as numbers; empty: there is none, or of another type.
  std::vector<double> numbers(const std::string& object, const std::string& attribute) const;
  /// Returns the texts of an attribute that is a list of them.
  std::vector<std::string> texts(const std::string& object, const std::string& attribute) const;
  /// Opens a data set and checks its type, layout and filters. A few stay open.
  Result<const H5Data*> data(const std::string& path);
  /// Reads a small data set as doubles; empty: it is not one of at most 1 million numbers.
  std::vector<double> values(const std::string& path);
  /// Reads a part of a data set in its memory type: `first` and `count` for each axis, in the order of the axes.
  Outcome read(const std::string& path, const std::vector<std::int64_t>& first, const std::vector<std::int64_t>& count,
               std::span<std::byte> out);

 private:
  H5Id file_;
  std::list<std::pair<std::string, H5Data>> opened_;  ///< The last used first.
};

}  // namespace catena::chunks
