#include "engine/vdb/open_file.h"

#include <openvdb/io/GridDescriptor.h>
#include <vector>

#include "engine/field/units.h"

namespace catena::vdb {
/// The parts of OpenVDB's reader that work on any stream.
struct OpenFile::Archive : openvdb::io::Archive {
  void begin(std::istream& in) {
    readHeader(in);
    setFormatVersion(in);
    setLibraryVersion(in);
    setDataCompression(in);
  }
  /// `box`: nullptr: all voxels.
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

/// The first text of the map that can be a unit.
std::string unit_of(const openvdb::MetaMap& map, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (const auto text = map.getMetadata<openvdb::StringMetadata>(key); text && field::is_unit(text->value())) return text->value();
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

OpenFile::OpenFile(std::span<const std::byte> bytes)
    : about_(new openvdb::io::StreamMetadata), stream_(bytes), archive_(std::make_shared<Archive>()) {}

Result<std::unique_ptr<OpenFile>> OpenFile::open(std::span<const std::byte> bytes, const std::string& path) {
  std::unique_ptr<OpenFile> file(new OpenFile(bytes));
  CATENA_TRY(file->directory_, read_vdb_directory(bytes, path));
  std::istream& in = file->stream_;
  file->about_->setSeekable(true);
  openvdb::io::setStreamMetadataPtr(in, file->about_, /*transfer=*/false);
  file->archive_->begin(in);
  file->metadata_.readMeta(in);
  if (!file->directory_.streamed) return file;
  // without offsets: one grid after the other
  for (std::int32_t left = Archive::count(in); left > 0; --left) {
    openvdb::io::GridDescriptor descriptor;
    const openvdb::GridBase::Ptr grid = descriptor.read(in);
    Archive::grid(grid, descriptor, in);
    if (descriptor.isInstance()) {
      const auto parent = file->streamed_.find(descriptor.instanceParentName());
      if (parent == file->streamed_.end())
        return Error{path + ": grid \"" + descriptor.gridName() +
                     "\" shares the tree of a grid that is not there, expected a complete .vdb file"};
      grid->setTree(parent->second->baseTreePtr());
    }
    if (!file->streamed_.emplace(descriptor.uniqueName(), grid).second) continue;
    file->directory_.entries.push_back(entry_of(descriptor));
  }
  return file;
}

const VdbEntry* OpenFile::find(const std::string& name) const {
  for (const VdbEntry& e : entries())
    if (e.name == name || e.unique_name == name) return &e;
  return nullptr;
}

const VdbEntry* OpenFile::parent_of(const std::string& unique_name) const {
  for (const VdbEntry& e : entries())
    if (e.unique_name == unique_name) return &e;
  return nullptr;
}

openvdb::GridBase::Ptr OpenFile::begin(const VdbEntry& entry, openvdb::io::GridDescriptor& descriptor) {
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(entry.at));
  const openvdb::GridBase::Ptr grid = descriptor.read(stream_);
  descriptor.seekToGrid(stream_);
  return grid;
}

openvdb::GridBase::Ptr OpenFile::read_metadata(const VdbEntry& entry) {
  if (!openvdb::GridBase::isRegistered(entry.tree_type)) return nullptr;
  openvdb::io::GridDescriptor descriptor;
  const openvdb::GridBase::Ptr grid = begin(entry, descriptor);
  Archive::metadata(grid, stream_);
  return grid;
}

openvdb::GridBase::Ptr OpenFile::read_at(const VdbEntry& entry, const openvdb::CoordBBox* box) {
  if (!openvdb::GridBase::isRegistered(entry.tree_type)) return nullptr;
  openvdb::io::GridDescriptor descriptor;
  const openvdb::GridBase::Ptr grid = begin(entry, descriptor);
  Archive::grid(grid, descriptor, stream_, box);
  if (!descriptor.isInstance()) return grid;
  // the tree of another grid, which must have one of its own
  const VdbEntry* parent = parent_of(descriptor.instanceParentName());
  if (parent == nullptr || parent == &entry) throw std::runtime_error("it shares the tree of a grid that is not there");
  openvdb::io::GridDescriptor owner;
  const openvdb::GridBase::Ptr owning = begin(*parent, owner);
  if (owner.isInstance()) throw std::runtime_error("it shares a tree that is itself shared");
  Archive::grid(owning, owner, stream_, box);
  grid->setTree(owning->baseTreePtr());
  return grid;
}

openvdb::GridBase::Ptr OpenFile::read(const VdbEntry& entry, const Part& part) {
  if (directory_.streamed) {
    const openvdb::GridBase::Ptr grid = streamed_.at(entry.unique_name);
    if (part) grid->clip(part(*grid));
    return grid;
  }
  if (!part) return read_at(entry, nullptr);
  const openvdb::CoordBBox none;
  const openvdb::GridBase::Ptr bare = read_at(entry, &none);
  if (!bare) return bare;
  const openvdb::CoordBBox box = part(*bare);
  return read_at(entry, &box);
}

void OpenFile::words(field::ReadReply& reply) {
  try {
    constexpr std::size_t kLongest = 256;
    if (const auto text = metadata_.getMetadata<openvdb::StringMetadata>("units")) reply.units = text->value().substr(0, kLongest);
    reply.unit_length = unit_of(metadata_, {"unit_length"});
    for (const VdbEntry& entry : entries()) {
      const openvdb::GridBase::Ptr grid = directory_.streamed ? streamed_.at(entry.unique_name) : read_metadata(entry);
      if (!grid) continue;
      const bool level_set = grid->getGridClass() == openvdb::GRID_LEVEL_SET;
      reply.words.push_back({entry.name, unit_of(*grid, {"unit", "units"}), unit_of(*grid, {"unit_length"}), level_set});
    }
  } catch (const std::exception&) {
    // reading the grid says what is wrong with it
  }
}

}  // namespace catena::vdb
