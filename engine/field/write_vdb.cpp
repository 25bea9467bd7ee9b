// Writing .vdb: into a temporary file beside the target that takes its name when complete. Targets that are not regular files
// (/dev/null, /dev/full) get the bytes directly.
#include <openvdb/io/Archive.h>
#include <openvdb/openvdb.h>

#include <fmt/format.h>
#include <unistd.h>
#include <glm/matrix.hpp>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "engine/field/convert.h"
#include "engine/field/files.h"
#include "engine/field/load.h"

namespace catena::field {
namespace {

/// OpenVDB's own file class does not check its stream; this one writes to ours, which throws.
struct Writer : openvdb::io::Archive {
  void put(std::ostream& out, const openvdb::GridCPtrVec& grids) const { write(out, grids, /*seekable=*/true); }
};

openvdb::math::Transform::Ptr transform_of(const Mapping& m) {
  const Mat3& j = m.world_from_index_linear;
  openvdb::Mat4d matrix = openvdb::Mat4d::identity();  // rows are the images of the axes
  for (int a = 0; a < 3; ++a)
    for (int c = 0; c < 3; ++c) matrix(a, c) = j[a][c];
  for (int c = 0; c < 3; ++c) matrix(3, c) = m.origin[c];
  return openvdb::math::Transform::createLinearTransform(matrix);
}

bool same_voxels(const openvdb::MaskTree& a, const openvdb::MaskTree& b) {
  if (a.activeVoxelCount() != b.activeVoxelCount()) return false;
  openvdb::MaskTree both(a);
  both.topologyIntersection(b);
  return both.activeVoxelCount() == a.activeVoxelCount();
}

Result<openvdb::GridCPtrVec> grids_of(const std::string& path, const std::vector<WriteItem>& items) {
  openvdb::GridCPtrVec grids;
  openvdb::MaskTree::Ptr mask;
  const Field* masked = nullptr;
  for (const WriteItem& item : items) {
    // OpenVDB takes smaller voxels for flat ones
    const double volume = std::fabs(glm::determinant(item.field.get()->mapping().world_from_index_linear));
    if (!(volume > 3e-15) || !std::isfinite(volume))
      return Error{fmt::format(
          "{}: a .vdb cannot hold voxels of volume {:g}; more than 3e-15 was expected: choose a smaller unit of length", path, volume)};
    // the grid
    const ScalarGrid* scalar = item.field.scalar ? item.field.scalar->grid() : nullptr;
    const VectorGrid* vector = item.field.vector ? item.field.vector->grid() : nullptr;
    CATENA_ASSERT(scalar || vector);
    const openvdb::GridBase::Ptr grid = scalar ? openvdb::GridBase::Ptr(open_grid(*scalar)) : openvdb::GridBase::Ptr(open_grid(*vector));
    grid->setName(item.name);
    grid->setTransform(transform_of(item.field.get()->mapping()));
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    if (vector) grid->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    if (vector) grid->setGridClass(openvdb::GRID_UNKNOWN);
    grids.push_back(grid);
    // its mask: one for the file
    const auto own = scalar ? open_mask(*scalar) : open_mask(*vector);
    if (!own) continue;
    if (mask && !same_voxels(*mask, *own))
      return Error{fmt::format("{}: the grids have different masks, and a file has room for one", path)};
    mask = own;
    masked = item.field.get();
  }
  if (mask) {
    auto tree = std::make_shared<openvdb::BoolTree>(*mask, false, true, openvdb::TopologyCopy());
    auto grid = openvdb::BoolGrid::create(tree);
    grid->setName("valid");
    grid->setTransform(transform_of(masked->mapping()));
    grids.push_back(grid);
  }
  return grids;
}

void write_all(const std::string& path, const openvdb::GridCPtrVec& grids) {
  std::ofstream out;
  out.exceptions(std::ios::failbit | std::ios::badbit);
  out.open(path, std::ios::binary | std::ios::trunc);
  Writer().put(out, grids);
  out.flush();
  out.close();
}

}  // namespace

Outcome write_vdb(const std::string& path, const std::vector<WriteItem>& items) {
  namespace fs = std::filesystem;
  // the target
  std::error_code ignored;
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, ignored))
    return Error{fmt::format("{}: the folder {} does not exist", path, folder.string())};
  if (fs::is_directory(path, ignored)) return Error{fmt::format("{}: this is a folder, expected the name of a file to write", path)};
  const auto failed = [&](const std::string& why) { return Error{fmt::format("{}: cannot be written ({})", path, one_line(why))}; };
  const auto reason = [] { return errno ? std::string(std::strerror(errno)) : std::string("the stream failed"); };
  const bool special = fs::exists(path, ignored) && !fs::is_regular_file(path, ignored);
  const std::string temporary = fmt::format("{}.{}.part", path, ::getpid());
  errno = 0;
  try {
    openvdb::initialize();
    CATENA_TRY(const openvdb::GridCPtrVec grids, grids_of(path, items));
    errno = 0;
    if (special) {
      std::ostringstream bytes;
      Writer().put(bytes, grids);
      std::ofstream out(path, std::ios::binary);
      out << bytes.str() << std::flush;
      if (!out) return failed(reason());
      return Done{};
    }
    write_all(temporary, grids);
    fs::rename(temporary, path);
    return Done{};
  } catch (const std::ios_base::failure&) {
    const std::string why = reason();
    fs::remove(temporary, ignored);
    return failed(why);
  } catch (const std::bad_alloc&) {
    fs::remove(temporary, ignored);
    return failed("not enough memory");
  } catch (const std::exception& e) {
    fs::remove(temporary, ignored);
    return failed(e.what());
  }
}

}  // namespace catena::field
