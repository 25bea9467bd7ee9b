// SPDX-License-Identifier: MIT
#include "engine/io/vdb/write_grids.h"

#include <openvdb/io/Archive.h>
#include <openvdb/openvdb.h>
#include <ext/stdio_filebuf.h>

#include <cerrno>
#include <cstring>
#include <sstream>

#include "engine/base/system_failure.h"
#include "engine/base/threads.h"
#include "engine/io/volume/vdb_stream.h"

namespace catena::vdb {
namespace {

using field::StreamHeader;
using field::StreamKind;
using field::StreamRecord;

/// Archive that writes to a stream that throws on errors; OpenVDB's own file class does not check its stream.
struct Writer : openvdb::io::Archive {
  void put(std::ostream& out, const openvdb::GridCPtrVec& grids) const { write(out, grids, /*seekable=*/true); }
};

openvdb::math::Transform::Ptr transform_of(const StreamHeader& head) {
  openvdb::Mat4d matrix = openvdb::Mat4d::identity();  // the rows are the transformed axes
  for (int a = 0; a < 4; ++a)
    for (int c = 0; c < 3; ++c) matrix(a, c) = head.world_from_index[a][c];
  return openvdb::math::Transform::createLinearTransform(matrix);
}

struct Broken : std::runtime_error {
  Broken() : std::runtime_error("the stream of blocks ended too early") {}
};

void take_or_throw(const ReadBytes& read_bytes, void* to, std::size_t bytes) {
  if (!read_bytes(to, bytes)) throw Broken();
}

template <class Value>
Value value_of(const float* numbers) {
  if constexpr (std::is_same_v<Value, bool>)
    return true;
  else if constexpr (std::is_same_v<Value, float>)
    return numbers[0];
  else
    return Value(numbers[0], numbers[1], numbers[2]);
}

template <class Leaf>
void take_leaf(const ReadBytes& read_bytes, Leaf& leaf) {
  std::uint64_t words[8];
  take_or_throw(read_bytes, words, sizeof words);
  typename Leaf::NodeMaskType active;
  for (openvdb::Index w = 0; w < 8; ++w) active.template getWord<std::uint64_t>(w) = words[w];
  leaf.setValueMask(active);
  if constexpr (std::is_same_v<typename Leaf::ValueType, bool>) {
    for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) leaf.setValueOnly(n, active.isOn(n));
  } else {
    take_or_throw(read_bytes, leaf.buffer().data(), Leaf::SIZE * sizeof(typename Leaf::ValueType));
  }
}

/// Replaces nodes of edge `level` that hold a single active value by tiles of the level above.
template <class Tree, class Node>
void merge_nodes(Tree& tree, openvdb::Index level) {
  std::vector<Node*> nodes;
  tree.getNodes(nodes);
  std::vector<std::pair<openvdb::Coord, typename Tree::ValueType>> constant;
  for (const Node* node : nodes) {
    typename Tree::ValueType value;
    bool active = false;
    if (node->isConstant(value, active) && active) constant.emplace_back(node->origin(), value);
  }
  for (const auto& [origin, value] : constant) tree.addTile(level, origin, value, true);
}

template <class Grid>
openvdb::GridBase::Ptr take_grid(const ReadBytes& read_bytes, const StreamHeader& head) {
  using Tree = typename Grid::TreeType;
  using Value = typename Tree::ValueType;
  Value background = openvdb::zeroVal<Value>();
  if constexpr (!std::is_same_v<Value, bool>) background = value_of<Value>(head.background);
  const auto grid = Grid::create(background);
  Tree& tree = grid->tree();
  for (;;) {
    StreamRecord record;
    take_or_throw(read_bytes, &record, sizeof record);
    if (record.type == StreamRecord::end_of_grid) break;
    const openvdb::Coord origin(record.origin[0], record.origin[1], record.origin[2]);
    if (record.type == StreamRecord::leaf)
      take_leaf(read_bytes, *tree.touchLeaf(origin));
    else
      tree.addTile(record.type - StreamRecord::tile_8 + 1, origin, value_of<Value>(record.value), record.active != 0);
  }
  if (head.prune != 0) {
    using Upper = typename Tree::RootNodeType::ChildNodeType;
    merge_nodes<Tree, typename Upper::ChildNodeType>(tree, 2);
    merge_nodes<Tree, Upper>(tree, 3);
  }
  return grid;
}

openvdb::GridCPtrVec take_grids(const ReadBytes& read_bytes) {
  openvdb::GridCPtrVec grids;
  for (StreamHeader head; read_bytes(&head, sizeof head);) {
    if (head.magic != field::kStreamMagic) throw Broken();
    std::string name(head.name_bytes, '\0');
    if (!name.empty()) take_or_throw(read_bytes, name.data(), name.size());
    openvdb::GridBase::Ptr grid;
    switch (head.kind) {
      case StreamKind::scalar:
        grid = take_grid<openvdb::FloatGrid>(read_bytes, head);
        grid->setGridClass(openvdb::GRID_FOG_VOLUME);
        break;
      case StreamKind::vector: {
        const auto vectors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(take_grid<openvdb::Vec3SGrid>(read_bytes, head));
        vectors->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
        vectors->setGridClass(openvdb::GRID_UNKNOWN);
        grid = vectors;
        break;
      }
      case StreamKind::mask:
        grid = take_grid<openvdb::BoolGrid>(read_bytes, head);
        break;
    }
    grid->setName(name);
    grid->setTransform(transform_of(head));
    grids.push_back(grid);
  }
  return grids;
}

void put_all(const openvdb::GridCPtrVec& grids, int fd, bool seekable) {
  __gnu_cxx::stdio_filebuf<char> buffer(fd, std::ios::out | std::ios::binary, 1 << 20);
  std::ostream out(&buffer);
  out.exceptions(std::ios::failbit | std::ios::badbit);
  if (seekable) {
    Writer().put(out, grids);
  } else {
    // the file is written to memory first, because offsets are filled in later and the output may not be seekable
    std::ostringstream file_stream;
    Writer().put(file_stream, grids);
    out << file_stream.str();
  }
  out.flush();
}

}  // namespace

Outcome write_grids(const ReadBytes& read_bytes, int fd, bool seekable) {
  openvdb::initialize();
  try {
    const openvdb::GridCPtrVec grids = take_grids(read_bytes);
    errno = 0;
    put_all(grids, fd, seekable);
    return Done{};
  } catch (const std::ios_base::failure&) {
    return errno != 0 ? Error{describe_errno(errno), is_system_failure(errno)} : Error{"the stream failed"};
  } catch (const std::bad_alloc&) {
    return Error{"not enough memory", true};
  } catch (const std::exception& e) {
    if (is_thread_start_failure(e)) return Error{"no other thread can be started: " + describe_errno(thread_start_errno()), true};
    return Error{e.what()};
  }
}

}  // namespace catena::vdb
