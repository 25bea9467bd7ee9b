// OpenVDB files: only the named grid and its mask are read. The directory is checked first, so that OpenVDB meets whole files only.
#include <openvdb/openvdb.h>

#include <fmt/format.h>

#include <mutex>

#include "engine/field/convert.h"
#include "engine/field/loaders.h"
#include "engine/field/vdb_directory.h"

namespace catena::field {
namespace {

void initialize_once() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

/// A file with its directory. Files without offsets are opened by OpenVDB as a whole, and their directory is made from that.
struct OpenFile {
  VdbDirectory directory;
  std::unique_ptr<openvdb::io::File> file;

  const VdbEntry* find(const std::string& name) const {
    for (const VdbEntry& e : directory.entries)
      if (e.name == name || e.unique_name == name) return &e;
    return nullptr;
  }
  openvdb::GridBase::Ptr read(const VdbEntry& entry) { return file->readGrid(entry.name); }
};

Result<OpenFile> open(const std::string& path) {
  initialize_once();
  OpenFile f;
  CATENA_TRY(f.directory, read_vdb_directory(path));
  f.file = std::make_unique<openvdb::io::File>(path);
  f.file->open(/*delayLoad=*/false);
  if (f.directory.streamed)
    for (auto it = f.file->beginName(); it != f.file->endName(); ++it) {
      const auto grid = f.file->readGridMetadata(*it);
      f.directory.entries.push_back({*it, *it, grid->type(), grid->saveFloatAsHalf()});
    }
  return f;
}

Result<Mapping> mapping_of(const openvdb::GridBase& grid) {
  const auto map = grid.transform().baseMap();
  if (!map->isLinear()) return Error{"has a perspective (frustum) transform, expected a linear one"};
  const openvdb::Mat4d m = map->getAffineMap()->getMat4();  // rows are the images of the axes
  Mat3 j;
  for (int a = 0; a < 3; ++a) j[a] = Vec3(m(a, 0), m(a, 1), m(a, 2));
  const Mapping mapping = Mapping::from_linear(j, Vec3(m(3, 0), m(3, 1), m(3, 2)));
  if (!is_finite(mapping.origin) || !is_finite(mapping.index_from_world(Vec3(1.0))) || !(mapping.smallest_edge() > 0))
    return Error{"has a transform that cannot be inverted"};
  return mapping;
}

bool same_mapping(const Mapping& a, const Mapping& b) {
  const double edge = a.smallest_edge();
  for (int c = 0; c < 3; ++c)
    if (norm(a.world_from_index_linear[c] - b.world_from_index_linear[c]) > 1e-6 * edge) return false;
  return norm(a.origin - b.origin) <= 1e-3 * edge;
}

/// The float tree of a scalar grid of any number type; null for other types.
openvdb::FloatTree::Ptr float_tree(const openvdb::GridBase::Ptr& grid) {
  if (auto g = openvdb::gridPtrCast<openvdb::FloatGrid>(grid)) return g->treePtr();
  if (auto g = openvdb::gridPtrCast<openvdb::DoubleGrid>(grid)) return std::make_shared<openvdb::FloatTree>(g->tree());
  if (auto g = openvdb::gridPtrCast<openvdb::Int32Grid>(grid)) return std::make_shared<openvdb::FloatTree>(g->tree());
  if (auto g = openvdb::gridPtrCast<openvdb::Int64Grid>(grid)) return std::make_shared<openvdb::FloatTree>(g->tree());
  return nullptr;
}

/// OpenVDB converts numbers on its own, but not vectors: the same topology, then every value, active or not.
template <class Tree>
openvdb::Vec3fTree::Ptr converted(const Tree& from) {
  auto to = std::make_shared<openvdb::Vec3fTree>(from, openvdb::Vec3f(from.background()), openvdb::TopologyCopy());
  std::vector<const typename Tree::LeafNodeType*> sources;
  from.getNodes(sources);
  for (const auto* source : sources) {
    auto* leaf = to->probeLeaf(source->origin());
    for (openvdb::Index n = 0; n < Tree::LeafNodeType::SIZE; ++n) leaf->setValueOnly(n, openvdb::Vec3f(source->getValue(n)));
  }
  auto tile = to->beginValueAll();
  tile.setMaxDepth(openvdb::Vec3fTree::ValueAllIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) tile.setValue(openvdb::Vec3f(from.getValue(tile.getCoord())));
  return to;
}

openvdb::Vec3fTree::Ptr vector_tree(const openvdb::GridBase::Ptr& grid) {
  if (auto g = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grid)) return g->treePtr();
  if (auto g = openvdb::gridPtrCast<openvdb::Vec3DGrid>(grid)) return converted(g->tree());
  if (auto g = openvdb::gridPtrCast<openvdb::Vec3IGrid>(grid)) return converted(g->tree());
  return nullptr;
}

/// The voxels where a BoolGrid is true (or a MaskGrid is on); null for other types.
openvdb::MaskTree::Ptr mask_tree(const openvdb::GridBase::Ptr& grid) {
  if (auto g = openvdb::gridPtrCast<openvdb::MaskGrid>(grid)) return g->treePtr();
  const auto g = openvdb::gridPtrCast<openvdb::BoolGrid>(grid);
  if (!g) return nullptr;
  // active voxels that hold `false` are not valid
  for (auto leaf = g->tree().beginLeaf(); leaf; ++leaf)
    for (auto on = leaf->beginValueOn(); on; ++on)
      if (!*on) on.setValueOff();
  auto tile = g->tree().beginValueOn();
  tile.setMaxDepth(openvdb::BoolTree::ValueOnIter::LEAF_DEPTH - 1);
  for (; tile; ++tile)
    if (!*tile) tile.setActiveState(false);
  return std::make_shared<openvdb::MaskTree>(g->tree(), false, true, openvdb::TopologyCopy());
}

/// The entry asked for, or the only usable one.
Result<const VdbEntry*> choose(const OpenFile& f, const LoadRequest& request) {
  const auto& entries = f.directory.entries;
  const auto usable = [](const VdbEntry& e) { return is_scalar_type(type_word(e)) || is_vector_type(type_word(e)); };
  if (!request.grid.empty()) {
    const VdbEntry* e = f.find(request.grid);
    if (!e) return Error{fmt::format("{}: there is no grid \"{}\", the file has: {}", request.path, request.grid, list_of(entries))};
    if (!usable(*e))
      return Error{fmt::format("{}: grid \"{}\" is of type {}, expected a scalar (float, half, double, int32, int64) or a 3-vector grid",
                               request.path, request.grid, type_word(*e))};
    return e;
  }
  const VdbEntry* only = nullptr;
  int count = 0;
  for (const VdbEntry& e : entries)
    if (usable(e)) only = &e, ++count;
  if (count == 1) return only;
  if (count == 0)
    return Error{fmt::format("{}: there is no scalar or 3-vector grid in the file, it has: {}", request.path, list_of(entries))};
  return Error{fmt::format("{}: the file has several grids, name one of: {}", request.path, list_of(entries))};
}

Result<ValidMask> read_mask(OpenFile& f, const LoadRequest& request, const Mapping& mapping) {
  if (!request.valid_grid) return ValidMask();
  const VdbEntry* entry = f.find(*request.valid_grid);
  if (!entry) {
    if (!request.valid_required) return ValidMask();
    return Error{fmt::format("{}: there is no grid \"{}\" for the mask, the file has: {}", request.path, *request.valid_grid,
                             list_of(f.directory.entries))};
  }
  const std::string word = type_word(*entry);
  if (word != "bool" && word != "mask")
    return Error{fmt::format("{}: the mask \"{}\" is of type {}, expected bool", request.path, entry->name, word)};
  const auto grid = f.read(*entry);
  CATENA_TRY(const Mapping own, mapping_of(*grid));
  if (!same_mapping(mapping, own))
    return Error{fmt::format("{}: the mask \"{}\" has another transform than the grid, expected the same (\"valid\": null ignores it)",
                             request.path, entry->name)};
  count_mask();
  return mask_tree(grid);
}

Error about(const std::string& path, const VdbEntry& entry, const Error& e) {
  return Error{fmt::format("{}: grid \"{}\" {}", path, entry.name, e.message)};
}

Index3 index3(const openvdb::Coord& c) { return {c.x(), c.y(), c.z()}; }

}  // namespace

