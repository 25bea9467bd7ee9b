// SPDX-License-Identifier: MIT
/// An open store, with its reader processes. Any thread.
#pragma once
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/io/stores/store_process.h"

namespace catena::field {

/// A store; its contents do not change while it is open.
class Store {
 public:
  /// Reader processes that serve one store, at most.
  static constexpr int kReaders = 2;

  /// Starts a reader and opens the store, whose files become inputs of this process (engine/base/input_files.h) unless `is_input` is false.
  /// The Error is a complete message.
  static Result<std::shared_ptr<Store>> open(const std::string& path, bool is_input = true, const ArrayLayout& layout = {});

  /// Returns the path as it was given.
  const std::string& path() const { return path_; }
  /// Returns the layout with which it was opened.
  const ArrayLayout& layout() const { return layout_; }
  /// Returns the contents.
  const StoreDescription& description() const { return description_; }
  /// Reads a box of a grid at a level and a time step, which must exist, in the stored type; `values` has exactly its bytes, at most
  /// kStoreMemoryBytes. Blocks. A reader that dies is replaced once. The Error is a complete message.
  Outcome read(int grid, int level, int step, const StoreBox& box, std::span<std::byte> values);
  /// Returns for each brick of a level whether anything is stored for it, x fastest. Blocks.
  Result<std::vector<std::uint8_t>> list(int grid, int level, int step);

 private:
  Store(StoreProcess first, std::string path, const ArrayLayout& layout);
  Result<std::vector<StoreProcess>> take_reader();
  void give_back(std::vector<StoreProcess> reader);
  Outcome ask(const StoreRequest& request, std::span<std::byte> out);

  const std::string path_;
  const ArrayLayout layout_;
  const StoreDescription description_;
  const std::string identity_;  ///< The encoded description: another reader must find the same.
  std::mutex mutex_;
  std::condition_variable returned_;
  std::vector<StoreProcess> idle_;
  int readers_ = 1;  ///< Idle or in use.
};

/// Returns the open store of a path; opens it unless it is open and its metadata files are unchanged. A few stores stay open.
Result<std::shared_ptr<Store>> find_store(const std::string& path, const ArrayLayout& layout = {});
/// The same for the file of a request.
Result<std::shared_ptr<Store>> find_store(const LoadRequest& request);

/// Returns the index of the grid with a name; empty: of the only one. The Error is a complete message.
Result<int> find_grid(const Store& store, const std::string& name);
/// Returns the step of a grid at a time step of the store. The Error is a complete message.
Result<int> find_step(const Store& store, int grid, int step);

}  // namespace catena::field
