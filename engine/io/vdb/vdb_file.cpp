// SPDX-License-Identifier: MIT
#include "engine/io/vdb/vdb_file.h"

#include <openvdb/io/GridDescriptor.h>
#include <vector>

#include "engine/io/volume/units.h"

namespace catena::vdb {
/// The parts of OpenVDB's reader that work on any stream.
struct VdbFile::Archive : openvdb::io::Archive {
  void begin(std::istream& in) {
    readHeader(in);
    setFormatVersion(in);
    setLibraryVersion(in);
    setDataCompression(in);
  }
  /// `box`: voxels to read; nullptr: all.
  static void grid(const openvdb::GridBase::Ptr& to, const openvdb::io::GridDescriptor& at, std::istream& in,
                   const openvdb::CoordBBox* box = nullptr) {
    if (box != nullptr)
      readGrid(to, at, in, *box);
    else
      readGrid(to, at, in);
  }
  static void metadata(const openvdb::GridBase::Ptr& to, std::istream& in) {
    readGridCompression(in);
    to->readMeta(in);
  }
  static std::int32_t count(std::istream& in) { return readGridCount(in); }
};

namespace {

/// Returns the first text of the metadata that can be a unit.
std::string unit_of(const openvdb::MetaMap& map, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (const auto text = map.getMetadata<openvdb::StringMetadata>(key); text && field::is_unit_name(text->value())) return text->value();
  return {};
}

VdbEntry entry_of(const openvdb::io::GridDescriptor& descriptor) {
  VdbEntry entry;
  entry.name = openvdb::io::GridDescriptor::nameAsString(descriptor.uniqueName());
  entry.unique_name = descriptor.uniqueName();
  entry.tree_type = descriptor.gridType();
  entry.half = descriptor.saveFloatAsHalf();
  return entry;
}

}  // namespace

VdbFile::VdbFile(std::span<const std::byte> bytes)
    : stream_metadata_(new openvdb::io::StreamMetadata), stream_(bytes), archive_(std::make_shared<Archive>()) {}

Result<std::unique_ptr<VdbFile>> VdbFile::open(std::span<const std::byte> bytes, const std::string& path) {
  std::unique_ptr<VdbFile> file(new VdbFile(bytes));
  CATENA_TRY(file->directory_, read_vdb_directory(bytes, path));
  std::istream& in = file->stream_;
  file->stream_metadata_->setSeekable(true);
  openvdb::io::setStreamMetadataPtr(in, file->stream_metadata_, /*transfer=*/false);
  file->archive_->begin(in);
  file->metadata_.readMeta(in);
  if (!file->directory_.is_streamed) return file;
  // a file without offsets is read grid by grid
  for (std::int32_t remaining = Archive::count(in); remaining > 0; --remaining) {
    openvdb::io::GridDescriptor descriptor;
    const openvdb::GridBase::Ptr grid = descriptor.read(in);
    Archive::grid(grid, descriptor, in);
    if (descriptor.isInstance()) {
      const auto parent = file->streamed_.find(descriptor.instanceParentName());
      if (parent == file->streamed_.end())
        return Error{path + ": grid \"" + descriptor.gridName() +
                     "\" shares the tree of a grid that does not exist, expected a complete .vdb file"};
      grid->setTree(parent->second->baseTreePtr());
    }
    if (!file->streamed_.emplace(descriptor.uniqueName(), grid).second) continue;
    file->directory_.entries.push_back(entry_of(descriptor));
  }
  return file;
}

const VdbEntry* VdbFile::find(const std::string& name) const {
  for (const VdbEntry& e : entries())
    if (e.name == name || e.unique_name == name) return &e;
  return nullptr;
}

const VdbEntry* VdbFile::find_parent(const std::string& unique_name) const {
  for (const VdbEntry& e : entries())
    if (e.unique_name == unique_name) return &e;
  return nullptr;
}

openvdb::GridBase::Ptr VdbFile::create_grid(const VdbEntry& entry, openvdb::io::GridDescriptor& descriptor) {
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(entry.offset));
  const openvdb::GridBase::Ptr grid = descriptor.read(stream_);
  descriptor.seekToGrid(stream_);
  return grid;
}

openvdb::GridBase::Ptr VdbFile::read_metadata(const VdbEntry& entry) {
  if (!openvdb::GridBase::isRegistered(entry.tree_type)) return nullptr;
  openvdb::io::GridDescriptor descriptor;
  const openvdb::GridBase::Ptr grid = create_grid(entry, descriptor);
  Archive::metadata(grid, stream_);
  return grid;
}

openvdb::GridBase::Ptr VdbFile::read_at(const VdbEntry& entry, const openvdb::CoordBBox* box) {
  if (!openvdb::GridBase::isRegistered(entry.tree_type)) return nullptr;
  openvdb::io::GridDescriptor descriptor;
  const openvdb::GridBase::Ptr grid = create_grid(entry, descriptor);
  Archive::grid(grid, descriptor, stream_, box);
  if (!descriptor.isInstance()) return grid;
  // the tree belongs to another grid, which must have its own tree
  const VdbEntry* parent = find_parent(descriptor.instanceParentName());
  if (parent == nullptr || parent == &entry) throw std::runtime_error("a grid shares the tree of a grid that does not exist");
  openvdb::io::GridDescriptor owner;
  const openvdb::GridBase::Ptr owning = create_grid(*parent, owner);
  if (owner.isInstance()) throw std::runtime_error("a grid shares a tree that is itself shared");
  Archive::grid(owning, owner, stream_, box);
  grid->setTree(owning->baseTreePtr());
  return grid;
}

openvdb::GridBase::Ptr VdbFile::read(const VdbEntry& entry, const RegionSelector& part) {
  if (directory_.is_streamed) {
    const openvdb::GridBase::Ptr grid = streamed_.at(entry.unique_name);
    if (part) grid->clip(part(*grid));
    return grid;
  }
  if (!part) return read_at(entry, nullptr);
  const openvdb::CoordBBox none;
  const openvdb::GridBase::Ptr empty_grid = read_at(entry, &none);
  if (!empty_grid) return empty_grid;
  const openvdb::CoordBBox box = part(*empty_grid);
  return read_at(entry, &box);
}

void VdbFile::read_units(field::ReadResponse& reply) {
  try {
    constexpr std::size_t kMaxUnitsBytes = 256;
    if (const auto text = metadata_.getMetadata<openvdb::StringMetadata>("units")) reply.units = text->value().substr(0, kMaxUnitsBytes);
    reply.unit_length = unit_of(metadata_, {"unit_length"});
    for (const VdbEntry& entry : entries()) {
      const openvdb::GridBase::Ptr grid = directory_.is_streamed ? streamed_.at(entry.unique_name) : read_metadata(entry);
      if (!grid) continue;
      const bool level_set = grid->getGridClass() == openvdb::GRID_LEVEL_SET;
      reply.grid_metadata.push_back({entry.name, unit_of(*grid, {"unit", "units"}), unit_of(*grid, {"unit_length"}), level_set});
    }
  } catch (const std::exception&) {
    // reading the grid reports the problem
  }
}

}  // namespace catena::vdb
