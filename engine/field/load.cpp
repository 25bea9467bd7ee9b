#include "engine/field/load.h"

#include <fmt/format.h>

#include <atomic>
#include <exception>
#include <new>

#include "engine/base/text.h"
#include "engine/field/files.h"
#include "engine/field/loaders.h"

namespace catena::field {
namespace {

std::atomic<std::uint64_t> files{0}, grids{0}, masks{0};

/// Nothing that a library throws leaves this room.
template <class T, class Body>
Result<T> guarded(const std::string& path, const Body& body) {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return Error{fmt::format("{}: not enough memory to read it (or the file is damaged)", path)};
  } catch (const std::exception& e) {
    return Error{fmt::format("{}: the file is damaged or of an unknown kind ({})", path, one_line(e.what()))};
  } catch (...) {
    return Error{fmt::format("{}: the file is damaged or of an unknown kind", path)};
  }
}

bool is_dense(const std::string& kind) { return kind == ".nii" || kind == ".nii.gz" || kind == ".raw"; }

Error unknown_kind(const std::string& path) {
  return Error{fmt::format("{}: unknown kind of file, expected .vdb, .nii, .nii.gz or .raw", path)};
}

}  // namespace

void count_file() { ++files; }
void count_grid() { ++grids; }
void count_mask() { ++masks; }
LoadCounters load_counters() { return {files, grids, masks}; }

Result<AnyField> load(const LoadRequest& request) {
  const std::string kind = extension_of(request.path);
  if (request.raw && kind != ".raw")
    return Error{fmt::format("{}: shape, spacing, origin and type belong to .raw files only", request.path)};
  return guarded<AnyField>(request.path, [&]() -> Result<AnyField> {
    if (kind == ".vdb") return load_vdb(request);
    if (is_dense(kind)) {
      CATENA_TRY(const DenseFile file, kind == ".raw" ? open_raw(request) : open_nifti(request));
      return load_dense(file);
    }
    CATENA_CHECK(readable_file(request.path));
    return unknown_kind(request.path);
  });
}

Result<std::vector<GridInfo>> describe(const std::string& path) {
  const std::string kind = extension_of(path);
  return guarded<std::vector<GridInfo>>(path, [&]() -> Result<std::vector<GridInfo>> {
    if (kind == ".vdb") return describe_vdb(path);
    if (kind == ".nii" || kind == ".nii.gz") return describe_nifti(path);
    CATENA_CHECK(readable_file(path));
    if (kind == ".raw")
      return Error{fmt::format("{}: a .raw file says nothing about itself; name it in a scene with shape, spacing, origin and type", path)};
    return unknown_kind(path);
  });
}

}  // namespace catena::field
