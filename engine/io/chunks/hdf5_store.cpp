// SPDX-License-Identifier: MIT
// Stores in HDF5 files. The library reads boxes of data sets, and keeps decoded chunks.
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>

#include "engine/base/text.h"
#include "engine/io/chunks/codecs.h"
#include "engine/io/chunks/hdf5_layouts.h"
#include "engine/io/chunks/open_store.h"
#include "engine/io/chunks/pyramid.h"
#include "engine/io/chunks/xml_tree.h"

namespace catena::chunks {
namespace {

namespace fs = std::filesystem;
using field::Index3;
using field::StoreGrid;
using field::StoreRequest;

class Hdf5Store final : public OpenStore {
 public:
  explicit Hdf5Store(StorePath path) : path_(std::move(path)) {}
  Outcome open();
  Outcome read(const StoreRequest& request, std::span<std::byte> values) override;

 private:
  Error in_file(const std::string& what) const { return Error{fmt::format("{}: the file {}", path_.shown, what)}; }
  Result<std::string> read_xml(const fs::path& path);
  Outcome describe(H5Grid grid);

  StorePath path_;
  H5File file_;
  std::vector<H5Grid> grids_;
};

/// Reads an .xml file; empty: there is none.
Result<std::string> Hdf5Store::read_xml(const fs::path& path) {
  constexpr std::size_t kMaxBytes = 64 << 20;
  auto bytes = read_chunk_file(path.c_str(), kMaxBytes);
  if (!bytes) return Error{fmt::format("{}: the file {} {}", path_.shown, in_quotes(path.filename().string()), bytes.error().message)};
  if (!*bytes) return std::string();
  return std::string(reinterpret_cast<const char*>((*bytes)->data()), (*bytes)->size());
}

Outcome Hdf5Store::open() {
  fs::path path(path_.real), xml_path = path;
  std::string xml;
  if (has_extension(path.native(), ".xml")) {
    CATENA_TRY(xml, read_xml(path));
    const auto root = parse_xml(xml);
    if (!root) return in_file(root.error().message);
    const XmlNode* node = &*root;
    for (const char* name : {"SequenceDescription", "ImageLoader", "hdf5"})
      if (node != nullptr) node = node->find(name);
    if (node == nullptr) return in_file("does not name an HDF5 file of BigDataViewer, expected SequenceDescription/ImageLoader/hdf5");
    if (node->text.find('/') != std::string::npos || node->text.empty())
      return in_file(fmt::format("names the file {}, expected one in the same folder", in_quotes(node->text)));
    path.replace_filename(node->text);
  } else {
    CATENA_TRY(xml, read_xml(xml_path.replace_extension(".xml")));
    if (xml.find("<SpimData") == std::string::npos) xml.clear();
  }
  struct stat about {};
  if (::stat(path.c_str(), &about) != 0 || !S_ISREG(about.st_mode))
    return Error{fmt::format("{}: there is no file {} beside it", path_.shown, in_quotes(path.filename().string()))};
  record_file(about);
  auto file = H5File::open(path.string());
  if (!file) return in_file(file.error().message);
  file_ = std::move(*file);
  auto layout = find_hdf5_grids(file_, xml);
  if (!layout) return in_file(layout.error().message);
  description_.times = std::move(layout->times);
  description_.time_unit = std::move(layout->time_unit);
  description_.notes = std::move(layout->notes);
  for (H5Grid& grid : layout->grids) CATENA_CHECK(describe(std::move(grid)));
  return Done{};
}

/// Completes the description of a grid by its data sets of the first step.
Outcome Hdf5Store::describe(H5Grid grid) {
  StoreGrid& stated = grid.description;
  stated.name = unique_name(description_, one_line(stated.name));
  for (std::size_t level = 0; level < stated.levels.size(); ++level) {
    const std::string& path = grid.paths[level].front();
    const auto found = file_.data(path);
    if (!found) return in_file(fmt::format("has a data set {} that {}", in_quotes(path), found.error().message));
    const H5Data& data = **found;
    std::string type = data.type.name;
    if (grid.is_unsigned && type.starts_with("int")) type.insert(0, "u");
    if (level > 0 && type != stated.type)
      return in_file(fmt::format("has levels of different types, {} and {}; expected one type", stated.type, type));
    stated.type = type;
    stated.fill_value = data.fill_value;
    const auto edge = [&](int a) { return grid.axis[a] < 0 ? 1 : static_cast<int>(data.chunk[static_cast<std::size_t>(grid.axis[a])]); };
    stated.levels[level].chunk = {edge(0), edge(1), edge(2)};
  }
  if (!std::ranges::all_of(stated.levels, [](const field::StoreLevel& level) { return level.mapping.is_invertible(); }))
    return in_file(fmt::format("has a transform of {} that cannot be inverted", in_quotes(stated.name)));
  const bool is_straight = [&] {
    const Mat3& m = stated.levels.front().mapping.world_from_index_linear;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r)
        if (c != r ? m[c][r] != 0 : !(m[c][r] > 0)) return false;
    return true;
  }();
  if (is_straight)
    if (const std::string note = remove_misplaced_levels(stated); !note.empty()) description_.notes.push_back(note);
  description_.grids.push_back(stated);
  grids_.push_back(std::move(grid));
  return Done{};
}

Outcome Hdf5Store::read(const StoreRequest& request, std::span<std::byte> values) {
  const H5Grid& grid = grids_[static_cast<std::size_t>(request.grid)];
  const std::vector<std::string>& steps = grid.paths[static_cast<std::size_t>(request.level)];
  const std::string& path = steps[std::min(static_cast<std::size_t>(request.step), steps.size() - 1)];
  const auto problem = [&](const Error& error) {
    return Error{fmt::format("{}: the data set {} {}", path_.shown, in_quotes(path), error.message)};
  };
  const auto found = file_.data(path);
  if (!found) return problem(found.error());
  const std::size_t rank = (*found)->size.size();
  const int lo[3] = {request.box.lo.x, request.box.lo.y, request.box.lo.z},
            size[3] = {request.box.size.x, request.box.size.y, request.box.size.z};
  std::vector<std::int64_t> first(rank, 0), count(rank, 1);
  for (int a = 0; a < 3; ++a) {
    if (grid.axis[a] < 0) continue;
    if (static_cast<std::size_t>(grid.axis[a]) >= rank) return problem(Error{"has too few axes"});
    first[static_cast<std::size_t>(grid.axis[a])] = lo[a];
    count[static_cast<std::size_t>(grid.axis[a])] = size[a];
  }
  if (grid.channel_axis >= 0) first[static_cast<std::size_t>(grid.channel_axis)] = grid.channel;
  if (grid.step_axis >= 0) first[static_cast<std::size_t>(grid.step_axis)] = std::min(request.step, grid.description.steps - 1);
  // x is the fastest axis of every layout, and z the slowest: a box needs no transposition
  if (const Outcome got = file_.read(path, first, count, values); !got) return problem(got.error());
  return Done{};
}

}  // namespace

Result<std::unique_ptr<OpenStore>> open_hdf5(const StorePath& path) {
  auto store = std::make_unique<Hdf5Store>(path);
  CATENA_CHECK(store->open());
  return std::unique_ptr<OpenStore>(std::move(store));
}

}  // namespace catena::chunks
