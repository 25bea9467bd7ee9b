// SPDX-License-Identifier: MIT
/// Command `catena info --cost`: predicted cost of a scene, or of a data file as shown by `render`: loading, uploading, creating objects,
/// evaluating a tick and rendering a frame, in bytes and expected time, and with --measure the measured values. Bytes are those that the
/// allocating functions would allocate. Expected times are an operation count times a unit cost, or sums of parts, which are measured when
/// the command runs:
///   a formula on its grid   nodes x time per node of the same formula on a sampling grid of 64^3
///   a GPU-resident grid     bytes x time per byte of uploading a grid of 128^3
///   a file                  time of loading it
///   a tick                  a tick without links + what each link adds when alone in its chain, on a standard path through the scene
///   a frame                 a start-up time + rows x time per row, from strips of the image, some of 1 row and some of 8
/// Rows without a model have no expected time. Frame thread.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "haptics/chain/program.h"
#include "render/frame/frame_packet.h"

namespace catena::app {

/// Memory and time; nothing where unknown.
struct ResourceCost {
  std::optional<double> bytes, ms;
};

/// One row of the cost table.
struct CostRow {
  std::string stage;  ///< One of: load, shape, mirror (upload to the GPU), create, tick, frame.
  /// Name of the item, and its operation count or size as text.
  std::string name, work;
  ResourceCost expected, measured;
};
using CostTable = std::vector<CostRow>;

/// Adds the fields that the scene has loaded or sampled so far; each is loaded again from the scene's file, and a second time with
/// `measure`. An Error if that fails.
Outcome add_load_costs(const std::string& path, const scene::Scene& scene, bool measure, CostTable& table);
/// Adds the meshes, curves and point tables that the scene has loaded, each loaded again as above, and the shapes of a frame, including
/// traced lines, with the bytes of their vertices. An Error if loading fails.
Outcome add_shape_costs(const scene::Scene& scene, const render::FramePacket& packet, bool measure, CostTable& table);
/// Adds the links and their fetches on a path through the bounding box of the loaded data.
void add_tick_costs(const scene::Scene& scene, const haptics::HapticProgram& program, bool measure, CostTable& table);
/// Adds GPU-resident grids, passes and a frame of the packet at quality `balanced`, without the search for its error that `render` does. An
/// Error is a failure of the GPU.
Outcome add_frame_costs(const render::FramePacket& packet, bool measure, CostTable& table);

/// Prints the table, or one JSON object on one line. An Error if the scene cannot be loaded.
Outcome print_costs(const std::string& path, bool json, bool measure);

}  // namespace catena::app