Result<AnyField> load_vdb(const LoadRequest& request) {
  CATENA_TRY(OpenFile f, open(request.path));
  CATENA_TRY(const VdbEntry* entry, choose(f, request));
  const auto grid = f.read(*entry);
  count_file();
  count_grid();
  const auto mapping = mapping_of(*grid);
  if (!mapping) return about(request.path, *entry, mapping.error());
  CATENA_TRY(const ValidMask mask, read_mask(f, request, *mapping));
  AnyField field;
  if (const auto tree = float_tree(grid)) {
    auto made = scalar_from_tree(entry->name, *mapping, *tree, mask);
    if (!made) return about(request.path, *entry, made.error());
    field.scalar = *made;
  } else if (const auto vectors = vector_tree(grid)) {
    auto made = vector_from_tree(entry->name, *mapping, *vectors, mask);
    if (!made) return about(request.path, *entry, made.error());
    field.vector = *made;
  } else {
    return Error{fmt::format("{}: grid \"{}\" is of type {}, which is not a field", request.path, entry->name, grid->valueType())};
  }
  return field;
}

Result<std::vector<GridInfo>> describe_vdb(const std::string& path) {
  CATENA_TRY(OpenFile f, open(path));
  std::vector<GridInfo> all;
  for (const VdbEntry& entry : f.directory.entries) {
    GridInfo info;
    info.name = entry.name;
    info.type = type_word(entry);
    const auto grid = f.read(entry);
    const auto mapping = mapping_of(*grid);
    if (mapping) info.mapping = *mapping;
    // extent and statistics
    const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
    if (!box.empty()) {
      info.size = index3(box.dim());
      info.lowest = index3(box.min());
    }
    const auto active = grid->activeVoxelCount();
    if (const auto tree = float_tree(grid)) {
      info.stats = stats_of(*tree);
      info.bytes = nano_bytes(*tree);
    } else if (const auto vectors = vector_tree(grid)) {
      info.stats = stats_of(*vectors);
      info.bytes = nano_bytes(*vectors);
      info.is_vector = true;
    } else if (const auto mask = mask_tree(grid)) {
      const auto on = mask->activeVoxelCount();
      info.stats.active_voxels = active;
      info.stats.min = on > 0 && on == active ? 1 : 0;
      info.stats.max = on > 0 ? 1 : 0;
      info.bytes = nano_bytes(*mask);
    } else {
      info.stats.active_voxels = active;
      info.bytes = grid->memUsage();
    }
    info.usable = mapping && (is_scalar_type(info.type) || is_vector_type(info.type)) && info.stats.active_voxels > info.stats.nan_count;
    all.push_back(info);
  }
  return all;
}

}  // namespace catena::field
