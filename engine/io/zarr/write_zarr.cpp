// SPDX-License-Identifier: MIT
#include "engine/io/zarr/write_zarr.h"

#include <algorithm>

#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "engine/io/formats.h"
#include "engine/io/levels/level_cache.h"
#include "engine/io/zarr/pyramid_writer.h"
#include "engine/io/zarr/zarr_folder.h"
#include "engine/io/zarr/zarr_metadata.h"

namespace catena::field {

static Outcome keep_index(const ZarrFolder& folder, const VoxelSource& source, const UseIndex& use_index) {
  CATENA_TRY(BrickIndex index, folder.read_index(source));
  return use_index(std::move(index));
}

Outcome write_zarr(const std::string& path, VoxelSource source, const WriteProgress& progress, const UseIndex& use_index) {
  auto aligned = align_to_world(std::move(source));
  if (!aligned) return Error{one_line(path) + ": " + aligned.error().message};
  CATENA_TRY(const std::unique_ptr<ZarrFolder> folder, ZarrFolder::open(path, *aligned, halved_levels(aligned->size, aligned->mapping)));
  const bool can_continue = !aligned->identity.empty();
  Outcome done = PyramidWriter(*folder, *aligned, progress).write();
  if (done && use_index) done = keep_index(*folder, *aligned, use_index);
  if (done) done = folder->commit(*aligned);
  if (done) return done;
  if (!can_continue) folder->remove();
  Error error = done.error();
  if (can_continue && error.system_failure) error.message += "; the same command continues where it ended";
  return error;
}

Result<std::string> convert_to_zarr(const LoadRequest& request, const std::string& path, const std::string& name,
                                    std::vector<std::string>* notes, const WriteProgress& progress) {
  CATENA_CHECK(check_new_store(path));
  if (is_path_within(path, request.path)) return Error{one_line(path) + ": lies in the folder that is imported, expected another folder"};
  if (is_path_within(request.path, path + ".part"))
    return Error{one_line(path) + ".part: contains the input, expected a free name: the store is built there"};
  CATENA_TRY(VoxelSource source, open_voxels(request));
  if (!name.empty()) source.name = name;
  if (notes != nullptr) *notes = source.notes;
  const std::string chosen_name = source.name;
  BrickIndex all;
  CATENA_CHECK(write_zarr(path, std::move(source), progress, [&](BrickIndex index) -> Outcome {
    all = std::move(index);
    return Done{};
  }));
  cache_index(path, all);
  return chosen_name;
}

Outcome write_field_as_zarr(const std::string& path, const AnyField& field, const std::string& name, const Units& units) {
  CATENA_TRY(VoxelSource source, voxels_of_grid(path, field, name, units));
  source.identity.clear();
  return write_zarr(path, std::move(source));
}

}  // namespace catena::field
