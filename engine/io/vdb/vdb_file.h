// SPDX-License-Identifier: MIT
/// A .vdb file in memory, with its directory; grids are read one by one. OpenVDB's own file class opens files by name, which the sandbox
/// forbids, and does not validate its input; this one reads from bytes and throws at their end.
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

/// An opened .vdb file. Not thread-safe. The bytes must outlive it.
class VdbFile {
 public:
  /// Opens a file; `path` begins every message. Throws the exceptions of OpenVDB.
  static Result<std::unique_ptr<VdbFile>> open(std::span<const std::byte> bytes, const std::string& path);

  /// The grids in the file.
  const std::vector<VdbEntry>& entries() const { return directory_.entries; }
  /// Returns the grid with this name; nullptr: none.
  const VdbEntry* find(const std::string& name) const;
  /// Given a grid with its transform but without values, returns the voxels to read.
  using RegionSelector = std::function<openvdb::CoordBBox(const openvdb::GridBase&)>;
  /// Reads a grid; one that shares its tree with another grid gets that tree. Null: OpenVDB does not know the type. With `part`, leaves
  /// outside of it are not read (a streamed file is read completely), and no voxel outside of it is active.
  openvdb::GridBase::Ptr read(const VdbEntry& entry, const RegionSelector& part = {});
  /// Fills in the units of the file and of each grid. Never throws.
  void read_units(field::ReadResponse& reply);

 private:
  struct Archive;
  VdbFile(std::span<const std::byte> bytes);
  openvdb::GridBase::Ptr read_at(const VdbEntry& entry, const openvdb::CoordBBox* box);
  openvdb::GridBase::Ptr read_metadata(const VdbEntry& entry);
  /// Creates an empty grid and positions the stream at its contents.
  openvdb::GridBase::Ptr create_grid(const VdbEntry& entry, openvdb::io::GridDescriptor& descriptor);
  const VdbEntry* find_parent(const std::string& unique_name) const;

  openvdb::io::StreamMetadata::Ptr stream_metadata_;  ///< Referenced by the stream.
  MemoryStream stream_;
  std::shared_ptr<Archive> archive_;
  openvdb::MetaMap metadata_;
  VdbDirectory directory_;
  std::map<std::string, openvdb::GridBase::Ptr> streamed_;  ///< By unique name; used for a file without offsets.
};

}  // namespace catena::vdb
