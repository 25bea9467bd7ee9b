/// A .vdb file in memory, with its directory; its grids are read one by one. OpenVDB's own file class opens files by name, which the
/// reader may not, and trusts what it reads; this one reads from bytes and throws where they end.
#pragma once
#include <openvdb/io/Archive.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>
#include <functional>
#include <map>
#include <memory>

#include "engine/io/protocol.h"
#include "engine/io/vdb/memory_stream.h"
#include "engine/io/vdb/vdb_directory.h"

namespace catena::vdb {

class VdbFile {
 public:
  /// `path` is for messages. Throws what OpenVDB throws.
  static Result<std::unique_ptr<VdbFile>> open(std::span<const std::byte> bytes, const std::string& path);

  const std::vector<VdbEntry>& entries() const { return directory_.entries; }
  const VdbEntry* find(const std::string& name) const;
  /// Of a grid with its transform and without values: the voxels that are wanted.
  using RegionSelector = std::function<openvdb::CoordBBox(const openvdb::GridBase&)>;
  /// The grid; one that shares its tree with another gets that tree. Null: of a type that OpenVDB does not know. Of a part, leaves outside
  /// of it are not read (a file without offsets is read as a whole), and no voxel outside of it is active.
  openvdb::GridBase::Ptr read(const VdbEntry& entry, const RegionSelector& part = {});
  /// What the file says of units: of itself, and of each grid. Never throws.
  void read_units(field::ReadResponse& reply);

 private:
  struct Archive;
  VdbFile(std::span<const std::byte> bytes);
  openvdb::GridBase::Ptr read_at(const VdbEntry& entry, const openvdb::CoordBBox* box);
  openvdb::GridBase::Ptr read_metadata(const VdbEntry& entry);
  /// A grid with nothing in it; the stream is where its contents begin.
  openvdb::GridBase::Ptr create_grid(const VdbEntry& entry, openvdb::io::GridDescriptor& descriptor);
  const VdbEntry* find_parent(const std::string& unique_name) const;

  openvdb::io::StreamMetadata::Ptr stream_metadata_;  ///< the stream borrows it
  MemoryStream stream_;
  std::shared_ptr<Archive> archive_;
  openvdb::MetaMap metadata_;
  VdbDirectory directory_;
  std::map<std::string, openvdb::GridBase::Ptr> streamed_;  ///< by unique name: of a file without offsets
};

}  // namespace catena::vdb
